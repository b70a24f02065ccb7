// LensTracer finds hits without the mesh where it can. Here every path is found by a search in the mesh and
// Newton from there, as it is where it cannot, and both must agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iostream>
#include <numbers>
#include <random>

#include "optics/lens_path.h"
#include "optics/refraction.h"
#include "tests/support/bspline_lens.h"

namespace catoptra::optics {
namespace {

class MeshSearch {
 public:
  explicit MeshSearch(const Optic& lens) : lens_(lens) {
    front_.add_optic(lens.mesh);
    back_.add_optic(lens.back.mesh);
    front_.commit();
    back_.commit();
  }

  LensPath trace(const Ray& ray, LensSide entered, const LensIndices& indices) const {
    constexpr double kBefore_mm = 0.05;  // as LensTracer's search for the exit
    LensPath path;
    const auto entry = hit(entered, ray);
    if (!entry || glm::dot(entry->normal, ray.direction) >= 0) return path;
    path.entry = *entry;
    path.end = LensPathEnd::total_reflection;
    const auto inside = refract(ray.direction, entry->normal, indices.around / indices.lens);
    if (!inside) return path;
    path.end = LensPathEnd::rim;
    const auto exit = hit(other_side(entered), {entry->position_mm - kBefore_mm * *inside, *inside});
    if (!exit || exit->t_mm < kBefore_mm || glm::dot(exit->normal, *inside) <= 0) return path;
    path.exit = *exit;
    path.end = LensPathEnd::total_reflection;
    const auto outside = refract(*inside, -exit->normal, indices.lens / indices.around);
    if (!outside) return path;
    path.outside = *outside;
    path.end = LensPathEnd::passed;
    return path;
  }

 private:
  std::optional<ExactHit> hit(LensSide side, const Ray& ray) const {
    const LensSideView view = side_of(lens_, side);
    return exact_hit(view.faces, *view.mesh, ray, (side == LensSide::front ? front_ : back_).intersect(ray));
  }

  const Optic& lens_;
  RayScene front_, back_;
};

// Through the lens's middle from everywhere: half of the rays miss, some graze.
std::vector<Ray> rays_from_all_around(double width_mm, std::size_t count, unsigned seed) {
  std::cout << "seed " << seed << '\n';
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const glm::dvec3 way(number(engine), number(engine), number(engine));
    if (glm::length(way) > 1 || glm::length(way) < 0.1) continue;
    const glm::dvec3 to(0.6 * width_mm * number(engine), 0.6 * width_mm * number(engine),
                        4 * number(engine) - 2);
    const glm::dvec3 from = to + 3 * width_mm * way;
    rays.push_back({from, glm::normalize(to - from)});
  }
  return rays;
}

// What the mesh leaves out between its chords and a curved outline, mm: there only the exact search finds
// glass.
constexpr double kOutline_mm = 0.1;

template <class FromOutline>
void expect_equal(const Optic& lens, double width_mm, unsigned seed, const FromOutline& from_outline_mm) {
  const LensTracer tracer(lens);
  const MeshSearch mesh(lens);
  const LensIndices indices{1.586, 1.0};
  std::size_t passed = 0, others = 0;
  for (const Ray& ray : rays_from_all_around(width_mm, 4000, seed))
    for (const LensSide entered : {LensSide::front, LensSide::back}) {
      const LensPath found = tracer.trace(ray, entered, indices),
                     expected = mesh.trace(ray, entered, indices);
      if (found.end != expected.end) {
        EXPECT_TRUE(expected.end == LensPathEnd::rim || expected.end == LensPathEnd::missed);
        EXPECT_LT(std::min(from_outline_mm(found.entry.position_mm), from_outline_mm(found.exit.position_mm)),
                  kOutline_mm);
        continue;
      }
      others += expected.end != LensPathEnd::passed;
      if (expected.end != LensPathEnd::passed) continue;
      ++passed;
      EXPECT_EQ(found.entry.face, expected.entry.face);
      EXPECT_EQ(found.exit.face, expected.exit.face);
      EXPECT_LT(glm::distance(found.entry.position_mm, expected.entry.position_mm), 1e-9);
      EXPECT_LT(glm::distance(found.exit.position_mm, expected.exit.position_mm), 1e-9);
      EXPECT_LT(glm::distance(found.outside, expected.outside), 1e-9);
    }
  EXPECT_GT(passed, 200u);
  EXPECT_GT(others, 200u);
}

auto from_square(double width_mm) {
  return [=](const glm::dvec3& p) { return 0.5 * width_mm - std::max(std::abs(p.x), std::abs(p.y)); };
}

TEST(LensSearch, BSplinesOfEveryDegree) {
  for (const int degree : {1, 2, 3, 5, 7})
    for (const bool rational : {false, true}) {
      SCOPED_TRACE(testing::Message() << "degree " << degree << (rational ? ", rational" : ""));
      test::BSplineLensSpec spec;
      spec.degree = degree;
      spec.rational = rational;
      spec.poles = degree == 1 ? 30 : 12;
      expect_equal(test::bspline_lens(spec), spec.width_mm, 31, from_square(spec.width_mm));
    }
}

// Strongly curved, so that flat rays meet a side twice; thick, thin, hollow.
TEST(LensSearch, SpheresOfEveryShape) {
  struct Shape {
    double front_mm, back_mm, thickness_mm, width_mm;
  };
  for (const Shape& s : {Shape{80, 120, 4, 50}, Shape{26, -26, 30, 36}, Shape{-30, 25, 2, 36},
                         Shape{0, 0, 3, 40}, Shape{-40, -60, 14, 40}}) {
    SCOPED_TRACE(testing::Message() << "radii " << s.front_mm << ", " << s.back_mm);
    expect_equal(test::spherical_lens(s.front_mm, s.back_mm, s.thickness_mm, s.width_mm, 33), s.width_mm, 32,
                 from_square(s.width_mm));
  }
}

// A mesh wider than its faces, as where an outline is cut out later.
TEST(LensSearch, RoundOutline) {
  test::BSplineLensSpec spec;
  spec.trim_radius_mm = 25;
  expect_equal(test::bspline_lens(spec), spec.width_mm, 33,
               [](const glm::dvec3& p) { return std::abs(25 - std::hypot(p.x, p.y)); });
}

// The part of the (u, v) plane on one side of a line through its origin.
class HalfTrim : public cad_import::FaceTrim {
 public:
  explicit HalfTrim(double sign) : sign_(sign) {}
  bool contains(double u, double) const override { return sign_ * u >= -1e-9; }

 private:
  double sign_;
};

void cut_in_halves(std::vector<cad_import::Face>& faces, tessellate::OpticArrays& mesh) {
  faces.push_back(faces[0]);
  faces[0].trim = std::make_shared<HalfTrim>(-1);
  faces[1].trim = std::make_shared<HalfTrim>(1);
  for (auto& triangle : mesh.triangles)
    triangle.face = triangle.uv[0].x + triangle.uv[1].x + triangle.uv[2].x > 0 ? 1 : 0;
}

TEST(LensSearch, TwoFacesASide) {
  Optic lens = test::bspline_lens({});
  cut_in_halves(lens.faces, lens.mesh);
  cut_in_halves(lens.back.faces, lens.back.mesh);
  expect_equal(lens, 70, 34, from_square(70));
}

/// The front hemisphere's cap in longitude and latitude, as files have it: periodic, its pole in the lens's
/// middle.
class PolarCap : public cad_import::ExactSurface {
 public:
  PolarCap(double radius, double half_angle) : radius_(radius), half_angle_(half_angle) {}
  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::sphere; }
  cad_import::ParameterDomain domain() const override {
    return {0, 2 * std::numbers::pi, 0, half_angle_, 2 * std::numbers::pi, 0};
  }
  double orientation() const override { return -1; }
  glm::dvec3 point(double u, double v) const override { return d2(u, v).point; }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    const auto d = d2(u, v);
    return {d.point, d.du, d.dv};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const double r = radius_, s = std::sin(v), c = std::cos(v), su = std::sin(u), cu = std::cos(u);
    return {{r * s * cu, r * s * su, r * (c - 1)}, {-r * s * su, r * s * cu, 0},
            {r * c * cu, r * c * su, -r * s},      {-r * s * cu, -r * s * su, 0},
            {-r * c * su, r * c * cu, 0},          {-r * s * cu, -r * s * su, -r * c}};
  }

 private:
  double radius_, half_angle_;
};

TEST(LensSearch, PoleInTheMiddleAndPeriod) {
  constexpr double kRadius = 60, kHalfAngle = 0.4;
  constexpr int kRound = 48, kRings = 12;
  Optic lens = test::spherical_lens(0, 0, 14, 60, 17);
  const auto cap = std::make_shared<PolarCap>(kRadius, kHalfAngle);
  lens.faces[0].surface = cap;
  lens.faces[0].trim = nullptr;
  lens.mesh = {};
  for (int j = 0; j <= kRings; ++j)
    for (int i = 0; i <= kRound; ++i) {
      const glm::dvec2 uv(2 * std::numbers::pi * i / kRound, kHalfAngle * j / kRings);
      tessellate::OpticVertex vertex;
      vertex.position_mm = cap->point(uv.x, uv.y);
      vertex.normal = cap->unit_normal(uv.x, uv.y);
      vertex.uv = uv;
      lens.mesh.vertices.push_back(vertex);
    }
  const auto add = [&](int a, int b, int c) {
    const auto at = [](int k) { return std::uint32_t(k); };
    const auto& v = lens.mesh.vertices;
    lens.mesh.triangles.push_back(
        {{at(a), at(b), at(c)}, 0, {v[std::size_t(a)].uv, v[std::size_t(b)].uv, v[std::size_t(c)].uv}});
  };
  for (int j = 0; j < kRings; ++j)
    for (int i = 0; i < kRound; ++i) {
      const int at = j * (kRound + 1) + i, below = at + kRound + 1;
      add(at, below, below + 1);
      if (j > 0) add(at, below + 1, at + 1);
    }
  const double rim = kRadius * std::sin(kHalfAngle);
  expect_equal(lens, 2 * rim, 35, [=](const glm::dvec3& p) { return std::abs(rim - std::hypot(p.x, p.y)); });
}

}  // namespace
}  // namespace catoptra::optics

// What holds for every lens: measured from the other side, moved, turned, mirrored, or on any number of
// threads.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <iostream>
#include <numbers>
#include <random>

#include "optics/lens_evaluation.h"
#include "optics/wavefront.h"
#include "tests/support/analytic_lens.h"
#include "tests/support/aspheric_surface.h"
#include "tests/support/bspline_lens.h"

namespace catoptra::optics {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) { std::cout << "seed " << seed << '\n'; }
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  test::AsphereSpec side() {
    const double c = number(0.002, 0.014);
    return {.c1 = c,
            .c2 = c + number(-0.005, 0.005),
            .k1 = number(-1, 0.5),
            .k2 = number(-1, 0.5),
            .angle_rad = number(0, std::numbers::pi),
            .a = number(-2e-7, 2e-7),
            .sx = number(-0.03, 0.03),
            .sy = number(-0.03, 0.03),
            .half_width_mm = 25};
  }
  glm::dvec2 gaze() { return {number(-0.45, 0.45), number(-0.4, 0.4)}; }

 private:
  std::mt19937_64 engine_;
};

constexpr double kThickness_mm = 8;
constexpr LensFrame kFrame{.front_vertex_mm = {0, 0, 0}, .back_vertex_mm = {0, 0, -kThickness_mm}};

Optic lens_of(const test::AsphereSpec& front, const test::AsphereSpec& back) {
  Optic lens = test::lens_between(std::make_shared<test::AsphericSurface>(front),
                                  std::make_shared<test::AsphericSurface>(back), kThickness_mm, 50, 21);
  lens.medium = abbe_medium(1.6, 36);
  return lens;
}

// How the direction at the end of a path changes with the displacement of a parallel ray at its beginning.
class PathTensor {
 public:
  PathTensor(const Optic& lens, const LensPath& path, const glm::dvec3& in, LensSide entered, double eta)
      : path_(path), in_(in) {
    const auto derivatives = [&](LensSide side, const ExactHit& hit) {
      return side_of(lens, side).faces[0].surface->d2(hit.uv.x, hit.uv.y);
    };
    length_ = glm::distance(path.entry.position_mm, path.exit.position_mm);
    inside_ = refracted({}, in, path.inside, eta, derivatives(entered, path.entry));
    outside_ = refracted(transferred(inside_, path.inside, length_), path.inside, path.outside, 1 / eta,
                         derivatives(other_side(entered), path.exit));
  }
  glm::dvec3 operator()(const glm::dvec3& displacement) const {
    const auto onto = [](const glm::dvec3& a, const glm::dvec3& d, const glm::dvec3& n) {
      return a - d * (glm::dot(n, a) / glm::dot(n, d));
    };
    const glm::dvec3 entry = onto(displacement, in_, path_.entry.normal);
    return outside_.curvature *
           onto(entry + length_ * (inside_.curvature * entry), path_.inside, path_.exit.normal);
  }

 private:
  const LensPath& path_;
  glm::dvec3 in_;
  double length_ = 0;
  Wavefront inside_, outside_;
};

// The equivalent power of a path is the same tensor, transposed, when light runs through the lens from the
// other side; so its trace, its determinant and the deviation do not change.
TEST(LensEvaluationProperty, ReversalLeavesTheEquivalentPower) {
  Random random(5);
  int passed = 0;
  for (int k = 0; k < 200; ++k) {
    const Optic lens = lens_of(random.side(), random.side());
    const LensTracer tracer(lens);
    const glm::dvec2 gaze = random.gaze();
    const glm::dvec3 d = glm::normalize(glm::dvec3(std::tan(gaze.x), std::tan(gaze.y), 1));
    const LensPath there = tracer.trace({glm::dvec3(0, 0, -kThickness_mm - 25), d}, LensSide::back, {1.6, 1});
    if (there.end != LensPathEnd::passed) continue;
    const LensPath back = tracer.trace({there.exit.position_mm + 20.0 * there.outside, -there.outside},
                                       LensSide::front, {1.6, 1});
    if (back.end != LensPathEnd::passed) continue;
    ++passed;
    const PathTensor forward(lens, there, d, LensSide::back, 1 / 1.6),
        reverse(lens, back, -there.outside, LensSide::front, 1 / 1.6);
    for (int n = 0; n < 3; ++n) {
      const glm::dvec3 a(random.number(-1, 1), random.number(-1, 1), random.number(-1, 1));
      const glm::dvec3 b(random.number(-1, 1), random.number(-1, 1), random.number(-1, 1));
      const glm::dvec3 across_in = a - d * glm::dot(a, d),
                       across_out = b - there.outside * glm::dot(b, there.outside);
      EXPECT_NEAR(glm::dot(across_out, forward(across_in)), glm::dot(across_in, reverse(across_out)),
                  1e-12);  // 1/mm: 1e-9 D
    }
    EXPECT_NEAR(glm::dot(d, there.outside), glm::dot(-there.outside, back.outside), 1e-13);
  }
  EXPECT_GT(passed, 150);
}

// A surface and all that belongs to it moved: x -> turn x + shift.
class MovedSurface : public cad_import::ExactSurface {
 public:
  MovedSurface(std::shared_ptr<const cad_import::ExactSurface> still, const glm::dmat3& turn,
               const glm::dvec3& shift)
      : still_(std::move(still)), turn_(turn), shift_(shift) {}
  cad_import::SurfaceKind kind() const override { return still_->kind(); }
  cad_import::ParameterDomain domain() const override { return still_->domain(); }
  double orientation() const override { return still_->orientation() * glm::determinant(turn_); }
  glm::dvec3 point(double u, double v) const override { return turn_ * still_->point(u, v) + shift_; }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    const auto f = still_->d1(u, v);
    return {turn_ * f.point + shift_, turn_ * f.du, turn_ * f.dv};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const auto f = still_->d2(u, v);
    return {
        turn_ * f.point + shift_, turn_ * f.du, turn_ * f.dv, turn_ * f.duu, turn_ * f.duv, turn_ * f.dvv};
  }

 private:
  std::shared_ptr<const cad_import::ExactSurface> still_;
  glm::dmat3 turn_;
  glm::dvec3 shift_;
};

Optic moved(const Optic& lens, const glm::dmat3& turn, const glm::dvec3& shift) {
  Optic result = lens;
  const bool mirrored = glm::determinant(turn) < 0;
  const auto move_side = [&](std::vector<cad_import::Face>& faces, tessellate::OpticArrays& mesh) {
    for (auto& face : faces) face.surface = std::make_shared<MovedSurface>(face.surface, turn, shift);
    for (auto& vertex : mesh.vertices) vertex.position_mm = turn * vertex.position_mm + shift;
    for (auto& triangle : mesh.triangles)
      if (mirrored) {
        std::swap(triangle.vertices[1], triangle.vertices[2]);
        std::swap(triangle.uv[1], triangle.uv[2]);
      }
  };
  move_side(result.faces, result.mesh);
  move_side(result.back.faces, result.back.mesh);
  return result;
}

glm::dmat3 rotation(const glm::dvec3& axis, double angle) {
  glm::dmat3 m;
  for (int k = 0; k < 3; ++k) {
    glm::dvec3 e(0);
    e[k] = 1;
    m[k] = e * std::cos(angle) + glm::cross(axis, e) * std::sin(angle) +
           axis * (axis[k] * (1 - std::cos(angle)));
  }
  return m;
}

EvaluationOptions worn(Random& random) {
  EvaluationOptions o;
  o.mode = EvaluationMode::as_worn;
  o.position.pantoscopic_rad = random.number(-0.1, 0.25);
  o.position.wrap_rad = random.number(0, 0.25);
  return o;
}

void expect_same(const LensPoint& a, const LensPoint& b) {
  ASSERT_EQ(a.end, b.end);
  if (a.end != LensPathEnd::passed) return;
  constexpr double kPower_d = 1e-8;
  EXPECT_NEAR(a.power.xx, b.power.xx, kPower_d);
  EXPECT_NEAR(a.power.xy, b.power.xy, kPower_d);
  EXPECT_NEAR(a.power.yy, b.power.yy, kPower_d);
  EXPECT_NEAR(a.tangential_d, b.tangential_d, kPower_d);
  EXPECT_NEAR(a.oblique_astigmatism_d, b.oblique_astigmatism_d, kPower_d);
  EXPECT_LT(glm::distance(a.prism, b.prism), 1e-9);
  EXPECT_LT(glm::distance(a.object_rad, b.object_rad), 1e-11);
  EXPECT_NEAR(a.distortion, b.distortion, 1e-10);
  EXPECT_NEAR(a.transverse_colour, b.transverse_colour, 1e-9);
}

// The model's coordinates are no part of a lens.
TEST(LensEvaluationProperty, RigidMotionChangesNothing) {
  Random random(6);
  for (int k = 0; k < 40; ++k) {
    const Optic lens = lens_of(random.side(), random.side());
    const glm::dmat3 turn =
        rotation(glm::normalize(glm::dvec3(random.number(-1, 1), random.number(-1, 1), random.number(-1, 1))),
                 random.number(0, 6));
    const glm::dvec3 shift(random.number(-100, 100), random.number(-100, 100), random.number(-100, 100));
    const Optic other = moved(lens, turn, shift);
    const LensFrame frame{turn * kFrame.front_vertex_mm + shift, turn * kFrame.back_vertex_mm + shift,
                          turn * kFrame.x, turn * kFrame.y, turn * kFrame.z};
    const EvaluationOptions options = worn(random);
    const glm::dvec2 gazes[] = {{0, 0}, random.gaze(), random.gaze()};
    const auto here = LensEvaluator(lens, kFrame).at_gaze(gazes, options),
               there = LensEvaluator(other, frame).at_gaze(gazes, options);
    for (int i = 0; i < 3; ++i) expect_same(here.points[i], there.points[i]);
    EXPECT_NEAR(here.spectacle_magnification, there.spectacle_magnification, 1e-12);
  }
}

// A lens turned about its axis by an angle has its axis turned by that angle, and nothing else changed.
TEST(LensEvaluationProperty, TurningALensTurnsItsAxis) {
  Random random(7);
  for (int k = 0; k < 40; ++k) {
    const Optic lens = lens_of(random.side(), random.side());
    const double angle = random.number(0, std::numbers::pi);
    const Optic turned = moved(lens, rotation({0, 0, 1}, angle), {});
    const auto a = LensEvaluator(lens, kFrame).at_points({}, {}),
               b = LensEvaluator(turned, kFrame).at_points({}, {});
    EXPECT_NEAR(a.reference.sphere_d, b.reference.sphere_d, 1e-9);
    EXPECT_NEAR(a.reference.cylinder_d, b.reference.cylinder_d, 1e-9);
    const double turn = b.reference.axis_rad - a.reference.axis_rad - angle;
    EXPECT_NEAR(std::remainder(turn, std::numbers::pi), 0, 1e-6);
    EXPECT_NEAR(glm::length(a.reference_prism), glm::length(b.reference_prism), 1e-10);
  }
}

// The mirror image of a lens before the other eye does the mirror image.
TEST(LensEvaluationProperty, TheOtherEyesLensIsTheMirrorImage) {
  Random random(8);
  for (int k = 0; k < 40; ++k) {
    const Optic lens = lens_of(random.side(), random.side());
    const Optic mirror = moved(lens, glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1), {});
    EvaluationOptions options = worn(random);
    const glm::dvec2 gaze = random.gaze(), mirrored(-gaze.x, gaze.y);
    const auto right = LensEvaluator(lens, kFrame).at_gaze(std::span(&gaze, 1), options);
    options.position.eye = Eye::left;
    const auto left = LensEvaluator(mirror, kFrame).at_gaze(std::span(&mirrored, 1), options);
    LensPoint image = left.points[0];
    image.power.xy *= -1;
    image.prism.x *= -1;
    image.object_rad.x *= -1;
    expect_same(right.points[0], image);
  }
}

// A gaze and the point of the back surface that it meets are the same place.
TEST(LensEvaluationProperty, GazesAndTheirPointsAgree) {
  Random random(10);
  for (int k = 0; k < 40; ++k) {
    const bool spline = k % 2 == 0;
    const Optic lens = spline ? test::bspline_lens({.thickness_mm = kThickness_mm, .width_mm = 50})
                              : lens_of(random.side(), random.side());
    const LensEvaluator evaluator(lens, kFrame);
    EvaluationOptions options = worn(random);
    for (const auto mode : {EvaluationMode::as_worn, EvaluationMode::lensmeter}) {
      options.mode = mode;
      const glm::dvec2 gaze = random.gaze();
      const LensPoint by_gaze = evaluator.at_gaze(std::span(&gaze, 1), options).points[0];
      if (by_gaze.end != LensPathEnd::passed) continue;
      const LensPoint by_point = evaluator.at_points(std::span(&by_gaze.point_mm, 1), options).points[0];
      EXPECT_LT(glm::distance(by_point.gaze_rad, gaze), 1e-10);
      EXPECT_LT(glm::distance(by_point.point_mm, by_gaze.point_mm), 1e-8);
      expect_same(by_gaze, by_point);
    }
  }
}

void expect_same_bits(const LensPoint& a, const LensPoint& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  ASSERT_EQ(a.end, b.end);
  for (const auto& [x, y] : {std::pair{a.power.xx, b.power.xx},
                             {a.power.xy, b.power.xy},
                             {a.power.yy, b.power.yy},
                             {a.prism.x, b.prism.x},
                             {a.prism.y, b.prism.y},
                             {a.distortion, b.distortion},
                             {a.transverse_colour, b.transverse_colour},
                             {a.point_mm.x, b.point_mm.x}})
    ASSERT_EQ(bits(x), bits(y));
}

// Every bit of a map is the same on one thread and on as many as there are, several rays at once or one by
// one.
TEST(LensEvaluationProperty, ThreadsChangeNoBit) {
  Random random(9);
  const auto grid = gaze_grid(0.7, 0.02);
  for (const bool spline : {false, true}) {
    Optic lens = spline ? test::bspline_lens({.thickness_mm = kThickness_mm, .width_mm = 50})
                        : lens_of(random.side(), random.side());
    lens.medium = abbe_medium(1.6, 36);
    const LensEvaluator evaluator(lens, kFrame);
    EvaluationOptions options = worn(random);
    options.threads = 1;
    const auto one = evaluator.at_gaze(grid, options);
    options.threads = 0;
    for (int run = 0; run < 3; ++run) {
      const auto all = evaluator.at_gaze(grid, options);
      for (std::size_t i = 0; i < grid.size(); ++i) expect_same_bits(one.points[i], all.points[i]);
    }
  }
}

}  // namespace
}  // namespace catoptra::optics

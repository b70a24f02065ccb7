// The polynomial stand-in for a mirror's surface, against Newton iteration and closed forms in double
// precision.
#include "render/src/ray_tracer_exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <iostream>
#include <numbers>
#include <random>

#include "cad_import/bspline_surface.h"
#include "optics/exact_hit.h"
#include "optics/ray_scene.h"
#include "optics/reflection.h"
#include "tests/support/analytic_optic.h"

namespace catoptra {
namespace {

constexpr int kLanes = render::MirrorLanes::kLanes;

/// Sixteen rays from `eye` through points of the mirror's plane, with their mesh hits.
render::MirrorLanes aim(const optics::RayScene& scene, const glm::dvec3& eye,
                        const std::vector<glm::dvec3>& targets) {
  render::MirrorLanes lanes{};
  for (int i = 0; i < kLanes; ++i) {
    const glm::dvec3 d = glm::normalize(targets[std::size_t(i) % targets.size()] - eye);
    const optics::Hit hit = scene.intersect({eye, d});
    lanes.active[i] = bool(hit);
    lanes.direction_x[i] = d.x;
    lanes.direction_y[i] = d.y;
    lanes.direction_z[i] = d.z;
    lanes.start[i] = hit ? hit.t_mm : 1;
    lanes.triangle[i] = hit ? hit.triangle : 0;
    lanes.u[i] = float(hit.barycentric.x);
    lanes.v[i] = float(hit.barycentric.y);
  }
  return lanes;
}

glm::dvec3 direction(const render::MirrorLanes& l, int i) {
  return {l.direction_x[i], l.direction_y[i], l.direction_z[i]};
}
glm::dvec3 surface(const render::MirrorLanes& l, int i) {
  return {l.out.surface_x[i], l.out.surface_y[i], l.out.surface_z[i]};
}
glm::dvec3 reflected(const render::MirrorLanes& l, int i) {
  return {l.out.reflected_x[i], l.out.reflected_y[i], l.out.reflected_z[i]};
}

struct Traced {
  explicit Traced(optics::Optic o) : optic(std::move(o)), mirror(optic) {
    scene.add_optic(optic.mesh);
    scene.commit();
  }
  optics::Optic optic;
  optics::RayScene scene;
  render::ExactMirror mirror;
};

TEST(ExactMirror, PolynomialsReplaceNewtonOnSmoothMirrors) {
  for (const double radius : {0.0, 1200.0, -1200.0, 3000.0})
    EXPECT_EQ(render::ExactMirror(test::conic_mirror(radius, 0, 170, 110, 7, 7)).patched_share(), 1)
        << radius;
}

TEST(ExactMirror, AgreesWithNewtonIteration) {
  const unsigned seed = 20261122;
  std::cout << "seed " << seed << "\n";
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(-80, 80), y(-50, 50);
  for (const auto& [radius, conic] :
       {std::pair{1200.0, 0.0}, {300.0, 0.0}, {-600.0, -1.0}, {200.0, 2.0}, {0.0, 0.0}}) {
    const Traced t(test::conic_mirror(radius, conic, 170, 110, 7, 7));
    const glm::dvec3 eye(260, -120, 640);
    for (int packet = 0; packet < 40; ++packet) {
      std::vector<glm::dvec3> targets;
      for (int i = 0; i < kLanes; ++i) targets.emplace_back(x(random), y(random), 0);
      render::MirrorLanes lanes = aim(t.scene, eye, targets);
      t.mirror.reflect(eye, lanes);
      for (int i = 0; i < kLanes; ++i) {
        if (!lanes.active[i]) continue;
        const optics::Hit hit{0, 0, lanes.triangle[i], {lanes.u[i], lanes.v[i]}};
        const auto newton = optics::exact_hit(t.optic, {eye, direction(lanes, i)}, hit);
        if (!newton) continue;  // beside the trimmed face by less than the chord error
        // Twice what the patches are accepted with, divided by the cosine of incidence (above 0.5 here).
        EXPECT_LT(glm::length(surface(lanes, i) - newton->position_mm), 4 * render::kHeightTolerance);
        EXPECT_LT(glm::length(reflected(lanes, i) - optics::reflect(direction(lanes, i), newton->normal)),
                  4 * render::kSlopeTolerance);
      }
    }
  }
}

// Angular magnifications for a far object: eye distance, radius, incidence, tangential, sagittal. Finite
// differences of the reflected direction in double precision.
TEST(ExactMirror, MagnificationIsTheFormulas) {
  struct Case {
    double distance, radius, incidence_deg, tangential, sagittal;
  };
  for (const Case& c : {Case{840, 1260, 35, 0.380561, 0.477965}, Case{750, 1200, 30, 0.409270, 0.480185},
                        Case{1450, 1400, 60, 0.194444, 0.491228}}) {
    const Traced t(test::conic_mirror(c.radius, 0, 170, 110, 7, 7));
    const double incidence = c.incidence_deg * std::numbers::pi / 180,
                 step = 1e-4;  // rad; its square bends by 1e-8
    const glm::dvec3 eye = c.distance * glm::dvec3(std::sin(incidence), 0, std::cos(incidence));
    const glm::dvec3 d = glm::normalize(-eye), along(std::cos(incidence), 0, -std::sin(incidence)),
                     across(0, 1, 0);
    std::vector<glm::dvec3> targets;
    for (const glm::dvec3& side : {along, -along, across, -across})
      targets.push_back(eye + d + std::tan(step) * side);
    render::MirrorLanes lanes = aim(t.scene, eye, targets);
    t.mirror.reflect(eye, lanes);
    const auto magnification = [&](int a, int b) {
      return 2 * step / (2 * std::asin(0.5 * glm::length(reflected(lanes, a) - reflected(lanes, b))));
    };
    const auto formula = optics::mirror_magnification(c.distance, c.radius, incidence);
    EXPECT_NEAR(magnification(0, 1), formula.tangential, 1e-6);
    EXPECT_NEAR(magnification(2, 3), formula.sagittal, 1e-6);
    EXPECT_NEAR(magnification(0, 1), c.tangential, 2e-6) << "printed to six digits";
    EXPECT_NEAR(magnification(2, 3), c.sagittal, 2e-6);
  }
}

// Coddington: 1/t' = 1/d + 2 / (r cos b), 1/s' = 1/d + 2 cos b / r.
TEST(ExactMirror, WavefrontIsCoddingtons) {
  const double radius = 1200, distance = 800, incidence = 40 * std::numbers::pi / 180,
               c = std::cos(incidence);
  for (const double sign : {1.0, -1.0}) {
    const Traced t(test::conic_mirror(sign * radius, 0, 170, 110, 15, 15));
    const glm::dvec3 eye = distance * glm::dvec3(std::sin(incidence), 0, std::cos(incidence));
    render::MirrorLanes lanes = aim(t.scene, eye, {{0, 0, 0}});
    t.mirror.reflect(eye, lanes);
    const double tangential = 1 / distance + sign * 2 / (radius * c),
                 sagittal = 1 / distance + sign * 2 * c / radius;
    // The curvature is that of the triangle's middle seen along its plane's normal: a level of detail needs
    // no more.
    EXPECT_NEAR(lanes.out.wave_sum[0], tangential + sagittal, 0.01 / distance);
    EXPECT_NEAR(lanes.out.wave_product[0], tangential * sagittal, 0.01 / (distance * distance));
  }
}

TEST(ExactMirror, ParaboloidFocusesToANanometre) {
  const double radius = 800;
  const Traced t(test::conic_mirror(-radius, -1, 170, 110, 9, 9));
  const glm::dvec3 focus(0, 0, radius / 2);
  // By reciprocity: rays from the focus leave along the axis; traced back over 2 f they would miss the focus
  // by this much.
  std::vector<glm::dvec3> targets;
  for (int i = 0; i < kLanes; ++i) targets.emplace_back(-70 + 9 * i, 40 - 5 * i, 0);
  render::MirrorLanes lanes = aim(t.scene, focus, targets);
  t.mirror.reflect(focus, lanes);
  for (int i = 0; i < kLanes; ++i) {
    if (!lanes.active[i]) continue;
    EXPECT_LT(radius * std::hypot(lanes.out.reflected_x[i], lanes.out.reflected_y[i]), 1e-6) << "mm";
  }
}

/// A plane with ripples of 0.16 mm: finer than the finest cell, so that no polynomial fits anywhere.
class RippledSurface : public cad_import::ExactSurface {
 public:
  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::other; }
  cad_import::ParameterDomain domain() const override { return {-85, 85, -55, 55, 0, 0}; }
  double orientation() const override { return 1; }
  glm::dvec3 point(double u, double v) const override { return {u, v, 1e-5 * std::sin(40 * u)}; }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    return {point(u, v), {1, 0, 4e-4 * std::cos(40 * u)}, {0, 1, 0}};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const auto f = d1(u, v);
    return {f.point, f.du, f.dv, {0, 0, -1.6e-2 * std::sin(40 * u)}, {0, 0, 0}, {0, 0, 0}};
  }
};

TEST(ExactMirror, FallsBackToNewtonWhereNoPolynomialFits) {
  optics::Optic optic = test::conic_mirror(0, 0, 170, 110, 6, 6);
  const auto rippled = std::make_shared<RippledSurface>();
  optic.faces[0].surface = rippled;
  for (auto& v : optic.mesh.vertices) v.position_mm = rippled->point(v.uv.x, v.uv.y);
  const Traced t(std::move(optic));
  EXPECT_EQ(t.mirror.patched_share(), 0);
  const glm::dvec3 eye(0, 0, 700);
  std::vector<glm::dvec3> targets;
  for (int i = 0; i < kLanes; ++i) targets.emplace_back(-15.3 + 2.1 * i, 3 + i, 0);
  render::MirrorLanes lanes = aim(t.scene, eye, targets);
  t.mirror.reflect(eye, lanes);
  for (int i = 0; i < kLanes; ++i) {
    ASSERT_TRUE(lanes.active[i]);
    const glm::dvec3 s = surface(lanes, i);
    EXPECT_NEAR(s.z, rippled->point(s.x, s.y).z, 1e-9) << "mm";
    EXPECT_LT(glm::length(reflected(lanes, i) -
                          optics::reflect(direction(lanes, i), rippled->unit_normal(s.x, s.y))),
              1e-10);
  }
}

// Like the mirror glasses of the examples: cubic, their third derivatives jump at the knots, and 2e-5 mm
// rough.
TEST(ExactMirror, SplinesAreSplitAtTheirKnots) {
  cad_import::BSplineData data;
  data.degree_u = data.degree_v = 3;
  data.pole_count_u = data.pole_count_v = 11;
  for (int k = 0; k < 15; ++k) data.knots_u.push_back(-85 + 170 * std::clamp((k - 3) / 8.0, 0.0, 1.0));
  data.knots_v = data.knots_u;
  for (int i = 0; i < 11; ++i)
    for (int j = 0; j < 11; ++j) {
      const auto greville = [&](int k) {
        return (data.knots_u[k + 1] + data.knots_u[k + 2] + data.knots_u[k + 3]) / 3;
      };
      const double x = greville(i), y = greville(j);
      data.poles.emplace_back(x, y, -(x * x + y * y) / 2400 + 2e-5 * std::sin(i * 5 + j * 3));
    }
  const auto spline = std::make_shared<cad_import::BSplineSurface>(data, 1);
  optics::Optic optic = test::conic_mirror(0, 0, 170, 110, 12, 12);
  optic.faces[0].surface = spline;
  for (auto& v : optic.mesh.vertices) {
    v.position_mm = spline->point(v.uv.x, v.uv.y);
    v.normal = spline->unit_normal(v.uv.x, v.uv.y);
  }
  const Traced t(std::move(optic));
  EXPECT_EQ(t.mirror.patched_share(), 1);
  EXPECT_LE(t.mirror.patch_count(), 1024u) << "about 64 spans, some of them in parts";
  const glm::dvec3 eye(100, 30, 700);
  std::vector<glm::dvec3> targets;
  for (int i = 0; i < kLanes; ++i) targets.emplace_back(-70.3 + 9.1 * i, -40 + 5 * i, 0);
  render::MirrorLanes lanes = aim(t.scene, eye, targets);
  t.mirror.reflect(eye, lanes);
  for (int i = 0; i < kLanes; ++i) {
    ASSERT_TRUE(lanes.active[i]);
    const auto newton = optics::newton_hit(*spline, {eye, direction(lanes, i)},
                                           {targets[std::size_t(i)].x, targets[std::size_t(i)].y});
    ASSERT_TRUE(newton);
    EXPECT_LT(glm::length(surface(lanes, i) - newton->position_mm), 4 * render::kHeightTolerance);
    EXPECT_LT(glm::length(reflected(lanes, i) - optics::reflect(direction(lanes, i), newton->normal)),
              4 * render::kSlopeTolerance);
  }
}

}  // namespace
}  // namespace catoptra

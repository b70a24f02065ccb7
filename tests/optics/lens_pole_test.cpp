// Lenses whose surfaces have a pole of their parameters on the axis, as revolved faces do.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "optics/lens_evaluation.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::optics {
namespace {

/// Another height field (u = x, v = y) in polar parameters: u the angle, v the distance from the axis.
class PolarSurface : public cad_import::ExactSurface {
 public:
  PolarSurface(std::shared_ptr<const cad_import::ExactSurface> field, double radius_mm)
      : field_(std::move(field)), radius_(radius_mm) {}

  cad_import::SurfaceKind kind() const override { return cad_import::SurfaceKind::revolution; }
  cad_import::ParameterDomain domain() const override {
    return {0, 2 * std::numbers::pi, 0, radius_, 2 * std::numbers::pi, 0};
  }
  double orientation() const override { return -1; }  // du x dv points down
  glm::dvec3 point(double u, double v) const override {
    return field_->point(v * std::cos(u), v * std::sin(u));
  }
  cad_import::SurfaceFrame d1(double u, double v) const override {
    const auto s = d2(u, v);
    return {s.point, s.du, s.dv};
  }
  cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const double c = std::cos(u), s = std::sin(u);
    const auto f = field_->d2(v * c, v * s);
    const glm::dvec3 along = c * f.du + s * f.dv, across = -s * f.du + c * f.dv;
    const glm::dvec3 across2 = s * s * f.duu - 2 * s * c * f.duv + c * c * f.dvv,
                     mixed = s * c * (f.dvv - f.duu) + (c * c - s * s) * f.duv;
    return {f.point,
            v * across,
            along,
            v * v * across2 - v * along,
            across + v * mixed,
            c * c * f.duu + 2 * s * c * f.duv + s * s * f.dvv};
  }

 private:
  std::shared_ptr<const cad_import::ExactSurface> field_;
  double radius_;
};

/// Rings of vertices around the pole, counter-clockwise as seen from +z.
OpticSide polar_side(std::shared_ptr<const cad_import::ExactSurface> surface, double radius_mm) {
  constexpr std::uint32_t kRings = 12, kSectors = 48;
  OpticSide side;
  cad_import::Face face;
  face.id = "polar";
  face.surface = surface;
  face.trim = std::make_shared<test::RectangleTrim>(10, radius_mm);
  side.faces.push_back(face);
  for (std::uint32_t ring = 0; ring <= kRings; ++ring)
    for (std::uint32_t sector = 0; sector <= kSectors; ++sector) {
      const glm::dvec2 uv{2 * std::numbers::pi * sector / kSectors, radius_mm * ring / kRings};
      side.mesh.vertices.push_back(
          {surface->point(uv.x, uv.y), surface->unit_normal(uv.x, uv.y), 0, 0, {1, 0, 0}, 0, uv});
    }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto& v = side.mesh.vertices;
    side.mesh.triangles.push_back({{a, b, c}, 0, {v[a].uv, v[b].uv, v[c].uv}});
  };
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    for (std::uint32_t sector = 0; sector < kSectors; ++sector) {
      const std::uint32_t a = ring * (kSectors + 1) + sector, outer = a + kSectors + 1;
      if (ring > 0) add(a, outer, a + 1);
      add(outer, outer + 1, a + 1);
    }
  return side;
}

/// The power of a toric front is the same in either parameters: on the pole, so near that the second
/// derivatives fail, and where they do well.
TEST(LensEvaluator, PoleOfTheParametersOnTheAxis) {
  const auto front = std::make_shared<test::TwoCurvatureSurface>(0.012, 0.007, 0.4, 30, 30);
  const auto back = std::make_shared<test::ConicSurface>(0.005, 0, 30, 30);
  const Optic plain = test::lens_between(front, back, 4, 50, 41);
  Optic polar = plain;
  const OpticSide side = polar_side(std::make_shared<PolarSurface>(front, 30), 30);
  polar.faces = side.faces;
  polar.mesh = side.mesh;

  const LensFrame frame{.front_vertex_mm = {0, 0, 0}, .back_vertex_mm = {0, 0, -4}};
  const std::array<glm::dvec2, 5> points{{{0, 0}, {3e-6, 2e-6}, {2e-4, -1e-4}, {-0.02, 0.01}, {4, -7}}};
  const auto expected = LensEvaluator(plain, frame).at_points(points, {});
  const auto found = LensEvaluator(polar, frame).at_points(points, {});
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(found.points[i].end, LensPathEnd::passed) << i;
    // Beside the pole the curvature is taken from 1.5 um off; this front's changes by 1e-10 of itself there.
    EXPECT_NEAR(found.points[i].power.xx, expected.points[i].power.xx, 1e-6) << i;
    EXPECT_NEAR(found.points[i].power.xy, expected.points[i].power.xy, 1e-6) << i;
    EXPECT_NEAR(found.points[i].power.yy, expected.points[i].power.yy, 1e-6) << i;
  }
  EXPECT_NEAR(found.reference.cylinder_d, expected.reference.cylinder_d, 1e-6);
  EXPECT_NEAR(found.spectacle_magnification, expected.spectacle_magnification, 1e-9);
}

}  // namespace
}  // namespace catoptra::optics

// The error between a lens's vertices, measured as a GPU interpolates: the lens table of
// docs/decisions/0002-map-interpolation.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "optics/map_coordinates.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::optics {
namespace {

// The lens lies in z = 0 with its front towards +z; the wall stands 5 m before it, the eye behind it.
constexpr double kWallDistance_mm = 5000;

struct Quantiles {
  double median, p99;  ///< arcmin
};

struct Case {
  const char* name;
  double front_radius_mm, back_radius_mm, thickness_mm, width_mm;
  glm::dvec3 eye_mm;
};

// n = 1.5: powers of about +4 and -4 D as spectacles, an equiconvex lens whose image of the far wall stands
// on its head, and the +4 D lens looked at from the side.
constexpr Case kCases[] = {
    {"+4 D, 70 mm", 62.5, 122, 5, 50, {0, 0, -70}},
    {"-4 D, 60 mm", 125, 62, 2, 50, {0, 0, -60}},
    {"+4 D, 760 mm", 62.5, 122, 5, 50, {0, 0, -760}},
    {"+4 D, 20 deg", 62.5, 122, 5, 50, {26, 0, -70}},
};

glm::dvec3 on_wall(const glm::dvec3& origin, const glm::dvec3& direction) {
  return origin + direction * ((kWallDistance_mm - origin.z) / direction.z);
}

double angle_arcmin(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b))) * 60;
}

cad_import::TriangleMesh wall() {
  cad_import::TriangleMesh mesh;
  const float w = 2e5f, z = float(kWallDistance_mm);
  mesh.positions = {{-w, -w, z}, {w, -w, z}, {w, w, z}, {-w, w, z}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

Optic lens_of(const Case& c, int per_side) {
  return test::spherical_lens(c.front_radius_mm, c.back_radius_mm, c.thickness_mm, c.width_mm, per_side);
}

// Object-side error over the lens's picture: for the eye's ray through a point of a flat triangle, the angle
// at the exit point between the exact path and the direction to the point of the wall that the map shows.
Quantiles interpolation_error(const Case& c, int per_side, MapInterpolation interpolation) {
  const Optic lens = lens_of(c, per_side);
  const LensTracer tracer(lens);
  const LensSide entered = side_towards(lens, c.eye_mm);
  const LensIndices indices = lens_indices(lens, kLineD_nm);
  RayScene scene;
  scene.add_surroundings(wall());
  scene.commit();
  const auto hits = trace_vertices(lens, tracer, entered, kLineD_nm, c.eye_mm, scene);
  const VirtualView view = make_virtual_view(lens, entered, hits, {{-6000, -6000, -100}, {6000, 6000, 5000}});
  const auto coordinates = map_coordinates(lens, entered, hits, view, interpolation);

  std::vector<double> errors;
  const auto& mesh = *side_of(lens, entered).mesh;
  constexpr int kSamples = 4;  // a side of each triangle
  for (const auto& triangle : mesh.triangles) {
    if (std::ranges::any_of(triangle.vertices, [&](std::uint32_t v) { return !hits[v].faces_eye; })) continue;
    for (int i = 0; i < kSamples; ++i)
      for (int j = 0; i + j < kSamples; ++j) {
        const double u = (i + 1 / 3.0) / kSamples, v = (j + 1 / 3.0) / kSamples;
        const auto blend = [&](auto&& get) {
          return (1 - u - v) * get(triangle.vertices[0]) + u * get(triangle.vertices[1]) +
                 v * get(triangle.vertices[2]);
        };
        const glm::dvec3 chord = blend([&](std::uint32_t k) { return mesh.vertices[k].position_mm; });
        const auto exact = tracer.trace({c.eye_mm, glm::normalize(chord - c.eye_mm)}, entered, indices);
        if (exact.end != LensPathEnd::passed) continue;
        const glm::dvec3 h = blend([&](std::uint32_t k) { return coordinates[k]; });
        const Ray map = view.map_ray(h.x / h.z, h.y / h.z);
        errors.push_back(
            angle_arcmin(on_wall(map.origin_mm, map.direction) - exact.exit.position_mm, exact.outside));
      }
  }
  if (errors.size() < 100) return {1e9, 1e9};
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors[errors.size() * 99 / 100]};
}

// 1024 vertices. A pixel of a 1280-wide picture of 60 degrees is 2.8 arcmin. Where the eye sits near the
// point for which the surface distorts least, the three differ by less than a tenth of what is left.
TEST(LensInterpolation, FittedIsTheBestOfThree) {
  std::printf("1024 vertices, arcmin median / p99    affine            homography        fitted\n");
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    const Quantiles affine = interpolation_error(c, 32, MapInterpolation::affine);
    const Quantiles homography = interpolation_error(c, 32, MapInterpolation::homography);
    const Quantiles fitted = interpolation_error(c, 32, MapInterpolation::fitted);
    std::printf("%-28s %7.3f / %7.3f %7.3f / %7.3f %7.3f / %7.3f\n", c.name, affine.median, affine.p99,
                homography.median, homography.p99, fitted.median, fitted.p99);
    EXPECT_LT(fitted.median, 1.1 * std::min(affine.median, homography.median));
    EXPECT_LT(fitted.p99, 1.1 * std::min(affine.p99, homography.p99));
    EXPECT_LT(fitted.median, 0.03);  // measured 0.025, rounded up
    EXPECT_LT(fitted.p99, 0.12);
  }
}

TEST(LensInterpolation, ErrorFallsWithTheSquareOfTheMeshSize) {
  for (const Case& c : kCases)
    for (const MapInterpolation interpolation :
         {MapInterpolation::affine, MapInterpolation::homography, MapInterpolation::fitted}) {
      const Quantiles coarse = interpolation_error(c, 17, interpolation);
      const Quantiles fine = interpolation_error(c, 33, interpolation);
      const double order_median = std::log2(coarse.median / fine.median),
                   order_p99 = std::log2(coarse.p99 / fine.p99);
      std::printf("%s, interpolation %d: order %.2f (median), %.2f (p99)\n", c.name,
                  static_cast<int>(interpolation), order_median, order_p99);
      EXPECT_GT(order_median, 1.8);
      EXPECT_LT(order_median, 2.2);
    }
}

TEST(LensInterpolation, PlaneParallelPlate) {
  for (const double z : {-70.0, -760.0}) {
    const Case plate{"plate", 0, 0, 5, 50, {10, 0, z}};
    for (const MapInterpolation interpolation :
         {MapInterpolation::affine, MapInterpolation::homography, MapInterpolation::fitted}) {
      const Quantiles error = interpolation_error(plate, 32, interpolation);
      std::printf("plate, eye %.0f mm, interpolation %d: %.4f / %.4f\n", z, static_cast<int>(interpolation),
                  error.median, error.p99);
      if (interpolation != MapInterpolation::affine) {
        EXPECT_LT(error.p99, 0.001);
      }
    }
  }
}

}  // namespace
}  // namespace catoptra::optics

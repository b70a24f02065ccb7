// One view volume and one map for all wavelengths of a lens.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "cad_import/error.h"
#include "optics/map_coordinates.h"
#include "optics/spectrum.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::optics {
namespace {

const cad_import::BoundingBox kBounds{{-9000, -9000, -100}, {9000, 9000, 3000}};

// A lens that disperses strongly (V = 30), a wall 3 m before it, and the eye where spectacles have it.
struct Bench {
  Optic lens;
  glm::dvec3 eye{4, -3, -40};
  RayScene scene;
  LensSide entered = LensSide::back;

  Bench(double front_radius_mm, double back_radius_mm, double thickness_mm)
      : lens(test::spherical_lens(front_radius_mm, back_radius_mm, thickness_mm, 40, 13)) {
    lens.medium = abbe_medium(1.6, 30);
    cad_import::TriangleMesh wall;
    wall.positions = {{-9000, -9000, 3000}, {9000, -9000, 3000}, {9000, 9000, 3000}, {-9000, 9000, 3000}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.add_surroundings(wall);
    scene.commit();
    entered = side_towards(lens, eye);
  }

  std::vector<VertexHit> hits(double wavelength_nm) const {
    return trace_vertices(lens, LensTracer(lens), entered, wavelength_nm, eye, scene);
  }
};

TEST(LensView, OneVolumeHoldsTheRaysOfAllWavelengths) {
  for (const auto& [front, back, thickness] : {std::array{60.0, 200.0, 5.0}, std::array{200.0, 60.0, 2.0}}) {
    const Bench bench(front, back, thickness);
    std::vector<VertexHit> all;
    for (const SpectralSample& sample : spectral_samples(5)) {
      const auto of_sample = bench.hits(sample.wavelength_nm);
      all.insert(all.end(), of_sample.begin(), of_sample.end());
    }
    const VirtualView view = make_virtual_view(bench.lens, bench.entered, all, kBounds);
    for (const VertexHit& hit : all) {
      if (!hit.faces_eye) continue;
      const glm::dvec3 h = view.project_point(hit.hit_point_mm);
      ASSERT_GT(h.z, 0);
      for (const double x : {h.x / h.z, h.y / h.z}) {
        EXPECT_GT(x, 0);
        EXPECT_LT(x, 1);
      }
    }
  }
}

TEST(LensView, RefusesRaysOfAnotherMesh) {
  const Bench bench(60, 200, 5);
  auto hits = bench.hits(kLineD_nm);
  hits.pop_back();
  EXPECT_THROW((void)make_virtual_view(bench.lens, bench.entered, hits, kBounds), Error);
  EXPECT_THROW((void)make_virtual_view(bench.lens, bench.entered, {}, kBounds), Error);
  EXPECT_THROW((void)map_coordinates(bench.lens, bench.entered, hits, VirtualView{}), Error);
  EXPECT_THROW((void)map_coordinates_like(std::vector<glm::dvec3>(3), hits, VirtualView{}), Error);
}

TEST(LensView, AnEyeThatSeesNothingThroughTheLensIsAnError) {
  const Bench bench(60, 200, 5);
  const auto hits = trace_vertices(bench.lens, LensTracer(bench.lens), other_side(bench.entered), kLineD_nm,
                                   bench.eye, bench.scene);
  try {
    (void)make_virtual_view(bench.lens, other_side(bench.entered), hits, kBounds);
    FAIL() << "a view of nothing was made";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("turn the lens"), std::string::npos) << error.what();
  }
}

// At every wavelength each vertex shows its own hit; what is shared is the map and how it is interpolated.
TEST(LensMap, EveryWavelengthShowsItsOwnHits) {
  const Bench bench(200, 60, 2);
  const auto red = bench.hits(kLineC_nm), blue = bench.hits(kLineF_nm), green = bench.hits(kLineE_nm);
  std::vector<VertexHit> all(green);
  for (const auto* hits : {&red, &blue}) all.insert(all.end(), hits->begin(), hits->end());
  const VirtualView view = make_virtual_view(bench.lens, bench.entered, all, kBounds);
  const auto reference = map_coordinates(bench.lens, bench.entered, green, view);
  EXPECT_EQ(map_coordinates_like(reference, green, view).size(), reference.size());
  double split = 0;
  for (const auto* hits : {&red, &green, &blue}) {
    const auto coordinates = map_coordinates_like(reference, *hits, view);
    for (std::size_t i = 0; i < hits->size(); ++i) {
      const VertexHit& hit = (*hits)[i];
      if (!hit.faces_eye || !green[i].faces_eye) continue;
      EXPECT_EQ(coordinates[i].z, reference[i].z);
      const Ray shown =
          view.map_ray(coordinates[i].x / coordinates[i].z, coordinates[i].y / coordinates[i].z);
      EXPECT_LT(glm::length(glm::cross(hit.hit_point_mm - shown.origin_mm, shown.direction)), 1e-8);  // mm
      split = std::max(split, glm::distance(hit.hit_point_mm, green[i].hit_point_mm));
    }
  }
  EXPECT_GT(split, 1);  // mm on the wall: there was something to tell apart
}

// Prism divided by Abbe number (transverse chromatic aberration), at several heights of rays along the axis.
// Both the thin-prism rule and the two-term curve are first order in the dispersion: good to 2 %.
TEST(LensMap, ChromaticSplitIsPrismByAbbeNumber) {
  for (const auto& [front, back, thickness] : {std::array{75.0, 150.0, 5.0}, std::array{300.0, 75.0, 2.0}}) {
    const Bench bench(front, back, thickness);
    const LensTracer tracer(bench.lens);
    for (const double height : {3.0, 6.0, 9.0, 12.0, 15.0}) {
      const auto deviation = [&](double wavelength_nm) {
        const LensPath path = tracer.trace({{height, 0, 50}, {0, 0, -1}}, LensSide::front,
                                           lens_indices(bench.lens, wavelength_nm));
        EXPECT_EQ(path.end, LensPathEnd::passed);
        return path.outside.x / -path.outside.z;  // prism dioptres are 100 times the tangent
      };
      const double split = deviation(kLineF_nm) - deviation(kLineC_nm);
      EXPECT_NEAR(split / (deviation(kLineD_nm) / 30), 1, 0.02) << height << " mm";
    }
  }
}

}  // namespace
}  // namespace catoptra::optics

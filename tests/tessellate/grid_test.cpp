// Faces that fill a rectangle of their parameters.
#include <gtest/gtest.h>

#include "cad_import/error.h"
#include "tessellate/optic_mesh.h"
#include "tests/support/analytic_optic.h"
#include "tests/tessellate/mesh_checks.h"

namespace catoptra::test {
namespace {

using tessellate::tessellate_optic;
using tessellate::TessellationOptions;

cad_import::Face conic_face(double radius_mm, double width_mm, double height_mm, double conic = 0) {
  cad_import::Face face = conic_mirror(radius_mm, conic, width_mm, height_mm, 2, 2).faces.front();
  return face;
}

TEST(Grid, PlaneRectangleNeedsFourVertices) {
  const std::vector faces{conic_face(0, 170, 110)};
  const auto result = tessellate_optic(faces);
  EXPECT_EQ(result.mesh.vertex_count(), 4u);
  EXPECT_EQ(result.mesh.triangle_count(), 2u);
  EXPECT_NEAR(mesh_area_mm2(result.mesh), 170 * 110, 1e-9);
  EXPECT_GT(least_normal_agreement(result.mesh), 1 - 1e-12);
}

TEST(Grid, ExactRequestIsTheGridOfTheTestSupport) {
  const std::vector faces{conic_face(1200, 170, 110)};
  TessellationOptions options;
  options.grid = {7, 7};
  const auto arrays = tessellate_optic(faces, options).mesh.arrays();
  const auto expected = conic_mirror(1200, 0, 170, 110, 7, 7).mesh;
  ASSERT_EQ(arrays.vertices.size(), 49u);
  EXPECT_EQ(arrays.triangles.size(), 72u);
  for (const auto& v : arrays.vertices) {
    const bool found = std::any_of(expected.vertices.begin(), expected.vertices.end(), [&](const auto& e) {
      return glm::distance(e.position_mm, v.position_mm) < 1e-10 &&
             glm::distance(e.normal, v.normal) < 1e-12 && std::abs(e.k1 - v.k1) < 1e-14;
    });
    EXPECT_TRUE(found) << v.uv.x << ' ' << v.uv.y;
  }
}

TEST(Grid, KeepsChordOnSphere) {
  for (const double radius : {1200.0, -1200.0, 300.0})
    for (const double chord : {0.1, 0.01, 0.001}) {
      const std::vector faces{conic_face(radius, 170, 110)};
      TessellationOptions options;
      options.chord_mm = chord;
      const auto result = tessellate_optic(faces, options);
      EXPECT_LE(vertex_error_mm(result.mesh), 1e-9);
      EXPECT_LE(chord_error_mm(result.mesh), chord);
      EXPECT_GT(chord_error_mm(result.mesh), 0.3 * chord)
          << "finer than asked for: " << result.mesh.vertex_count();
      EXPECT_EQ(euler_characteristic(result.mesh), 1);
      EXPECT_EQ(boundary_loops(result.mesh), 1);
      EXPECT_GT(least_normal_agreement(result.mesh), 0.99);
    }
}

TEST(Grid, SubdivisionHalvesTheWidthOnTheExactSurface) {
  const std::vector faces{conic_face(300, 170, 110, -1)};
  TessellationOptions options;
  options.grid = {5, 5};
  const auto coarse = tessellate_optic(faces, options).mesh;
  const auto fine = coarse.subdivided(), finer = fine.subdivided();
  EXPECT_EQ(fine.vertex_count(), 81u);
  EXPECT_EQ(finer.vertex_count(), 289u);
  EXPECT_LE(vertex_error_mm(finer), 1e-9);
  EXPECT_EQ(boundary_loops(finer), 1);
  EXPECT_GT(least_normal_agreement(finer), 0.99);
  const double order = std::log2(chord_error_mm(fine) / chord_error_mm(finer));
  EXPECT_GT(order, 1.8);
  EXPECT_LT(order, 2.2);
}

TEST(Grid, BadOptionsAreErrors) {
  const std::vector faces{conic_face(0, 10, 10)};
  TessellationOptions options;
  options.chord_mm = 0;
  EXPECT_THROW(static_cast<void>(tessellate_optic(faces, options)), Error);
  options = {};
  options.grid = {1, 5};
  EXPECT_THROW(static_cast<void>(tessellate_optic(faces, options)), Error);
  EXPECT_THROW(static_cast<void>(tessellate_optic({})), Error);
}

}  // namespace
}  // namespace catoptra::test

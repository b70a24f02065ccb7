// Meshes by number of vertices instead of by chord, and limits on that number.
#include <gtest/gtest.h>

#include "tessellate/optic_mesh.h"
#include "tests/tessellate/mesh_checks.h"
#include "tests/tessellate/test_faces.h"

namespace catoptra::test {
namespace {

using tessellate::tessellate_optic;
using tessellate::TessellationOptions;

SurfacePtr sphere_mirror() {
  return std::make_shared<ConicSurface>(1 / 1200.0, 0, 85, 55);
}

TEST(Request, FortyNineIsThePapersGrid) {
  TessellationOptions options;
  options.target_vertices = 49;
  const auto mesh = tessellate_optic(std::vector{make_face(sphere_mirror(), {})}, options).mesh;
  EXPECT_EQ(mesh.vertex_count(), 49u);
  EXPECT_EQ(mesh.triangle_count(), 72u);
}

TEST(Request, AboutTheTargetOnAnyOutline) {
  const auto surface = sphere_mirror();
  for (const std::size_t target : {49u, 300u, 1000u}) {
    TessellationOptions options;
    options.target_vertices = target;
    for (const auto& loop :
         {rounded_loop(surface, 170, 110, 20, 0), circle_loop(surface, {0, 0}, 55, 0, false)}) {
      const auto mesh = tessellate_optic(std::vector{make_face(surface, {loop})}, options).mesh;
      EXPECT_NEAR(static_cast<double>(mesh.vertex_count()), static_cast<double>(target),
                  0.15 * static_cast<double>(target));
      EXPECT_LE(vertex_error_mm(mesh), 1e-9);
      EXPECT_EQ(boundary_loops(mesh), 1);
    }
  }
}

TEST(Request, GridOnARoundedOutlineIsCutByTheBorder) {
  const auto surface = sphere_mirror();
  TessellationOptions options;
  options.grid = {18, 12};
  const auto mesh =
      tessellate_optic(std::vector{make_face(surface, {rounded_loop(surface, 170, 110, 20, 0)})}, options)
          .mesh;
  EXPECT_GT(mesh.vertex_count(), 150u);
  EXPECT_LT(mesh.vertex_count(), 250u);
  EXPECT_EQ(euler_characteristic(mesh), 1);
}

TEST(Request, AtLeastSoManyVertices) {
  TessellationOptions options;
  options.chord_mm = 10;
  options.min_vertices = 200;
  const auto mesh = tessellate_optic(std::vector{make_face(sphere_mirror(), {})}, options).mesh;
  EXPECT_GE(mesh.vertex_count(), 200u);
  EXPECT_LT(mesh.vertex_count(), 400u);
}

TEST(Request, TooFineAChordIsCoarsenedAndSaid) {
  TessellationOptions options;
  options.chord_mm = 1e-6;
  options.max_vertices = 5000;
  const auto surface = sphere_mirror();
  for (const auto& face :
       {make_face(surface, {}), make_face(surface, {rounded_loop(surface, 170, 110, 20, 0)})}) {
    const auto result = tessellate_optic(std::vector{face}, options);
    EXPECT_LE(result.mesh.vertex_count(), 5000u);
    EXPECT_GT(result.mesh.vertex_count(), 1000u);
    ASSERT_EQ(result.warnings.size(), 1u);
  }
}

}  // namespace
}  // namespace catoptra::test

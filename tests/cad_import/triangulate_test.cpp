// Triangles for the surroundings: on the surface, outward, coloured, and the same however often they are
// asked for.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "cad_import/import.h"
#include "tests/cad_import/cad_files.h"

namespace catoptra::cad_import {
namespace {

CadModel ball(const ScratchFolder& folder, const ImportOptions& options = {}) {
  test::CadDocument document;
  const TDF_Label part = document.add(BRepPrimAPI_MakeSphere(50).Shape(), "Ball");
  document.color(part, 0.5, 0.25, 0.125);
  document.write_step(folder / "ball.step");
  return import_cad(folder / "ball.step", options);
}

double signed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    volume += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return volume;
}

TEST(Triangulate, SphereIsOnTheSurfaceAndFacesOutward) {
  const ScratchFolder folder;
  const CadModel model = ball(folder);
  TriangulationOptions options;
  options.chord_mm = 0.05;
  const TriangleMesh mesh = triangulate(model, {}, options);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
  ASSERT_EQ(mesh.triangle_material.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_NEAR(glm::length(mesh.positions[i]), 50, 1e-4);  // float at 50 mm: 4e-6; the kernel's edges: 1e-7
    EXPECT_GT(glm::dot(mesh.normals[i], mesh.positions[i] / 50.0f), 1 - 1e-6f);
  }
  const double exact = 4.0 / 3 * std::numbers::pi * 125000;
  // Chords of sagitta e take about 3 e / R of the volume at most.
  EXPECT_NEAR(signed_volume(mesh), exact, 3 * 0.05 / 50 * exact);
  ASSERT_EQ(mesh.materials.size(), 1u);
  EXPECT_LT(glm::length(mesh.materials[0].base_color - glm::vec3(0.5f, 0.25f, 0.125f)), 1e-6f);
  EXPECT_TRUE(mesh.warnings.empty());
}

TEST(Triangulate, DependsOnItsOwnOptionsOnly) {
  const ScratchFolder folder;
  const CadModel model = ball(folder);
  TriangulationOptions coarse, fine;
  coarse.chord_mm = 1;
  coarse.angle_rad = 0.5;
  fine.chord_mm = 0.02;
  const std::size_t before = triangulate(model, {}, coarse).triangles.size();
  EXPECT_GT(triangulate(model, {}, fine).triangles.size(), 2 * before);
  EXPECT_EQ(triangulate(model, {}, coarse).triangles.size(), before);
}

TEST(Triangulate, ScaledAndMirroredStaysOutward) {
  const ScratchFolder folder;
  ImportOptions options;
  options.scale = 10;
  options.placement = glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1));
  const CadModel model = ball(folder, options);
  TriangulationOptions chord;
  chord.chord_mm = 0.5;
  const TriangleMesh mesh = triangulate(model, {}, chord);
  const double exact = 4.0 / 3 * std::numbers::pi * 125e6;
  EXPECT_NEAR(signed_volume(mesh), exact, 3 * 0.5 / 500 * exact);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    EXPECT_GT(glm::dot(mesh.normals[i], mesh.positions[i] / 500.0f), 1 - 1e-6f);
}

TEST(Triangulate, SomeFacesOnlyInTheDefaultColour) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step");
  const CadModel model = import_cad(folder / "box.step");
  const std::vector<int> faces{0, 3};
  const TriangleMesh mesh = triangulate(model, faces, {}, glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(mesh.materials.at(0).base_color, glm::vec3(0.1f, 0.2f, 0.3f));
  const std::vector<int> wrong{6};
  EXPECT_THROW((void)triangulate(model, wrong), ImportError);
  EXPECT_THROW((void)triangulate(CadModel{}, {}), ImportError);
  EXPECT_THROW((void)triangulate(model, {}, {0, 0.2}), ImportError);
}

}  // namespace
}  // namespace catoptra::cad_import

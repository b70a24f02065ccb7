// Meshes that are split edge by edge: conforming, on the exact surface, without memory.
#include "tessellate/refined_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <vector>

#include "tessellate/optic_mesh.h"
#include "tests/support/analytic_optic.h"
#include "tests/tessellate/test_faces.h"

namespace catoptra::test {
namespace {

using tessellate::OpticArrays;
using tessellate::RefinedMesh;

/// Splits every edge longer than `length_mm(middle)` until none is, or `levels` are done.
template <typename Length>
void refine_to(RefinedMesh& mesh, int levels, const Length& length_mm) {
  mesh.restart();
  for (int level = 0; level < levels; ++level) {
    std::vector<char> wanted;
    for (const auto& edge : mesh.new_edges()) {
      const auto& v = mesh.mesh().vertices;
      wanted.push_back(glm::distance(v[edge.ends[0]].position_mm, v[edge.ends[1]].position_mm) >
                       length_mm(mesh.middle(edge).position_mm));
    }
    mesh.split(wanted);
  }
}

/// Fine near a corner, coarse elsewhere: neighbours of very different level.
double near_corner(const glm::dvec3& at) {
  return 1.5 + 0.25 * std::hypot(at.x - 85, at.y - 55);
}

/// How often each undirected edge, told by the places of its ends, is used; every use must run the other way.
void expect_conforming(const OpticArrays& mesh, std::size_t border_edges) {
  using Place = std::array<double, 3>;
  const auto place = [&](std::uint32_t i) {
    const auto& p = mesh.vertices[i].position_mm;
    return Place{p.x, p.y, p.z};
  };
  std::map<std::pair<Place, Place>, int> uses;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++uses[{place(t.vertices[k]), place(t.vertices[(k + 1) % 3])}];
  std::size_t border = 0;
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1) << "two triangles run along an edge in the same direction";
    if (!uses.contains({edge.second, edge.first})) ++border;
  }
  EXPECT_EQ(border, border_edges) << "a hanging vertex would leave edges with one triangle";
}

double area_in_plan(const OpticArrays& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.vertices[t.vertices[0]].position_mm, &b = mesh.vertices[t.vertices[1]].position_mm,
               &c = mesh.vertices[t.vertices[2]].position_mm;
    const double twice = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    EXPECT_GT(twice, 0) << "a triangle is turned over";
    area += 0.5 * twice;
  }
  return area;
}

/// Vertices on the border of the 170 x 110 rectangle: as many border edges as there are.
std::size_t on_border(const OpticArrays& mesh) {
  return static_cast<std::size_t>(
      std::count_if(mesh.vertices.begin(), mesh.vertices.end(), [](const auto& v) {
        return std::abs(std::abs(v.position_mm.x) - 85) < 1e-9 ||
               std::abs(std::abs(v.position_mm.y) - 55) < 1e-9;
      }));
}

TEST(RefinedMesh, IsConformingAndOnTheSurfaceWhereLevelsDiffer) {
  const auto optic = conic_mirror(300, -0.5, 170, 110, 4, 3);
  RefinedMesh refined(optic.faces, optic.mesh);
  refine_to(refined, 8, near_corner);
  const OpticArrays& mesh = refined.mesh();
  EXPECT_GT(mesh.vertices.size(), 100u);
  expect_conforming(mesh, on_border(mesh));
  EXPECT_NEAR(area_in_plan(mesh), 170 * 110, 1e-8);
  for (const auto& v : mesh.vertices) {
    EXPECT_LT(glm::distance(v.position_mm, optic.faces[0].surface->point(v.uv.x, v.uv.y)), 1e-12);
    EXPECT_LT(glm::distance(v.normal, optic.faces[0].surface->unit_normal(v.uv.x, v.uv.y)), 1e-12);
  }
}

TEST(RefinedMesh, KeepsTheBaseVerticesFirstAndNamesParentsBeforeChildren) {
  const auto optic = conic_mirror(300, 0, 170, 110, 4, 3);
  RefinedMesh refined(optic.faces, optic.mesh);
  refine_to(refined, 5, near_corner);
  for (std::size_t i = 0; i < optic.mesh.vertices.size(); ++i)
    EXPECT_EQ(refined.mesh().vertices[i].position_mm, optic.mesh.vertices[i].position_mm);
  ASSERT_EQ(refined.parents().size() + optic.mesh.vertices.size(), refined.mesh().vertices.size());
  for (std::size_t k = 0; k < refined.parents().size(); ++k) {
    const std::size_t child = optic.mesh.vertices.size() + k;
    const auto [a, b] = refined.parents()[k];
    ASSERT_LT(a, child);
    ASSERT_LT(b, child);
    const auto& v = refined.mesh().vertices;
    EXPECT_LT(glm::distance(v[child].uv, 0.5 * (v[a].uv + v[b].uv)), 1e-12);
  }
}

TEST(RefinedMesh, SameAnswersGiveTheSameMeshWhateverWasAskedBefore) {
  const auto optic = conic_mirror(300, 0, 170, 110, 4, 3);
  RefinedMesh fresh(optic.faces, optic.mesh), used(optic.faces, optic.mesh);
  refine_to(fresh, 6, near_corner);
  refine_to(used, 7, [](const glm::dvec3& at) { return 3 + 0.4 * std::hypot(at.x + 85, at.y); });
  refine_to(used, 6, near_corner);
  ASSERT_EQ(used.mesh().vertices.size(), fresh.mesh().vertices.size());
  for (std::size_t i = 0; i < fresh.mesh().vertices.size(); ++i) {
    EXPECT_EQ(used.mesh().vertices[i].position_mm, fresh.mesh().vertices[i].position_mm);
    EXPECT_EQ(used.mesh().vertices[i].normal, fresh.mesh().vertices[i].normal);
  }
  ASSERT_EQ(used.mesh().triangles.size(), fresh.mesh().triangles.size());
  for (std::size_t t = 0; t < fresh.mesh().triangles.size(); ++t)
    EXPECT_EQ(used.mesh().triangles[t].vertices, fresh.mesh().triangles[t].vertices);
  used.restart();
  EXPECT_EQ(used.mesh().vertices.size(), optic.mesh.vertices.size());
}

TEST(RefinedMesh, ClosesAtSeamsAndPoles) {
  const std::vector faces{make_face(std::make_shared<SphereSurface>(25), {})};
  const auto base = tessellate::tessellate_optic(faces, {.target_vertices = 60, .grid = {}}).mesh.arrays();
  RefinedMesh refined(faces, base);
  refine_to(refined, 5, [](const glm::dvec3& at) { return 2 + 0.4 * (25 - at.z); });
  EXPECT_GT(refined.mesh().vertices.size(), 2 * base.vertices.size());
  expect_conforming(refined.mesh(), 0);
  for (const auto& v : refined.mesh().vertices) EXPECT_NEAR(glm::length(v.position_mm), 25, 1e-9);
}

TEST(RefinedMesh, FollowsACurvedBorder) {
  const auto surface = std::make_shared<ConicSurface>(1 / 300.0, 0, 85, 55);
  const std::vector faces{make_face(surface, {circle_loop(surface, {0, 0}, 40, 0, false)})};
  const auto base = tessellate::tessellate_optic(faces, {.target_vertices = 30, .grid = {}}).mesh.arrays();
  RefinedMesh refined(faces, base);
  refine_to(refined, 4, [](const glm::dvec3&) { return 5; });
  std::size_t border = 0;
  for (const auto& v : refined.mesh().vertices)
    if (std::abs(glm::length(v.uv) - 40) < 1e-9) ++border;
  EXPECT_GT(border, 48u) << "pieces of 5 mm on a circle of 251 mm";
  expect_conforming(refined.mesh(), border);
}

/// Two triangles, on faces of their own, that meet in a crease along x = 0 with two vertices for each face.
struct Crease {
  std::vector<cad_import::Face> faces;
  OpticArrays mesh;
};
Crease crease() {
  Crease made;
  made.faces = {conic_mirror(200, 0, 40, 40, 2, 2).faces[0], conic_mirror(90, 0, 40, 40, 2, 2).faces[0]};
  const std::array<glm::dvec2, 3> corners[] = {{{{0, 0}, {0, 20}, {-20, 0}}}, {{{0, 20}, {0, 0}, {20, 0}}}};
  for (int face = 0; face < 2; ++face) {
    tessellate::OpticTriangle triangle{{}, face, corners[face]};
    for (std::size_t k = 0; k < 3; ++k) {
      tessellate::OpticVertex vertex{};
      vertex.position_mm = {corners[face][k], 0};
      vertex.normal = {0, 0, 1};
      vertex.face = face;
      vertex.uv = corners[face][k];
      triangle.vertices[k] = static_cast<std::uint32_t>(made.mesh.vertices.size());
      made.mesh.vertices.push_back(vertex);
    }
    made.mesh.triangles.push_back(triangle);
  }
  return made;
}

TEST(RefinedMesh, BothFacesAtACreaseShareTheMiddleAndKeepTheirNormals) {
  const Crease made = crease();
  RefinedMesh refined(made.faces, made.mesh);
  std::vector<char> wanted;  // only the left face asks for the crease
  for (const auto& edge : refined.new_edges()) wanted.push_back(edge.ends == std::array{0u, 1u});
  ASSERT_EQ(std::count(wanted.begin(), wanted.end(), char(1)), 1);
  refined.split(wanted);
  ASSERT_EQ(refined.mesh().vertices.size(), 8u);
  const auto &a = refined.mesh().vertices[6], &b = refined.mesh().vertices[7];
  EXPECT_EQ(a.position_mm, b.position_mm);
  EXPECT_NE(a.face, b.face);
  EXPECT_EQ(refined.mesh().triangles.size(), 4u);
  expect_conforming(refined.mesh(), 4);
  EXPECT_EQ(a.position_mm, made.faces[0].surface->point(0, 10)) << "one of the two surfaces places it";
}

}  // namespace
}  // namespace catoptra::test

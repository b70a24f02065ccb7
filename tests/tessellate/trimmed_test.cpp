// Faces with curved borders, holes, seams and poles; faces that share borders; faces that cannot be meshed.
#include <gtest/gtest.h>

#include "cad_import/error.h"
#include "tessellate/optic_mesh.h"
#include "tests/tessellate/mesh_checks.h"
#include "tests/tessellate/test_faces.h"

namespace catoptra::test {
namespace {

using cad_import::Face;
using tessellate::tessellate_optic;
using tessellate::TessellationOptions;

constexpr double kPi = std::numbers::pi;

SurfacePtr conic(double radius_mm, double width_mm, double height_mm) {
  return std::make_shared<ConicSurface>(radius_mm == 0 ? 0 : 1 / radius_mm, 0, width_mm / 2, height_mm / 2);
}

void expect_sound(const OpticMesh& mesh, double chord_mm) {
  EXPECT_LE(vertex_error_mm(mesh), 1e-9);
  EXPECT_LE(chord_error_mm(mesh), chord_mm);
  EXPECT_GT(least_normal_agreement(mesh), 0.9);
  EXPECT_EQ(coincident_vertices(mesh, 1e-7), 0);
}

TEST(Trimmed, RoundedMirror) {
  const auto surface = conic(1200, 170, 110);
  const std::vector faces{make_face(surface, {rounded_loop(surface, 170, 110, 15, 0)})};
  const auto mesh = tessellate_optic(faces).mesh;
  expect_sound(mesh, 0.01);
  EXPECT_EQ(euler_characteristic(mesh), 1);
  EXPECT_EQ(boundary_loops(mesh), 1);
  EXPECT_LT(mesh.vertex_count(), 800u);
  // The area of the outline, and what the slope adds: (1 + (u^2 + v^2) / (2 R^2)) averaged over the
  // rectangle.
  const double outline = 170 * 110 - (4 - kPi) * 15 * 15;
  EXPECT_NEAR(mesh_area_mm2(mesh), outline * (1 + (85 * 85 + 55 * 55) / 3.0 / (2 * 1200 * 1200)), 5);
}

TEST(Trimmed, HolesAreHoles) {
  const auto surface = conic(-400, 200, 200);
  const std::vector faces{make_face(
      surface, {circle_loop(surface, {0, 0}, 100, 0, false), circle_loop(surface, {30, 10}, 20, 1, true),
                circle_loop(surface, {-40, 0}, 5, 2, true)})};
  const auto mesh = tessellate_optic(faces).mesh;
  expect_sound(mesh, 0.01);
  EXPECT_EQ(boundary_loops(mesh), 3);
  EXPECT_EQ(euler_characteristic(mesh), -1);
  for (const auto vertex : mesh.half_edges().vertices()) {
    const glm::dvec2 uv = mesh.half_edges().data(vertex).exact.uv;
    EXPECT_LE(glm::length(uv), 100 + 1e-9);
    EXPECT_GE(glm::distance(uv, glm::dvec2(30, 10)), 20 - 1e-9);
  }
}

TEST(Trimmed, PlaneHasOnlyItsBorder) {
  const auto surface = conic(0, 200, 200);
  const std::vector faces{make_face(surface, {rounded_loop(surface, 170, 110, 15, 0)})};
  const auto mesh = tessellate_optic(faces).mesh;
  EXPECT_NEAR(mesh_area_mm2(mesh), 170 * 110 - (4 - kPi) * 15 * 15, 0.5);
  EXPECT_EQ(euler_characteristic(mesh), 1);
}

TEST(Trimmed, SphereHasPolesAndSeamButNoBorder) {
  const std::vector faces{make_face(std::make_shared<SphereSurface>(25), {})};
  const auto mesh = tessellate_optic(faces).mesh;
  expect_sound(mesh, 0.01);
  EXPECT_EQ(euler_characteristic(mesh), 2);
  EXPECT_EQ(boundary_loops(mesh), 0);
  EXPECT_NEAR(mesh_area_mm2(mesh), 4 * kPi * 25 * 25, 8);
  EXPECT_EQ(mesh.arrays().vertices.size(), mesh.vertex_count())
      << "a smooth surface has one normal per point";
}

TEST(Trimmed, SphereWithHoleKeepsPolesAndSeam) {
  const auto sphere = std::make_shared<SphereSurface>(25);
  const auto natural = tessellate_optic(std::vector{make_face(sphere, {})}).mesh;
  auto loops = natural.faces().front().loops;
  loops.push_back(circle_loop(sphere, {3, 0.2}, 0.4, 1000, true));
  const auto mesh = tessellate_optic(std::vector{make_face(sphere, loops)}).mesh;
  expect_sound(mesh, 0.01);
  EXPECT_EQ(euler_characteristic(mesh), 1);
  EXPECT_EQ(boundary_loops(mesh), 1);
}

TEST(Trimmed, CylinderClosesAtItsSeam) {
  for (const bool inside_out : {false, true}) {
    const std::vector faces{make_face(std::make_shared<CylinderSurface>(30, 100, inside_out), {})};
    const auto mesh = tessellate_optic(faces).mesh;
    expect_sound(mesh, 0.01);
    EXPECT_EQ(euler_characteristic(mesh), 0);
    EXPECT_EQ(boundary_loops(mesh), 2);
    const auto fine = mesh.subdivided();
    expect_sound(fine, 0.01 / 3);
    EXPECT_EQ(euler_characteristic(fine), 0);
    EXPECT_EQ(fine.triangle_count(), 4 * mesh.triangle_count());
  }
}

/// Two halves of a sphere-like dish, joined along a curved border.
std::vector<Face> two_halves(const SurfacePtr& left, const SurfacePtr& right) {
  const auto wave = [](double t) { return glm::dvec2(8 * std::sin(2 * kPi * t), -50 + 100 * t); };
  const auto middle = edge(right, 0, 0, 1, wave);
  cad_import::TrimLoop left_loop, right_loop;
  left_loop.edges = {edge(left, 0, 0, 1, wave), line(left, 1, 1, 2, {0, 50}, {-80, 50}),
                     line(left, 2, 2, 3, {-80, 50}, {-80, -50}), line(left, 3, 3, 0, {-80, -50}, {0, -50})};
  right_loop.edges = {backwards(middle, right, wave), line(right, 4, 0, 4, {0, -50}, {80, -50}),
                      line(right, 5, 4, 5, {80, -50}, {80, 50}), line(right, 6, 5, 1, {80, 50}, {0, 50})};
  return {make_face(left, {left_loop}), make_face(right, {right_loop})};
}

TEST(Trimmed, NeighboursShareTheirBorder) {
  const auto surface = conic(300, 160, 100);
  const auto faces = two_halves(surface, surface);
  const auto mesh = tessellate_optic(faces).mesh;
  expect_sound(mesh, 0.01);
  EXPECT_EQ(boundary_loops(mesh), 1);
  EXPECT_EQ(euler_characteristic(mesh), 1);
  EXPECT_EQ(mesh.arrays().vertices.size(), mesh.vertex_count()) << "a smooth border has one normal per point";
  const auto fine = mesh.subdivided();
  EXPECT_LE(vertex_error_mm(fine), 1e-9);
  EXPECT_EQ(boundary_loops(fine), 1);
  EXPECT_EQ(coincident_vertices(fine, 1e-7), 0);
}

TEST(Trimmed, CreaseRepeatsVerticesInTheArraysOnly) {
  // Two planes that meet at an angle along v: a roof.
  class Roof : public ConicSurface {
   public:
    explicit Roof(double slope) : ConicSurface(0, 0, 80, 50), slope_(slope) {}
    glm::dvec3 point(double u, double v) const override { return {u, v, slope_ * u}; }
    cad_import::SurfaceFrame d1(double u, double v) const override {
      return {point(u, v), {1, 0, slope_}, {0, 1, 0}};
    }
    cad_import::SurfaceDerivatives d2(double u, double v) const override {
      return {point(u, v), {1, 0, slope_}, {0, 1, 0}, {}, {}, {}};
    }

   private:
    double slope_;
  };
  const SurfacePtr left = std::make_shared<Roof>(0.1), right = std::make_shared<Roof>(-0.1);
  const std::vector faces{
      make_face(left, {polygon_loop(left, {{-80, -50}, {0, -50}, {0, 50}, {-80, 50}}, 0)}),
      make_face(right,
                {{{backwards(line(left, 1, 1, 2, {0, -50}, {0, 50}), right,
                             [](double t) { return glm::dvec2(0, -50 + 100 * t); }),
                   line(right, 10, 1, 10, {0, -50}, {80, -50}), line(right, 11, 10, 11, {80, -50}, {80, 50}),
                   line(right, 12, 11, 2, {80, 50}, {0, 50})}}})};
  const auto mesh = tessellate_optic(faces).mesh;
  EXPECT_EQ(mesh.vertex_count(), 6u);
  EXPECT_EQ(mesh.arrays().vertices.size(), 8u);
  EXPECT_EQ(mesh.arrays(0.5).vertices.size(), 6u);
  EXPECT_GT(least_normal_agreement(mesh), 1 - 1e-12);
}

TEST(Trimmed, FacesThatCannotBeMeshedAreNamed) {
  const auto surface = conic(500, 100, 100);
  std::vector<Face> faces{
      make_face(surface, {rounded_loop(surface, 100, 100, 10, 0)}),
      make_face(surface, {polygon_loop(surface, {{0, 0}, {50, 47}, {50, 0}, {0, 31}}, 100)}),
      make_face(surface, {polygon_loop(surface, {{0, 0}, {20, 0}, {40, 0}}, 200)}), make_face(nullptr, {})};
  faces[1].id = "bow tie";
  const auto result = tessellate_optic(faces);
  ASSERT_EQ(result.unmeshed.size(), 3u);
  EXPECT_EQ(result.unmeshed[0].index, 1);
  EXPECT_EQ(result.unmeshed[0].id, "bow tie");
  EXPECT_NE(result.unmeshed[0].reason.find("crosses"), std::string::npos) << result.unmeshed[0].reason;
  EXPECT_EQ(result.unmeshed[1].index, 2);
  EXPECT_EQ(result.unmeshed[2].index, 3);
  EXPECT_EQ(boundary_loops(result.mesh), 1);
  EXPECT_THROW(static_cast<void>(tessellate_optic(std::span(faces).subspan(1))), Error);
}

}  // namespace
}  // namespace catoptra::test

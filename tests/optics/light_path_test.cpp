#include "optics/light_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "cad_import/error.h"
#include "optics/reflection.h"
#include "optics/refraction.h"

namespace catoptra::optics {
namespace {

/// A square of half-width `half` in the plane z = 0 about the origin, front up.
LightFace square(OpticKind kind, double half = 100) {
  LightFace face;
  face.kind = kind;
  face.pieces = {{{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}};
  return face;
}

Optic planar_optic(std::vector<glm::dvec3> corners, std::vector<std::array<std::uint32_t, 3>> triangles) {
  Optic optic;
  optic.name = "glass";
  optic.planar = true;
  optic.kind = OpticKind::refractor;
  for (const glm::dvec3& corner : corners) {
    tessellate::OpticVertex vertex;
    vertex.position_mm = corner;
    optic.mesh.vertices.push_back(vertex);
  }
  for (const auto& t : triangles) optic.mesh.triangles.push_back({t, 0, {}});
  return optic;
}

double area(const ConvexPolygon& polygon) {
  glm::dvec3 sum(0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += 0.5 * glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return glm::length(sum);
}

double area(const std::vector<ConvexPolygon>& pieces) {
  double sum = 0;
  for (const auto& piece : pieces) sum += area(piece);
  return sum;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(DiscPoints, HaveTheirMeanAtTheCentreAndFillTheDisc) {
  for (const int count : {1, 2, 3, 7, 16, 255, 256}) {
    SCOPED_TRACE(count);
    const auto points = disc_points(count);
    ASSERT_EQ(points.size(), std::size_t(count));
    glm::dvec2 mean(0);
    double squared = 0;
    for (const glm::dvec2& p : points) {
      EXPECT_LT(glm::length(p), 1);
      mean += p / double(count);
      squared += glm::dot(p, p) / count;
    }
    EXPECT_NEAR(glm::length(mean), 0, 1e-15);
    // Mean square radius of a disc 1/2; an odd count's centre stands for a disc of one share.
    EXPECT_NEAR(squared, count % 2 ? 0.5 - 0.5 / count / count : 0.5, 1e-14);
  }
  EXPECT_THROW((void)disc_points(0), Error);
}

TEST(DiscPoints, HalvesGetTheirShare) {
  // A half-plane through any point of the disc: the share before it differs from the segment's area by less
  // than a ring's width.
  constexpr int kCount = 256;
  const auto points = disc_points(kCount);
  double worst = 0;
  for (int turn = 0; turn < 24; ++turn)
    for (const double edge : {-0.8, -0.5, -0.2, 0.0, 0.3, 0.7}) {
      const double angle = turn * 0.41;
      const glm::dvec2 across(std::cos(angle), std::sin(angle));
      int before = 0;
      for (const glm::dvec2& p : points) before += glm::dot(p, across) < edge ? 1 : 0;
      const double segment = 1 - (std::acos(edge) - edge * std::sqrt(1 - edge * edge)) / std::numbers::pi;
      worst = std::max(worst, std::abs(double(before) / kCount - segment));
    }
  EXPECT_LT(worst, 2.5 / std::pow(kCount, 0.75));
}

TEST(DiscLights, LieOnTheirDisc) {
  const auto area_light = disc_lights({10, 20, 300, 1}, {0, 0, -2}, 50, 16);
  ASSERT_EQ(area_light.size(), 16u);
  for (const LightPlace& place : area_light) {
    EXPECT_EQ(place.w, 1);
    EXPECT_NEAR(place.z, 300, 1e-12);
    EXPECT_LT(glm::distance(glm::dvec3(place), glm::dvec3(10, 20, 300)), 50);
  }
  const glm::dvec3 sun = glm::normalize(glm::dvec3(1, 2, 3));
  for (const LightPlace& place : disc_lights({sun, 0}, {}, 50, 16)) {
    EXPECT_EQ(place.w, 0);
    EXPECT_NEAR(glm::length(glm::dvec3(place)), 1, 1e-15);
    EXPECT_LT(std::acos(glm::dot(glm::dvec3(place), sun)), std::atan(0.05));
  }
  EXPECT_EQ(disc_lights({sun, 0}, {}, 0, 16).size(), 1u);
}

TEST(LightFaces, PiecesAreConvexAndFillTheOutline) {
  // An L of 3 x 3 without its upper right 2 x 2, as four triangles: area 5, centroid (11, 11) / 10.
  const Optic l = planar_optic({{0, 0, 7}, {3, 0, 7}, {3, 1, 7}, {1, 1, 7}, {1, 3, 7}, {0, 3, 7}},
                               {{{0, 1, 2}}, {{0, 2, 3}}, {{0, 3, 4}}, {{0, 4, 5}}});
  const Optic other = planar_optic({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{{0, 1, 2}}});
  std::vector<Optic> optics{Optic{}, l, other};
  const auto faces = light_faces(optics);
  ASSERT_EQ(faces.size(), 2u);
  EXPECT_EQ(faces[0].optic, 1u);
  EXPECT_EQ(faces[0].pieces.size(), 2u);
  EXPECT_NEAR(area(faces[0].pieces), 5, 1e-12);
  expect_near(faces[0].normal, {0, 0, 1}, 1e-15);
  expect_near(faces[0].centroid_mm, {1.1, 1.1, 7}, 1e-12);
  optics[2].mesh.vertices[2].position_mm.z = 0.1;
  optics[2].mesh.vertices.push_back({});
  optics[2].mesh.triangles.push_back({{1, 2, 3}, 0, {}});
  optics[2].mesh.vertices[3].position_mm = {1, 1, 0};
  EXPECT_THROW((void)light_faces(optics), Error);
}

TEST(VirtualLights, MirrorsShowTheImage) {
  const std::vector<LightFace> faces{square(OpticKind::mirror)};
  const LightPlace point(30, 40, 200, 1);
  const auto lights = virtual_lights(point, faces, 3);
  ASSERT_EQ(lights.size(), 1u);
  EXPECT_EQ(lights[0].place, LightPlace(30, 40, -200, 1));
  EXPECT_EQ(lights[0].gain, 1);
  // P = (0, 0, 100): Q divides the way by heights.
  const auto path = light_path(lights, faces, point, 0, {0, 0, 100});
  ASSERT_TRUE(path);
  expect_near(path->points[0], {10, 40.0 / 3, 0}, 1e-12);
  EXPECT_NEAR(path->share.x, double(0.9f), 1e-15);
  EXPECT_FALSE(light_path(lights, faces, point, 0, {0, 0, -100})) << "behind the mirror";
  EXPECT_FALSE(light_path(lights, faces, point, 0, {300, 0, 100})) << "beside the light volume";
  const LightPlace sun(glm::normalize(glm::dvec3(1, 0, 1)), 0);
  expect_near(virtual_lights(sun, faces, 1)[0].place, glm::normalize(glm::dvec3(1, 0, -1)), 1e-15);
}

TEST(VirtualLights, OneSidedFacesAndThoseEdgeOnLightNothing) {
  std::vector<LightFace> faces{square(OpticKind::mirror)};
  EXPECT_EQ(virtual_lights({0, 0, -50, 1}, faces, 1).size(), 1u);
  EXPECT_EQ(virtual_lights({1, 0, 0, 0}, faces, 1).size(), 0u);
  faces[0].one_sided = true;
  EXPECT_EQ(virtual_lights({0, 0, -50, 1}, faces, 1).size(), 0u);
}

TEST(VirtualLights, DirectionsAreRefractedBySnellsLaw) {
  const std::vector<LightFace> faces{square(OpticKind::refractor)};
  const double a = 0.7, b = std::asin(std::sin(a) / 1.5);
  const auto lights = virtual_lights({std::sin(a), 0, std::cos(a), 0}, faces, 1);
  ASSERT_EQ(lights.size(), 2u);
  const VirtualLight& passed = lights[1];
  EXPECT_FALSE(passed.reflected);
  expect_near(passed.place, {std::sin(b), 0, std::cos(b)}, 1e-15);
  // Power into the aperture (1 x cos a) = power out of it (gain x cos b).
  EXPECT_NEAR(passed.gain * std::cos(b), std::cos(a), 1e-15);
  const double r = fresnel_dielectric(std::cos(a), 1, 1.5).unpolarised;
  EXPECT_NEAR(face_share(faces[0], passed, std::cos(a)).y, 1 - r, 1e-15);
  EXPECT_NEAR(face_share(faces[0], lights[0], std::cos(a)).y, r, 1e-15);
}

TEST(VirtualLights, NothingPassesBeyondTheCriticalAngle) {
  const std::vector<LightFace> faces{square(OpticKind::refractor)};
  const double beyond = std::asin(1 / 1.5) + 0.01;
  const auto lights = virtual_lights({std::sin(beyond), 0, -std::cos(beyond), 0}, faces, 1);
  ASSERT_EQ(lights.size(), 1u);
  EXPECT_TRUE(lights[0].reflected);
  EXPECT_EQ(face_share(faces[0], lights[0], std::cos(beyond)).x, 1);
}

TEST(VirtualLights, APointLightAppearsAtItsApparentDepth) {
  const std::vector<LightFace> faces{square(OpticKind::refractor)};
  // Into glass, straight down: n times as far. Out of it: 1 / n.
  EXPECT_NEAR(virtual_lights({0, 0, 200, 1}, faces, 1)[1].place.z, 300, 1e-12);
  EXPECT_NEAR(virtual_lights({0, 0, -300, 1}, faces, 1)[1].place.z, -200, 1e-12);
  // Oblique: on the ray refracted at the centroid, n s behind it.
  const double a = 0.6, b = std::asin(std::sin(a) / 1.5), s = 250;
  const auto light = virtual_lights({s * std::sin(a), 0, s * std::cos(a), 1}, faces, 1)[1];
  expect_near(light.place, {1.5 * s * std::sin(b), 0, 1.5 * s * std::cos(b)}, 1e-12);
  // The power on the face at the centroid is the same before and behind.
  EXPECT_NEAR(light.gain * std::cos(b) / (1.5 * s * 1.5 * s), std::cos(a) / (s * s), 1e-18);
}

/// Total of irradiance x area of light through a horizontal plane, by midpoints.
double flux_through(const LightPlace& place, double gain, double height, double x0, double x1, double y0,
                    double y1) {
  constexpr int kSteps = 400;
  const double dx = (x1 - x0) / kSteps, dy = (y1 - y0) / kSteps;
  double sum = 0;
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i)
      sum += unit_irradiance(place, {x0 + (i + 0.5) * dx, y0 + (j + 0.5) * dy, height}, {0, 0, 1}) * dx * dy;
  return gain * sum;
}

TEST(VirtualLights, ARefractorKeepsThePowerOfALight) {
  // A face small before its distance to the light, where the model of one virtual point holds: what goes in
  // comes out, to the second order of the size (here (2 / 500)^2), and all of it arrives further on.
  const std::vector<LightFace> faces{square(OpticKind::refractor, 1)};
  const LightPlace source(200, -100, 500, 1);
  const VirtualLight light = virtual_lights(source, faces, 1)[1];
  const double in = flux_through(source, 1, 0, -1, 1, -1, 1);
  EXPECT_NEAR(flux_through(light.place, light.gain, 0, -1, 1, -1, 1) / in, 1, 2e-5);
  // At z = -300 the aperture's shadow is bounded by the light volume.
  const double k = (light.place.z + 300) / light.place.z;
  const auto cast = [&](double edge, double centre) { return centre + k * (edge - centre); };
  const double out = flux_through(light.place, light.gain, -300, cast(-1, light.place.x),
                                  cast(1, light.place.x), cast(-1, light.place.y), cast(1, light.place.y));
  EXPECT_NEAR(out / in, 1, 2e-5);
}

TEST(VirtualLights, ADirectionThroughARefractorKeepsItsPower) {
  const std::vector<LightFace> faces{square(OpticKind::refractor)};
  const LightPlace sun(std::sin(1.0), 0, std::cos(1.0), 0);
  const VirtualLight light = virtual_lights(sun, faces, 1)[1];
  const auto volume = light_volume(light, light.aperture[0]);
  // The patch on z = -300 is as large as the face, and as bright on it.
  ConvexPolygon patch{{-2000, -2000, -300}, {2000, -2000, -300}, {2000, 2000, -300}, {-2000, 2000, -300}};
  for (const auto& plane : volume) patch = clip(patch, plane);
  EXPECT_NEAR(area(patch), 200 * 200, 1e-6);
  const double there = light.gain * unit_irradiance(light.place, {0, 0, -300}, {0, 0, 1});
  EXPECT_NEAR(there, unit_irradiance(sun, {0, 0, 0}, {0, 0, 1}), 1e-15);
}

TEST(VirtualLights, APaneShiftsPointsAndLeavesDirections) {
  LightFace pane = square(OpticKind::pane);
  pane.thickness_mm = 30;
  const std::vector<LightFace> faces{pane};
  EXPECT_EQ(virtual_lights({10, 20, 200, 1}, faces, 1)[1].place, LightPlace(10, 20, 190, 1));
  EXPECT_EQ(virtual_lights({10, 20, -200, 1}, faces, 1)[1].place, LightPlace(10, 20, -190, 1));
  const LightPlace sun(0.6, 0, 0.8, 0);
  const auto lights = virtual_lights(sun, faces, 1);
  EXPECT_EQ(lights[1].place, sun);
  EXPECT_EQ(lights[1].gain, 1);
  const double r = fresnel_dielectric(0.8, 1, 1.5).unpolarised;
  EXPECT_NEAR(face_share(pane, lights[0], 0.8).x, 2 * r / (1 + r), 1e-15);
  EXPECT_NEAR(face_share(pane, lights[1], 0.8).x, (1 - r) / (1 + r), 1e-15);
}

/// Two mirrors that face one another: z = 0 about the origin, and z = 400 about (x, 0).
std::vector<LightFace> facing_mirrors(double x, double half) {
  LightFace upper = square(OpticKind::mirror, half);
  upper.normal = {0, 0, -1};
  upper.centroid_mm = {x, 0, 400};
  for (glm::dvec3& p : upper.pieces[0]) p += upper.centroid_mm;
  return {square(OpticKind::mirror, half), upper};
}

TEST(VirtualLights, TwoMirrorsInSequence) {
  const auto faces = facing_mirrors(300, 100);
  // Sun at 45 degrees from -x: the lower mirror sends it to x = 400 +- 100 of the plane z = 400, of which the
  // upper one holds 300 .. 400; from there it comes down again at 700 .. 800.
  const LightPlace sun(glm::normalize(glm::dvec3(-1, 0, 1)), 0);
  const auto lights = virtual_lights(sun, faces, 2);
  ASSERT_EQ(lights.size(), 3u);  // lower; upper from above; lower, then upper from below
  const VirtualLight& twice = lights[2];
  EXPECT_EQ(twice.face, 1u);
  EXPECT_EQ(twice.before, 0);
  EXPECT_EQ(step_count(lights, 2), 2);
  EXPECT_NEAR(area(twice.aperture), 100 * 200, 1e-9);
  expect_near(twice.place, sun, 1e-15);
  const auto path = light_path(lights, faces, sun, 2, {750, 20, 0});
  ASSERT_TRUE(path);
  expect_near(path->points[0], {350, 20, 400}, 1e-12);
  expect_near(path->points[1], {-50, 20, 0}, 1e-12);
  EXPECT_NEAR(path->share.x, double(0.9f) * double(0.9f), 1e-15);
  EXPECT_FALSE(light_path(lights, faces, sun, 2, {690, 20, 0}));
  EXPECT_FALSE(light_path(lights, faces, sun, 2, {810, 20, 0}));
  // Further off, the lower one's light misses the upper one.
  EXPECT_EQ(virtual_lights(sun, facing_mirrors(700, 100), 2).size(), 2u);
}

TEST(VirtualLights, DepthBoundsTheSequence) {
  const auto faces = facing_mirrors(0, 1000);
  const LightPlace point(0, 0, 150, 1);
  for (int depth = 0; depth <= 6; ++depth) {
    const auto lights = virtual_lights(point, faces, depth);
    ASSERT_EQ(lights.size(), std::size_t(2 * depth));
    for (std::size_t i = 0; i < lights.size(); ++i) EXPECT_LE(step_count(lights, i), depth);
  }
  // Images in a corridor of 400: heights 150 - 300 = -150, 800 - 150 = 650, then 800 + 150 = 950, -650, ...
  const auto lights = virtual_lights(point, faces, 3);
  std::vector<double> heights;
  for (const auto& light : lights) heights.push_back(light.place.z);
  std::ranges::sort(heights);
  const std::vector<double> expected{-950, -650, -150, 650, 950, 1450};
  ASSERT_EQ(heights.size(), expected.size());
  for (std::size_t i = 0; i < heights.size(); ++i) EXPECT_NEAR(heights[i], expected[i], 1e-9);
}

TEST(Clip, KeepsWhatLiesOnThePlanesSide) {
  const ConvexPolygon unit{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_NEAR(area(clip(unit, {1, 0, 0, -0.25})), 0.75, 1e-15);
  EXPECT_NEAR(area(clip(unit, {-std::sqrt(0.5), -std::sqrt(0.5), 0, std::sqrt(0.5)})), 0.5, 1e-15);
  EXPECT_TRUE(clip(unit, {1, 0, 0, -2}).empty());
  EXPECT_EQ(clip(unit, {1, 0, 0, 2}), unit);
}

}  // namespace
}  // namespace catoptra::optics

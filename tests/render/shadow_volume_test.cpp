// Shadow volumes against rays: how often a point lies in them, and which edges are left.
#include "render/src/shadow_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <vector>

#include "render/src/shadow_overlaps.h"

namespace catoptra::render {
namespace {

using Corners = std::vector<glm::vec3>;

/// +1 or -1 where the segment from `p` along `d` (to infinity) crosses the triangle, whose corner (x, w) lies
/// at x / w or for w = 0 at infinity; + where it leaves by the outer side. Written with homogeneous
/// determinants, so that it needs no clipping.
int crossing(const glm::dvec3& p, const glm::dvec3& d, const std::array<glm::dvec4, 3>& t) {
  const auto relative = [&](const glm::dvec4& v) { return glm::dvec3(v) - v.w * p; };
  const glm::dvec3 a = relative(t[0]), b = relative(t[1]), c = relative(t[2]);
  const double u = glm::dot(d, glm::cross(b, c)), v = glm::dot(d, glm::cross(c, a)),
               w = glm::dot(d, glm::cross(a, b));
  // All of one sign: the line passes through the cone of the corners; the sign tells the side.
  if (!(u > 0 && v > 0 && w > 0) && !(u < 0 && v < 0 && w < 0)) return 0;
  const double determinant = glm::dot(a, glm::cross(b, c));
  if (determinant == 0 || (determinant > 0) != (u > 0)) return 0;  // behind the start
  return u > 0 ? 1 : -1;
}

std::array<glm::dvec4, 3> homogeneous(const ShadowCasters& casters, const glm::dvec4& light,
                                      const std::uint32_t* indices) {
  std::array<glm::dvec4, 3> t;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 p(casters.positions[indices[k] / 2]);
    t[k] = indices[k] % 2 == 0 ? glm::dvec4(p, 1) : glm::dvec4(light.w * p - glm::dvec3(light), 0);
  }
  return t;
}

int count_in_volume(const ShadowCasters& casters, const ShadowVolume& volume, const glm::dvec4& light,
                    const glm::dvec3& point, const glm::dvec3& way) {
  int count = 0;
  for (std::size_t i = 0; i < volume.indices.size(); i += 3)
    count += crossing(point, way, homogeneous(casters, light, &volume.indices[i]));
  return count;
}

/// Triangles that the segment from the point to the light crosses, with Moeller and Trumbore's test; and
/// those of them that face the light.
struct Between {
  int all = 0, facing = 0;
};
Between between(const Corners& corners, const glm::dvec4& light, const glm::dvec3& point) {
  const glm::dvec3 d = glm::dvec3(light) - light.w * point;
  Between found;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const glm::dvec3 a(corners[i]), e1 = glm::dvec3(corners[i + 1]) - a, e2 = glm::dvec3(corners[i + 2]) - a;
    const glm::dvec3 h = glm::cross(d, e2);
    const double det = glm::dot(e1, h);
    if (det == 0) continue;
    const glm::dvec3 s = point - a, q = glm::cross(s, e1);
    const double u = glm::dot(s, h) / det, v = glm::dot(d, q) / det, t = glm::dot(e2, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || t <= 0 || (light.w != 0 && t >= 1)) continue;
    ++found.all;
    found.facing += glm::dot(glm::cross(e1, e2), d) > 0;
  }
  return found;
}

void add(Corners& corners, const Corners& mesh, const glm::vec3& by) {
  for (const glm::vec3& p : mesh) corners.push_back(p + by);
}

/// A sphere of longitude and latitude, anticlockwise from outside.
Corners sphere(float radius, int rings) {
  const auto at = [&](int i, int j) {
    const double polar = M_PI * i / rings, around = M_PI * (j % (2 * rings)) / rings;
    return i == 0       ? glm::vec3(0, 0, radius)
           : i == rings ? glm::vec3(0, 0, -radius)
                        : radius * glm::vec3(std::sin(polar) * std::cos(around),
                                             std::sin(polar) * std::sin(around), std::cos(polar));
  };
  Corners corners;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0)
        for (const auto& p : {at(i, j), at(i + 1, j), at(i, j + 1)}) corners.push_back(p);
      if (i < rings - 1)
        for (const auto& p : {at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)}) corners.push_back(p);
    }
  return corners;
}

Corners soup(std::mt19937& random, int triangles) {
  std::uniform_real_distribution<float> at(-100, 100), by(-60, 60);
  Corners corners;
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 p(at(random), at(random), at(random));
    for (int k = 0; k < 3; ++k) corners.push_back(p + glm::vec3(by(random), by(random), by(random)));
  }
  return corners;
}

/// Triangles that share edges in threes and fours, in any sense.
Corners fans(std::mt19937& random) {
  std::uniform_real_distribution<float> at(-100, 100);
  const auto point = [&] { return glm::vec3(at(random), at(random), at(random)); };
  Corners corners;
  for (int fan = 0; fan < 5; ++fan) {
    glm::vec3 a = point(), b = point();
    for (int i = 0; i < 4; ++i) {
      for (const auto& p : {a, b, point()}) corners.push_back(p);
      if (random() % 2) std::swap(a, b);
    }
  }
  return corners;
}

std::vector<glm::dvec4> lights(std::mt19937& random) {
  std::uniform_real_distribution<double> at(-150, 150);
  std::vector<glm::dvec4> lights;
  for (int i = 0; i < 3; ++i) {
    lights.emplace_back(at(random), at(random), at(random), 1);
    lights.emplace_back(glm::normalize(glm::dvec3(at(random), at(random), at(random))), 0);
  }
  return lights;
}

template <typename Expected>
void expect_counts(const Corners& corners, std::mt19937& random, const Expected& expected) {
  const ShadowCasters casters = make_shadow_casters(corners);
  std::uniform_real_distribution<double> at(-200, 200);
  int shadowed = 0;
  for (const glm::dvec4& light : lights(random)) {
    const ShadowVolume volume = make_shadow_volume(casters, light);
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 point(at(random), at(random), at(random)), way(at(random), at(random), at(random));
      const Between found = between(corners, light, point);
      const int count = count_in_volume(casters, volume, light, point, way);
      ASSERT_EQ(count, expected(found))
          << "light " << light.x << ' ' << light.y << ' ' << light.z << ' ' << light.w;
      ASSERT_EQ(count != 0, found.all != 0);
      shadowed += count != 0;
    }
  }
  EXPECT_GT(shadowed, 50) << "the test has to see shadows";
}

TEST(ShadowVolume, CountsTheTrianglesBeforeTheLightOfOpenAndNonManifoldMeshes) {
  std::mt19937 random(7);
  const auto all = [](const Between& found) { return found.all; };
  expect_counts(soup(random, 40), random, all);
  expect_counts(fans(random), random, all);
  Corners open = sphere(90, 8);
  open.resize(open.size() - 30);
  expect_counts(open, random, all);
}

TEST(ShadowVolume, ClosedBodiesCountWhatFacesTheLight) {
  std::mt19937 random(11);
  Corners spheres;
  add(spheres, sphere(40, 7), {80, 0, 0});
  add(spheres, sphere(50, 9), {-80, 20, 10});
  const ShadowCasters casters = make_shadow_casters(spheres);
  ASSERT_EQ(casters.bodies.size(), 2u);
  EXPECT_EQ(casters.bodies[0].outside, 1);
  // Far from the lights, so that none is in a box.
  const auto facing = [](const Between& found) { return found.facing; };
  std::uniform_real_distribution<double> at(-150, 150);
  for (const glm::dvec4& light : {glm::dvec4(300, 10, 40, 1), glm::dvec4(0.6, 0, 0.8, 0)}) {
    const ShadowVolume volume = make_shadow_volume(casters, light);
    for (int i = 0; i < 500; ++i) {
      const glm::dvec3 point(at(random), at(random), at(random)), way(at(random), at(random), at(random));
      const Between found = between(spheres, light, point);
      const int count = count_in_volume(casters, volume, light, point, way);
      ASSERT_EQ(count, facing(found));
      ASSERT_EQ(count != 0, found.all != 0);
    }
  }
}

TEST(ShadowVolume, InsideOutBodiesAndLightsWithinAreRight) {
  std::mt19937 random(13);
  Corners inside_out = sphere(100, 8);
  for (std::size_t i = 0; i < inside_out.size(); i += 3) std::swap(inside_out[i], inside_out[i + 1]);
  const ShadowCasters casters = make_shadow_casters(inside_out);
  EXPECT_EQ(casters.bodies.at(0).outside, -1);
  std::uniform_real_distribution<double> at(-200, 200);
  for (const glm::dvec4& light :
       {glm::dvec4(10, 10, 40, 1), glm::dvec4(300, 10, 40, 1), glm::dvec4(0, 0, 1, 0)}) {
    const ShadowVolume volume = make_shadow_volume(casters, light);
    for (int i = 0; i < 500; ++i) {
      const glm::dvec3 point(at(random), at(random), at(random)), way(at(random), at(random), at(random));
      ASSERT_EQ(count_in_volume(casters, volume, light, point, way) != 0,
                between(inside_out, light, point).all != 0);
    }
  }
}

/// Edges of the mesh between a triangle that faces the light and one that does not, found without the volume.
std::size_t silhouette_of(const Corners& corners, const glm::dvec4& light) {
  std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> facing;
  const auto key = [](const glm::vec3& p) { return std::array{p.x, p.y, p.z}; };
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const glm::dvec3 a(corners[i]), b(corners[i + 1]), c(corners[i + 2]);
    const int faces = glm::dot(glm::cross(b - a, c - a), glm::dvec3(light) - light.w * a) > 0 ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto u = key(corners[i + k]), v = key(corners[i + (k + 1) % 3]);
      facing[std::minmax(u, v)] += faces;
    }
  }
  return std::size_t(
      std::count_if(facing.begin(), facing.end(), [](const auto& edge) { return edge.second == 1; }));
}

TEST(ShadowVolume, OfClosedMeshesOnlyTheSilhouetteIsLeft) {
  const Corners corners = sphere(50, 20);
  const ShadowCasters casters = make_shadow_casters(corners);
  EXPECT_EQ(casters.edges.size(), casters.triangles.size() * 3 / 2);
  for (const glm::dvec4& light : {glm::dvec4(130, 40, 200, 1), glm::dvec4(0.36, 0.48, 0.8, 0)}) {
    const ShadowVolume volume = make_shadow_volume(casters, light);
    EXPECT_EQ(volume.silhouette_edges, silhouette_of(corners, light));
    EXPECT_LT(volume.silhouette_edges, casters.edges.size() / 10);
  }
}

TEST(ShadowVolume, ManyOverlapsAreCutIntoBatchesOfWhatEightBitsHold) {
  Corners sheets;
  for (int i = 0; i < 600; ++i)
    for (const glm::vec3& p : {glm::vec3(-10, -10, i), glm::vec3(10, -10, i), glm::vec3(0, 10, i)})
      sheets.push_back(p);
  const ShadowCasters casters = make_shadow_casters(sheets);
  const ShadowVolume volume = make_shadow_volume(casters, {0, 0, 1, 0});
  EXPECT_EQ(volume.parts.size(), 600u);
  EXPECT_GE(volume.batches.size(), 3u);
  std::size_t parts = 0;
  for (const auto& batch : volume.batches) {
    EXPECT_LE(batch.most, kMostOverlaps);
    EXPECT_LE(batch.count, kMostOverlaps);
    parts += batch.count;
  }
  EXPECT_EQ(parts, 600u);
}

TEST(ShadowVolume, OverlapsAreNeverUnderestimated) {
  std::mt19937 random(17);
  const Corners corners = soup(random, 900);
  const ShadowCasters casters = make_shadow_casters(corners);
  std::vector<std::uint32_t> list(casters.triangles.size());
  for (std::size_t i = 0; i < list.size(); ++i) list[i] = std::uint32_t(i);
  std::uniform_real_distribution<double> at(-150, 150);
  for (const glm::dvec4& light : lights(random)) {
    const std::size_t bound = most_overlaps(casters, list, light);
    EXPECT_LT(bound, list.size());
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 target(at(random), at(random), at(random));
      const glm::dvec3 far = target - 1000.0 * (glm::dvec3(light) - light.w * target);
      ASSERT_LE(std::size_t(between(corners, light, far).all), bound);
    }
  }
}

}  // namespace
}  // namespace catoptra::render

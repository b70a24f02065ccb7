// Random outlines with holes on random conics, and random constrained triangulations.
#include <gtest/gtest.h>

#include <random>

#include "tessellate/optic_mesh.h"
#include "tessellate/src/delaunay.h"
#include "tests/tessellate/mesh_checks.h"
#include "tests/tessellate/test_faces.h"

namespace catoptra::test {
namespace {

constexpr double kTau = 2 * std::numbers::pi;

struct Random {
  std::mt19937 engine;
  explicit Random(unsigned seed) : engine(seed) { std::printf("seed %u\n", seed); }
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); }
};

/// A smooth star around the origin: r(a) between 0.6 and 1.4 of `radius`, in `parts` edges.
cad_import::TrimLoop star(Random& random, const SurfacePtr& surface, double radius, int first_number) {
  const double depth = random(0.05, 0.4), phase = random(0, kTau);
  const int lobes = random.whole(2, 6), parts = random.whole(2, 5);
  cad_import::TrimLoop loop;
  for (int k = 0; k < parts; ++k)
    loop.edges.push_back(
        edge(surface, first_number + k, first_number + k, first_number + (k + 1) % parts, [=](double t) {
          const double a = kTau * (k + t) / parts, r = radius * (1 + depth * std::sin(lobes * a + phase));
          return r * glm::dvec2(std::cos(a), std::sin(a));
        }));
  return loop;
}

TEST(RandomFaces, KeepEveryPromise) {
  Random random(20240517);
  for (int round = 0; round < 60; ++round) {
    const double radius = (random(0, 1) < 0.5 ? -1 : 1) * random(120, 2000);
    const double chord = std::pow(10, random(-3, -0.5)), outline = random(20, 60);
    const auto surface = std::make_shared<ConicSurface>(1 / radius, random(-1.5, 0.5), 90, 90);
    std::vector loops{star(random, surface, outline, 0)};
    const int holes = random.whole(0, 4);
    for (int h = 0; h < holes; ++h) {
      const double a = kTau * h / holes;
      loops.push_back(circle_loop(surface, 0.35 * outline * glm::dvec2(std::cos(a), std::sin(a)),
                                  random(0.01, 0.2) * outline, 100 + h, true));
    }
    tessellate::TessellationOptions options;
    options.chord_mm = chord;
    const auto result = tessellate::tessellate_optic(std::vector{make_face(surface, loops)}, options);
    const auto& mesh = result.mesh;
    SCOPED_TRACE("round " + std::to_string(round));
    EXPECT_TRUE(result.unmeshed.empty());
    EXPECT_LE(vertex_error_mm(mesh), 1e-9);
    EXPECT_LE(chord_error_mm(mesh), chord * 1.001);
    EXPECT_GT(least_normal_agreement(mesh), 0.9);
    EXPECT_EQ(coincident_vertices(mesh, 1e-7), 0);
    EXPECT_EQ(euler_characteristic(mesh), 1 - holes);
    EXPECT_EQ(boundary_loops(mesh), 1 + holes);
  }
}

TEST(RandomFaces, TriangulationIsDelaunayAndCoversItsPolygon) {
  Random random(7);
  for (int round = 0; round < 200; ++round) {
    // A star polygon with integer-like corners, so that many points are collinear or on one circle.
    const int corners = random.whole(3, 40);
    std::vector<glm::dvec2> points;
    for (int k = 0; k < corners; ++k) {
      const double r = random.whole(4, 10), a = kTau * k / corners;
      points.push_back(r * glm::dvec2(std::cos(a), std::sin(a)));
    }
    tessellate::Delaunay plane({-10, -10}, {10, 10});
    double area = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      ASSERT_EQ(plane.insert(points[k]), static_cast<int>(k));
      const auto &a = points[k], &b = points[(k + 1) % points.size()];
      area += 0.5 * (a.x * b.y - a.y * b.x);
    }
    for (int k = 0; k < corners; ++k) ASSERT_TRUE(plane.add_border(k, (k + 1) % corners));
    ASSERT_TRUE(plane.mark_inside());
    for (int x = -9; x <= 9; ++x)
      for (int y = -9; y <= 9; ++y) {
        const auto number = plane.insert_inside({x, y});
        if (number && *number == static_cast<int>(points.size())) points.emplace_back(x, y);
      }
    double covered = 0;
    for (std::size_t t = 0; t < plane.triangle_count(); ++t) {
      if (!plane.triangle(t).inside) continue;
      const auto v = plane.corners(t);
      const auto at = [&](std::size_t k) { return points[static_cast<std::size_t>(v[k])]; };
      const glm::dvec2 a = at(0), b = at(1), c = at(2);
      const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      EXPECT_GT(twice, -1e-6);
      covered += 0.5 * twice;
      for (std::size_t k = 0; k < 3; ++k) {
        if (plane.triangle(t).border[k]) continue;
        const auto neighbour = static_cast<std::size_t>(plane.triangle(t).neighbour[k]);
        for (const int w : plane.corners(neighbour)) {
          // The power of the neighbour's corner with respect to this triangle's circle.
          const glm::dvec2 d = points[static_cast<std::size_t>(w)];
          const glm::dvec2 pa = a - d, pb = b - d, pc = c - d;
          const double det = glm::dot(pa, pa) * (pb.x * pc.y - pb.y * pc.x) +
                             glm::dot(pb, pb) * (pc.x * pa.y - pc.y * pa.x) +
                             glm::dot(pc, pc) * (pa.x * pb.y - pa.y * pb.x);
          EXPECT_LT(det, 1e-2);  // of 1e4 and more: what snapping to 3e-7 may shift
        }
      }
    }
    EXPECT_NEAR(covered, area, 1e-4);
  }
}

}  // namespace
}  // namespace catoptra::test

// Ratios of the ray scene, all from one run: moving an optic against building everything, packets against
// single rays, and what the steps before drawing cost.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "optics/map_coordinates.h"
#include "optics/ray_scene.h"
#include "tests/support/analytic_optic.h"

using namespace catoptra;

namespace {

double best_ms(int repeats, const std::function<void()>& work) {
  double best = 1e300;
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    best = std::min(best, taken.count());
  }
  return best;
}

// Hills before the mirror, side x side x 2 triangles over 20 m x 20 m.
cad_import::TriangleMesh hills(int side) {
  cad_import::TriangleMesh mesh;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i) {
      const double x = 20000.0 * i / side - 10000, y = 20000.0 * j / side - 10000;
      mesh.positions.emplace_back(x, y, 5000 + 700 * std::sin(x / 900) * std::cos(y / 700));
    }
  for (unsigned j = 0; j < unsigned(side); ++j)
    for (unsigned i = 0; i < unsigned(side); ++i) {
      const unsigned a = j * (unsigned(side) + 1) + i, b = a + unsigned(side) + 1;
      mesh.triangles.emplace_back(a, a + 1, b);
      mesh.triangles.emplace_back(a + 1, b + 1, b);
    }
  return mesh;
}

std::vector<optics::Ray> primary_rays(int width, int height) {
  std::vector<optics::Ray> rays;
  for (int y = 0; y < height; y += 4)
    for (int x = 0; x < width; x += 4)
      for (int k = 0; k < 16; ++k) {  // tiles of 4 x 4, one packet each
        const double px = x + k % 4, py = y + k / 4;
        const glm::dvec3 d{(px - width / 2.0) / height, (py - height / 2.0) / height, 1};
        rays.push_back({{0, 0, -3000}, glm::normalize(d), 0, optics::kInfinity});
      }
  return rays;
}

void compare_packets(const optics::RayScene& scene) {
  const auto rays = primary_rays(1280, 720);
  double sum = 0;
  const double single = best_ms(3, [&] {
    for (const auto& ray : rays) sum += scene.intersect(ray).t_mm;
  });
  const double packets = best_ms(3, [&] {
    for (std::size_t first = 0; first < rays.size(); first += 16) {
      optics::RayPacket16 packet;
      for (std::size_t i = 0; i < 16; ++i) {
        const optics::Ray& ray = rays[first + i];
        packet.origin_x[i] = float(ray.origin_mm.x);
        packet.origin_y[i] = float(ray.origin_mm.y);
        packet.origin_z[i] = float(ray.origin_mm.z);
        packet.direction_x[i] = float(ray.direction.x);
        packet.direction_y[i] = float(ray.direction.y);
        packet.direction_z[i] = float(ray.direction.z);
        packet.t_min[i] = 0;
        packet.t_max[i] = std::numeric_limits<float>::infinity();
      }
      scene.intersect16(packet, optics::kEverything, true);
      sum += double(packet.t_max[0]);
    }
  });
  const double batch = best_ms(3, [&] { sum += scene.intersect(rays).back().t_mm; });
  const double millions = static_cast<double>(rays.size()) / 1e6;
  std::printf(
      "%.2f M coherent rays, Mrays/s: single %.1f, packets of 16 %.1f, batch on all threads %.1f (sum %g)\n",
      millions, 1e3 * millions / single, 1e3 * millions / packets, 1e3 * millions / batch, sum);
  std::printf("ratio packets / single (1 thread)      %8.2f\n", single / packets);
  std::printf("ratio batch / single                   %8.2f\n", single / batch);
}

}  // namespace

int main() {
  const auto mesh = hills(708);  // 1,002,528 triangles
  optics::Optic mirror = test::conic_mirror(1200, 0, 170, 110, 33, 32);

  const double build = best_ms(3, [&] {
    optics::RayScene scene;
    scene.add_surroundings(mesh);
    scene.add_optic(mirror.mesh);
    scene.commit();
  });
  optics::RayScene scene;
  scene.add_surroundings(mesh);
  const auto object = scene.add_optic(mirror.mesh);
  scene.commit();
  const double move = best_ms(50, [&] {
    for (auto& vertex : mirror.mesh.vertices) vertex.position_mm.x += 0.5;
    scene.update_optic(object, mirror.mesh);
    scene.commit();
  });
  std::printf("%zu triangles of surroundings, optic of %zu triangles\n", mesh.triangles.size(),
              mirror.mesh.triangles.size());
  std::printf("full build %.1f ms, move and commit %.3f ms\n", build, move);
  std::printf("ratio move / build                     %8.5f  (must be below 0.01)\n", move / build);

  compare_packets(scene);

  const optics::Optic glass = test::conic_mirror(1200, 0, 170, 110, 17, 17);
  const glm::dvec3 eye(350, 140, 700);
  std::vector<optics::VertexHit> hits;
  const double trace = best_ms(20, [&] { hits = optics::trace_vertices(glass, eye, scene); });
  optics::VirtualView view;
  const double fit = best_ms(20, [&] {
    view = optics::make_virtual_view(glass, hits, {{-1e4, -1e4, 0}, {1e4, 1e4, 6e3}});
  });
  std::size_t count = 0;
  const double affine = best_ms(20, [&] {
    count += optics::map_coordinates(glass, hits, view, optics::MapInterpolation::affine).size();
  });
  const double fitted = best_ms(20, [&] { count += optics::map_coordinates(glass, hits, view).size(); });
  std::printf(
      "%zu vertices (checked %zu): rays %.3f ms, view %.3f ms, map coordinates affine %.3f, fitted %.3f ms\n",
      hits.size(), count, trace, fit, affine, fitted);
  return 0;
}

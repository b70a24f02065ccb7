// Speed of the ray tracer: a whole frame against nothing but its packet queries, in one run.
// Usage: bench_ray_tracer [picture.png]
#include <algorithm>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "tests/render/ray_scenes.h"

namespace {

using namespace catoptra;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// A convex mirror (R 1200) over about half of the picture, turned to the street behind the eye.
optics::Optic half_picture_mirror() {
  optics::Optic mirror = test::conic_mirror(1200, 0, 340, 340, 17, 17);
  mirror.name = "half";
  return mirror;
}

}  // namespace

int main(int argc, char** argv) {
  const test::TemporaryImage image("bench.png", test::checker(512, 64));
  render::Scene scene;
  scene.surroundings.push_back(test::street(29, image.path()));
  scene.lights.push_back({});
  scene.lights[0].direction = glm::normalize(glm::dvec3(-0.3, 0.5, -0.8));
  scene.optics.push_back(half_picture_mirror());
  // The mirror faces +z at the origin: the street is turned to it, behind the eye.
  for (auto& p : scene.surroundings[0].positions) p = {p.x, p.z, -p.y};
  for (auto& n : scene.surroundings[0].normals) n = {n.x, n.z, -n.y};
  scene.camera.eye_mm = {30, 40, 700};
  scene.camera.target_mm = {0, 0, 0};
  scene.camera.up = {0, 1, 0};
  scene.camera.fov_rad = 0.42;
  const test::TracedScene traced(std::move(scene));

  render::FrameOptions options;
  std::vector<double> frame_ms, bare_ms;
  render::RenderResult result;
  for (int i = 0; i < 15; ++i) {
    result = traced.tracer->render(traced.scene.camera, options);
    frame_ms.push_back(result.stats.time_ms.at("total"));
    bare_ms.push_back(traced.tracer->bare_packet_ms(traced.scene.camera, options));
  }
  const double pixels = double(options.width) * options.height;
  std::printf("triangles              %zu\n", traced.scene.surroundings[0].triangles.size());
  std::printf("rays a frame           %zu (%.0f %% of the pixels show the mirror)\n", result.stats.rays,
              100 * (double(result.stats.rays) / pixels - 1));
  std::printf("frame                  %.2f ms\n", median(frame_ms));
  std::printf("bare packet queries    %.2f ms\n", median(bare_ms));
  std::printf("frame / bare queries   %.2f (fastest of each: %.2f)\n", median(frame_ms) / median(bare_ms),
              *std::min_element(frame_ms.begin(), frame_ms.end()) /
                  *std::min_element(bare_ms.begin(), bare_ms.end()));
  if (argc > 1) render::write_image(result.frame, argv[1]);
  return 0;
}

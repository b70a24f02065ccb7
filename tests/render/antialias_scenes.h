// Scenes and measures that the tests of antialiasing share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include "render/comparison.h"
#include "render/renderer.h"
#include "tests/render/lens_pvrr_scene.h"

namespace catoptra::render {

inline void PrintTo(Mode mode, std::ostream* stream) {
  *stream << mode_name(mode);
}

}  // namespace catoptra::render

namespace catoptra::test {

inline const auto kAllModes = ::testing::Values(render::Mode::pvrr, render::Mode::hybrid, render::Mode::exact,
                                                render::Mode::raytrace, render::Mode::cubemap);

inline std::string name_of(const ::testing::TestParamInfo<render::Mode>& info) {
  return std::string(render::mode_name(info.param));
}

/// A convex mirror in the room, seen from aside, with a bar before it; 80 x 60 pixels.
inline render::Scene small_mirror_scene(double radius_mm = 600) {
  render::Scene scene = room();
  scene.camera.eye_mm = {260, 160, 660};
  scene.camera.up = {0.1, 1, 0};  // so that few edges run along the pixels
  scene.camera.resolution = {80, 60};
  add_box(scene.surroundings[0], {-60, -500, 180}, {-45, 500, 190}, kYellow);
  scene.optics.push_back(conic_mirror(radius_mm, 0, 170, 110, 33, 25));
  return scene;
}

/// The same room through a lens of about -4 D that does not fill the picture.
inline render::Scene small_lens_scene() {
  render::Scene scene = room_behind_lens(160, 0.5);
  scene.camera.eye_mm = {12, 7, -160};
  scene.camera.up = {0.1, 1, 0};
  scene.camera.resolution = {80, 60};
  scene.optics.push_back(lens_of(400, 95.2, 2, 50, 25, 3, optics::abbe_medium(1.586, 30)));
  return scene;
}

/// Root of the mean square difference of linear colours, clipped at 1 as a screen does, over the pixels for
/// which `counts` holds.
template <typename Counts>
double rms(const render::Frame& a, const render::Frame& b, const Counts& counts) {
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.color.size(); ++i) {
    if (!counts(i)) continue;
    const glm::vec3 d = glm::min(glm::vec3(a.color[i]), 1.0f) - glm::min(glm::vec3(b.color[i]), 1.0f);
    sum += glm::dot(d, d) / 3;
    ++n;
  }
  return n ? std::sqrt(sum / double(n)) : 0;
}

inline double rms(const render::Frame& a, const render::Frame& b) {
  return rms(a, b, [](std::size_t) { return true; });
}

}  // namespace catoptra::test

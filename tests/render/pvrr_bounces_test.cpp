// Mirrors in mirrors in mode pvrr, against the closed form.
#include <gtest/gtest.h>

#include "render/image_io.h"
#include "tests/render/bounce_scene.h"

namespace catoptra::render {
namespace {

using namespace catoptra::test;

std::vector<PlacedMirror> kaleidoscope(double radius_mm = 0) {
  return {PlacedMirror::facing({0, 0, 0}, {0.2, 0, 1}, 420, 320),
          PlacedMirror::facing({260, 40, 420}, {-0.55, -0.1, -1}, 420, 320, radius_mm)};
}

Camera kaleidoscope_camera() {
  return {{-330, 90, 760}, {20, 0, 60}, {0, 1, 0}, 0.6, {320, 240}};
}

void save(const char* name, const Frame& f) {
  if (const char* dir = std::getenv("DUMP")) write_image(f, std::string(dir) + "/" + name + ".png");
}

TEST(PvrrBounces, TwoPlanesShowWhatUnfoldedPathsShow) {
  const auto mirrors = kaleidoscope();
  for (int depth = getenv("DBG")?3:1; depth <= (getenv("DBG")?3:5); ++depth) {
    Scene scene = scene_of(mirrors, 3, depth);
    scene.camera = kaleidoscope_camera();
    const auto result = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene));
    save(("kal" + std::to_string(depth)).c_str(), result.frame);
    if (getenv("DUMP")) save(("ray" + std::to_string(depth)).c_str(), Renderer(scene).render(Mode::raytrace, scene.camera, picture_of(scene)).frame);
    const BounceErrors errors = bounce_errors(scene, mirrors, result.frame);
    for (std::size_t k = 1; k < errors.arcmin.size(); ++k)
      std::printf("depth %d bounces %zu: %zu px, elsewhere %zu, median %.4f p99 %.3f max %.3f\n", depth, k,
                  errors.arcmin[k].size(), errors.elsewhere[k], quantile(errors.arcmin[k], 0.5),
                  quantile(errors.arcmin[k], 0.99), quantile(errors.arcmin[k], 1));
    for (const auto& m : result.stats.maps) std::printf("  %s: %zu texels %zu rays\n", m.way.c_str(), m.texels, m.rays);
    for (const auto& w : result.warnings) std::printf("  %s\n", w.c_str());
  }
}

TEST(PvrrBounces, PlaneAndSphere) {
  for (double radius : {1200.0, 400.0}) {
  const auto mirrors = kaleidoscope(radius);
  for (int vertices : {9, 17, 33}) {
    Scene scene = scene_of(mirrors, vertices, 3);
    scene.camera = kaleidoscope_camera();
    const auto result = Renderer(scene).render(Mode::pvrr, scene.camera, picture_of(scene));
    save("sphere", result.frame);
    const BounceErrors errors = bounce_errors(scene, mirrors, result.frame);
    for (std::size_t k = 1; k < errors.arcmin.size(); ++k)
      std::printf("R %g n %d bounces %zu: %zu px, elsewhere %zu, median %.4f p99 %.3f max %.3f\n", radius, vertices, k,
                  errors.arcmin[k].size(), errors.elsewhere[k], quantile(errors.arcmin[k], 0.5),
                  quantile(errors.arcmin[k], 0.99), quantile(errors.arcmin[k], 1));
    for (const auto& m : result.stats.maps) std::printf("  %s: %zu texels %zu rays\n", m.way.c_str(), m.texels, m.rays);
  }
  }
}

}  // namespace
}  // namespace catoptra::render

// How many of an optic's pixels a picture of mode exact shows wrong, against mode raytrace: by the geometry
// that both show, and by colour, which asks nothing of what a mode says of itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "render/src/pixel_error.h"

namespace catoptra::test {

struct ExactJudgement {
  std::size_t pixels = 0;      ///< of the optic, in either picture
  std::size_t retraced = 0;    ///< as the mode counts them
  std::size_t other = 0;       ///< one picture shows the optic and the other does not
  std::size_t turned = 0;      ///< off by more than 1 arcmin and more than half a pixel
  std::size_t elsewhere = 0;   ///< another thing along the ray than is met in the pixel or beside it
  std::size_t discolored = 0;  ///< a colour that is not between those of the pixel and the ones beside it

  [[nodiscard]] double share(std::size_t count) const { return pixels ? double(count) / double(pixels) : 0; }
  /// What the promise of the mode is about.
  [[nodiscard]] double wrong() const { return share(other + turned + elsewhere); }
  [[nodiscard]] double retraced_share() const { return share(retraced); }
};

/// Beside the rounding of coordinates, a surface that the ray meets at a grazing angle is another mm farther
/// on.
inline constexpr double kJudgedDepth = 0.01;
/// What mips, made along other derivatives in map and ray tracer, may change beyond the range of nine pixels.
inline constexpr float kJudgedColor = 0.03f;

namespace judgement {

/// Calls `visit` (pixel) for those of the 3 x 3 around `i` that are in the picture.
template <typename Visit>
void for_neighbours(const render::Frame& frame, std::size_t i, const Visit& visit) {
  const int x = int(i % std::size_t(frame.width)), y = int(i / std::size_t(frame.width));
  for (int row = std::max(0, y - 1); row <= std::min(frame.height - 1, y + 1); ++row)
    for (int column = std::max(0, x - 1); column <= std::min(frame.width - 1, x + 1); ++column)
      visit(std::size_t(row) * std::size_t(frame.width) + std::size_t(column));
}

inline bool turned(const render::Frame& reference, const render::Frame& frame, std::size_t i) {
  if (render::both_touch(reference, frame, i)) return false;
  const auto direction = render::shown_direction(reference, frame, i);
  if (!direction) return true;
  constexpr double kRounding = 1.001;
  const double arcmin = render::kArcminPerRad * render::angle(*direction, glm::dvec3(reference.direction[i]));
  if (arcmin <= kRounding * render::kExactTolerance_arcmin) return false;
  const auto px = render::screen_error(reference, frame, i, *direction);
  return !px || *px > kRounding * render::kExactTolerance_px;
}

/// 1 / distance from the last surface point; 0: the sky.
inline double nearness(const render::Frame& frame, std::size_t i) {
  if (frame.position[i].w == 0) return 0;
  return 1 / std::max(1e-3, double(glm::distance(glm::vec3(frame.position[i]), frame.surface[i])));
}

inline bool elsewhere(const render::Frame& reference, const render::Frame& frame, std::size_t i) {
  const double seen = nearness(frame, i);
  double least = nearness(reference, i), most = least;
  for_neighbours(reference, i, [&](std::size_t k) {
    if (reference.optic_id[k] != reference.optic_id[i]) return;
    least = std::min(least, nearness(reference, k));
    most = std::max(most, nearness(reference, k));
  });
  return seen < least * (1 - kJudgedDepth) || seen > most * (1 + kJudgedDepth);
}

/// Of what is displayed: brighter than white is white.
inline bool discolored(const render::Frame& reference, const render::Frame& frame, std::size_t i) {
  const auto shown = [](const glm::vec4& c) { return glm::min(glm::vec3(c), glm::vec3(1)); };
  glm::vec3 least = shown(reference.color[i]), most = least;
  for_neighbours(reference, i, [&](std::size_t k) {
    least = glm::min(least, shown(reference.color[k]));
    most = glm::max(most, shown(reference.color[k]));
  });
  const glm::vec3 c = shown(frame.color[i]);
  return glm::any(glm::lessThan(c, least - kJudgedColor)) ||
         glm::any(glm::greaterThan(c, most + kJudgedColor));
}

}  // namespace judgement

/// One entry per optic. Both frames with geometry; `exact` of mode exact.
inline std::vector<ExactJudgement> judge_exact(const render::Frame& reference, const render::Frame& exact,
                                               std::size_t optics) {
  std::vector<ExactJudgement> judged(optics);
  for (std::size_t i = 0; i < reference.color.size(); ++i) {
    const std::int32_t id = std::max(reference.optic_id[i], exact.optic_id[i]);
    if (id < 0) continue;
    ExactJudgement& j = judged[std::size_t(id)];
    ++j.pixels;
    j.retraced += exact.retraced[i];
    if (judgement::discolored(reference, exact, i)) ++j.discolored;
    if (reference.optic_id[i] != exact.optic_id[i])
      ++j.other;
    else if (judgement::turned(reference, exact, i))
      ++j.turned;
    else if (judgement::elsewhere(reference, exact, i))
      ++j.elsewhere;
  }
  return judged;
}

/// Renders `scene` in both modes at `width` x `height` and judges.
inline std::vector<ExactJudgement> judge_exact(const render::Scene& scene, int width, int height) {
  render::FrameOptions options;
  options.width = width;
  options.height = height;
  options.geometry = true;
  render::Renderer renderer(scene);
  const render::Frame reference = renderer.render(render::Mode::raytrace, scene.camera, options).frame;
  const render::Frame exact = renderer.render(render::Mode::exact, scene.camera, options).frame;
  return judge_exact(reference, exact, scene.optics.size());
}

/// A line of docs/exact-mode.md's table.
inline std::string table_row(const std::string& scene, const std::string& optic, const ExactJudgement& j) {
  char line[256];
  std::snprintf(line, sizeof line, "| `%s` | %s | %zu | %.2f | %.3f | %.3f |", scene.c_str(), optic.c_str(),
                j.pixels, 100 * j.retraced_share(), 100 * j.wrong(), 100 * j.share(j.discolored));
  return line;
}

}  // namespace catoptra::test

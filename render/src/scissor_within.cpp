#include "render/src/scissor_within.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

namespace catoptra::render {
namespace {

constexpr double kRoom_px = 2;
// Points are cut at that share of the greatest w, so that what is left can be projected.
constexpr double kLeastW = 1e-9;

}  // namespace

glm::ivec4 pixels_of_beam(const RasterView& view, std::span<const glm::vec3> corners,
                          const glm::dvec4& light) {
  const glm::ivec4 all(view.corner, view.size);
  if (view.projection[2][3] == 0 || view.depth_of_near < view.depth_of_far || view.bottom_row_first)
    return all;
  const glm::dmat4 clip = view.clip_from_relative();
  std::vector<glm::dvec4> points;
  for (const glm::vec3& corner : corners) {
    const glm::dvec3 p(corner);
    points.push_back(clip * glm::dvec4(p - view.origin_mm, 1));
    points.push_back(clip * glm::dvec4(light.w * p - glm::dvec3(light), 0));
  }
  double greatest = 0;
  for (const glm::dvec4& p : points) greatest = std::max(greatest, std::abs(p.w));
  const double least = kLeastW * greatest;
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
  const auto add = [&](const glm::dvec4& p) {
    const glm::dvec2 at = glm::dvec2(p) / p.w;
    low = glm::min(low, at);
    high = glm::max(high, at);
  };
  // The hull of all points is convex, and so is its part before the eye: the ends of that are the points
  // there, and where lines between points cross the cut.
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].w >= least) add(points[i]);
    for (std::size_t k = i + 1; k < points.size(); ++k)
      if ((points[i].w >= least) != (points[k].w >= least)) {
        const double t = (least - points[i].w) / (points[k].w - points[i].w);
        glm::dvec4 cut = points[i] + t * (points[k] - points[i]);
        cut.w = least;
        add(cut);
      }
  }
  if (!(low.x <= high.x)) return {view.corner, 0, 0};
  const glm::dvec2 size(view.size);
  const glm::dvec2 begin = 0.5 * glm::dvec2(1 + low.x, 1 - high.y) * size - kRoom_px,
                   end = 0.5 * glm::dvec2(1 + high.x, 1 - low.y) * size + kRoom_px;
  const glm::ivec2 first(glm::floor(glm::clamp(begin, glm::dvec2(0), size))),
      beyond(glm::ceil(glm::clamp(end, glm::dvec2(0), size)));
  return {view.corner + first, beyond - first};
}

ScissorWithin::ScissorWithin(const RasterView& view, std::span<const glm::vec3> corners,
                             const glm::dvec4& light)
    : was_on_(glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE) {
  glGetIntegerv(GL_SCISSOR_BOX, before_.data());
  const glm::ivec4 pixels = pixels_of_beam(view, corners, light);
  glm::ivec2 begin(pixels.x, pixels.y), end = begin + glm::ivec2(pixels.z, pixels.w);
  if (was_on_) {
    begin = glm::max(begin, glm::ivec2(before_[0], before_[1]));
    end = glm::min(end, glm::ivec2(before_[0] + before_[2], before_[1] + before_[3]));
  }
  const glm::ivec2 size = glm::max(end - begin, glm::ivec2(0));
  empty_ = size.x == 0 || size.y == 0;
  glEnable(GL_SCISSOR_TEST);
  glScissor(begin.x, begin.y, size.x, size.y);
}

ScissorWithin::~ScissorWithin() {
  glScissor(before_[0], before_[1], before_[2], before_[3]);
  if (!was_on_) glDisable(GL_SCISSOR_TEST);
}

}  // namespace catoptra::render

#include "app/src/error_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string_view>

#include "render/image_io.h"

namespace catoptra::app {
namespace {

/// Letters of the legend, 3 x 5: one row per entry, the leftmost pixel is the highest of 3 bits.
struct Glyph {
  char letter;
  std::array<unsigned char, 5> rows;
};
constexpr Glyph kGlyphs[] = {
    {'0', {7, 5, 5, 5, 7}}, {'1', {2, 6, 2, 2, 7}}, {'.', {0, 0, 0, 0, 2}},
    {'a', {0, 3, 5, 5, 3}}, {'r', {0, 5, 6, 4, 4}}, {'c', {0, 3, 4, 4, 3}},
    {'m', {0, 7, 7, 5, 5}}, {'i', {2, 0, 2, 2, 2}}, {'n', {0, 6, 5, 5, 5}},
};
constexpr int kAdvance = 4;  ///< letter width and gap

void fill(render::Frame& frame, int x0, int y0, int width, int height, glm::vec3 color) {
  for (int y = std::max(0, y0); y < std::min(frame.height, y0 + height); ++y)
    for (int x = std::max(0, x0); x < std::min(frame.width, x0 + width); ++x)
      frame.color[std::size_t(y) * std::size_t(frame.width) + std::size_t(x)] = glm::vec4(color, 1);
}

/// Writes `text` with its top centre at (x, y), each letter pixel `size` pixels wide.
void write(render::Frame& frame, std::string_view text, int x, int y, int size) {
  x -= static_cast<int>(text.size()) * kAdvance * size / 2;
  for (const char letter : text) {
    const auto* glyph = std::find_if(std::begin(kGlyphs), std::end(kGlyphs),
                                     [&](const Glyph& g) { return g.letter == letter; });
    for (int row = 0; glyph != std::end(kGlyphs) && row < 5; ++row)
      for (int column = 0; column < 3; ++column)
        if (glyph->rows[std::size_t(row)] >> (2 - column) & 1)
          fill(frame, x + column * size, y + row * size, size, size, glm::vec3(1));
    x += kAdvance * size;
  }
}

/// A bar over the four decades of the scale with a label at each end of a decade.
void draw_legend(render::Frame& frame) {
  const int size = frame.height >= 480 ? 2 : 1;
  const int decade = 36 * size, bar_width = 4 * decade, margin = 12 * size;
  const int box_width = bar_width + 2 * margin, box_height = 30 * size;
  if (frame.width < box_width || frame.height < 2 * box_height) return;
  const int left = margin, top = frame.height - box_height;
  fill(frame, 0, top, box_width, box_height, glm::vec3(0));
  for (int x = 0; x < bar_width; ++x) {
    const double exponent = std::log10(kErrorScaleMin_arcmin) + 4.0 * (x + 0.5) / bar_width;
    fill(frame, left + x, top + 4 * size, 1, 8 * size, error_color(std::pow(10, exponent)));
  }
  constexpr std::string_view kLabels[] = {"0.01", "0.1", "1", "10", "100"};
  for (int i = 0; i < 5; ++i) write(frame, kLabels[i], left + i * decade, top + 14 * size, size);
  write(frame, "arcmin", left + bar_width / 2, top + 22 * size, size);
}

float luminance(const glm::vec4& color) {
  return std::clamp(0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b, 0.0f, 1.0f);  // Rec. 709
}

}  // namespace

glm::vec3 error_color(double arcmin) {
  const double decades = std::log10(kErrorScaleMax_arcmin / kErrorScaleMin_arcmin);
  const double t =
      std::clamp(std::log10(std::max(arcmin, 1e-12) / kErrorScaleMin_arcmin) / decades, 0.0, 1.0);
  // Polynomial fit of the turbo colour map, sRGB-encoded. Source: Mikhailov 2019, Google AI blog.
  const auto polynomial = [t](std::array<double, 6> c) {
    double value = 0;
    for (std::size_t i = c.size(); i-- > 0;) value = value * t + c[i];
    return render::srgb_to_linear(static_cast<float>(std::clamp(value, 0.0, 1.0)));
  };
  return {polynomial({0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943}),
          polynomial({0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604}),
          polynomial({0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973})};
}

render::Frame error_picture(const render::Frame& background, std::span<const float> errors_arcmin) {
  render::Frame picture;
  picture.width = background.width;
  picture.height = background.height;
  picture.color.resize(background.color.size());
  for (std::size_t i = 0; i < picture.color.size(); ++i) {
    const bool known = i < errors_arcmin.size() && errors_arcmin[i] >= 0;
    // A quarter of the light keeps the scene recognisable and every error colour brighter than its
    // surroundings.
    const glm::vec3 color =
        known ? error_color(errors_arcmin[i]) : glm::vec3(0.25f * luminance(background.color[i]));
    picture.color[i] = glm::vec4(color, 1);
  }
  draw_legend(picture);
  return picture;
}

render::Frame marked_picture(const render::Frame& background, std::span<const std::uint8_t> marked) {
  render::Frame picture;
  picture.width = background.width;
  picture.height = background.height;
  picture.color.resize(background.color.size());
  constexpr glm::vec3 kMark(1.0f, 0.25f, 0.02f);
  for (std::size_t i = 0; i < picture.color.size(); ++i) {
    const bool mark = i < marked.size() && marked[i] != 0;
    picture.color[i] = glm::vec4(mark ? kMark : glm::vec3(0.25f * luminance(background.color[i])), 1);
  }
  return picture;
}

}  // namespace catoptra::app

// Scenes with a concave mirror or a plus lens and things before, between and beyond its focus and centre; and
// where Gaussian optics has them seen: the mirror equation and the thick lens as closed forms.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/renderer.h"
#include "tests/render/lens_pvrr_scene.h"

namespace catoptra::test {

inline constexpr double kZoomRadius_mm = 600, kZoomFocus_mm = 300;  ///< of the mirror

/// An evenly lit, otherwise empty world before a dark sky. The eye is on the z axis at `eye_z_mm`, and sees
/// `height_mm` at the origin.
inline render::Scene zooming_world(double eye_z_mm, double height_mm) {
  render::Scene scene;
  scene.file = "zooming";
  scene.camera = {{0, 0, eye_z_mm},
                  {0, 0, 0},
                  {0, 1, 0},
                  2 * std::atan(0.5 * height_mm / std::abs(eye_z_mm)),
                  {300, 300}};
  scene.environment = {{0.02f, 0.02f, 0.02f}, "", 1.0f};
  scene.surroundings.emplace_back();
  return scene;
}

/// A concave sphere of 80 x 80 mm at the origin facing +z, the eye on its axis.
inline render::Scene before_concave_mirror(double eye_mm, int vertices_a_side = 17) {
  render::Scene scene = zooming_world(eye_mm, 76);
  scene.optics.push_back(conic_mirror(-kZoomRadius_mm, 0, 80, 80, vertices_a_side, vertices_a_side));
  return scene;
}

/// An equiconvex lens (R 200 mm, 4 mm, n 1.5, 12 x 12 mm: spherical aberration grows with the square of the
/// height) with its front at the origin towards +z, the eye on
/// its axis behind it.
inline constexpr double kLensRadius_mm = 200, kLensThickness_mm = 4;
inline render::Scene behind_plus_lens(double eye_mm, int vertices_a_side = 25) {
  render::Scene scene = zooming_world(-eye_mm, 10.8);
  scene.optics.push_back(lens_of(kLensRadius_mm, -kLensRadius_mm, kLensThickness_mm, 12, vertices_a_side));
  return scene;
}

/// A card at z: red at x < 0, blue at x > 0, from -half to half, from y = low to high.
inline void add_card(render::Scene& scene, double z, double half, double low, double high) {
  const float h = float(half), height = float(high - low);
  auto& mesh = scene.surroundings.at(0);
  add_quad(mesh, {-h, float(low), float(z)}, {h, 0, 0}, {0, height, 0}, kRed);
  add_quad(mesh, {0, float(low), float(z)}, {h, 0, 0}, {0, height, 0}, kBlue);
}

/// A paraxial ray from the eye on the axis, `eye_mm` before the mirror, that meets it at height 1: its height
/// `u_mm` before the mirror after reflection. Its inverse is how large a thing there appears on the mirror:
/// with 1 / u + 1 / u' = 1 / f and m = -u' / u, that is m / (1 - u' / eye).
inline double mirror_height(double u_mm, double eye_mm) {
  return 1 + u_mm / eye_mm - u_mm / kZoomFocus_mm;
}
inline double size_on_mirror(double u_mm, double eye_mm) {
  const double image = 1 / (1 / kZoomFocus_mm - 1 / u_mm), magnification = -image / u_mm;
  return magnification / (1 - image / eye_mm);
}

/// The same for the thick lens: height at `u_mm` before its front per height at the back vertex's plane, by
/// Gaussian ray matrices (Hecht 2017, 6.2.1), angles times the index.
inline double size_on_lens(double u_mm, double eye_mm) {
  const double n = 1.5, power = (n - 1) / kLensRadius_mm;
  double height = 1, angle = 1 / (eye_mm - kLensThickness_mm);  // the eye is that far before the back
  angle -= height * power;
  height += kLensThickness_mm / n * angle;
  angle -= height * power;
  height += u_mm * angle;
  return 1 / height;
}

/// Where, in a row of the picture, a colour begins and ends: columns to a fraction of a pixel.
struct Extent {
  double left, right;
};

/// Of the run of pixels along row `row` whose `channel` is above half of the row's largest.
inline std::optional<Extent> extent_in_row(const render::Frame& frame, int row, int channel) {
  const auto at = [&](int x) {
    return double(frame.color[std::size_t(row) * std::size_t(frame.width) + std::size_t(x)][channel]);
  };
  double half = 0;
  for (int x = 0; x < frame.width; ++x) half = std::max(half, 0.5 * at(x));
  std::optional<Extent> found;
  for (int x = 0; x + 1 < frame.width; ++x) {
    const double a = at(x), b = at(x + 1);
    const double place = x + (half - a) / (b - a);
    if (a < half && b >= half && !found) found = Extent{place, place};
    if (a >= half && b < half && found) found->right = place;
  }
  return found;
}

}  // namespace catoptra::test

// Where in a pixel its samples lie, and the ray through each: the same in every mode.
#pragma once

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "cad_import/error.h"
#include "render/scene.h"

namespace catoptra::render {

/// Offset of sample `index` from the pixel's centre, in pixels (+x right, +y down), within (-0.5, 0.5).
/// Sample 0 is the centre. The others come in opposite pairs of the R2 sequence (M. Roberts 2018, generalised
/// golden ratio) and, where their number is odd, one triangle about the centre: so that more samples do not
/// shift the picture. The triangle's radius gives four samples the second moment of a pixel, 1/12. (Two
/// samples cannot have all of that.)
[[nodiscard]] inline glm::dvec2 sample_offset(int index, int samples) {
  if (samples <= 1 || index == 0) return {0, 0};
  const bool triangle = samples % 2 == 0 && samples > 2;
  if (triangle && index <= 3) {
    const double angle = 0.26 + index * (2 * std::numbers::pi / 3), radius = std::numbers::sqrt2 / 3;
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }
  const int k = index - (triangle ? 4 : 1), pair = k / 2 + 1;
  const double a1 = 0.7548776662466927, a2 = 0.5698402909980532;
  const double x = 0.5 + a1 * pair, y = 0.5 + a2 * pair, sign = k % 2 == 0 ? 1 : -1;
  return sign * glm::dvec2(x - std::floor(x) - 0.5, y - std::floor(y) - 0.5);
}

/// Place of sample `index` in the pupil, in its radii (+x right, +y up), within the unit disc. Sample 0 is
/// the centre; the others come with those of sample_offset: opposite pairs, with angles by the golden ratio,
/// and the triangle. Areas within a pair's radius are a and 1 - a in turn, a by van der Corput's sequence
/// (Niederreiter 1992, 3.1): so that 4, 8, 12 ... samples have the mean square radius of a disc, 1/2. The two
/// first angles are those of a search for the least correlation with the places in the pixel, which would add
/// to the blur, at 16, 32 and 64 samples.
[[nodiscard]] inline glm::dvec2 pupil_point(int index, int samples) {
  if (samples <= 1 || index == 0) return {0, 0};
  const bool triangle = samples % 2 == 0 && samples > 2;
  if (triangle && index <= 3) {
    const double angle = 0.1745 - index * (2 * std::numbers::pi / 3), radius = std::sqrt(2.0 / 3);
    return {radius * std::cos(angle), radius * std::sin(angle)};
  }
  const int k = index - (triangle ? 4 : 1), pair = k / 2 + 1;
  double area = 0, digit = 0.25;
  for (int rest = (pair + 1) / 2; rest > 0; rest /= 2, digit /= 2) area += rest % 2 * digit;
  if (pair % 2 == 0) area = 1 - area;
  const double turns = 0.9167 + pair * 0.6180339887498949, radius = std::sqrt(area);
  const double angle = std::numbers::pi * (turns - std::floor(turns)), sign = k % 2 == 0 ? 1 : -1;
  return sign * radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

/// Pair `sample` of a fixed sequence of standard normal numbers: the tilt of rough optics in that sample of a
/// picture, in their standard deviations, along the first edge and across. Sample 0 has none, the others come
/// in opposite pairs, so that an odd number of samples does not turn a picture. Box and Muller 1958, from two
/// additive sequences (golden ratio, square root of two) that are not those of places in pixel and pupil.
[[nodiscard]] inline glm::dvec2 normal_pair(int sample) {
  if (sample == 0) return {0, 0};
  const int pair = (sample + 1) / 2;
  const double a = 0.5 + pair * 0.6180339887498949, b = 0.5 + pair * 0.4142135623730951;
  const double radius = std::sqrt(-2 * std::log(1 - (a - std::floor(a)))),
               angle = std::numbers::pi * (b - std::floor(b)), sign = sample % 2 == 1 ? 1 : -1;
  return sign * radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

/// The tilt of a face of standard deviations `roughness_rad` in that sample, radians, for
/// optics::tilted_normal: cut where tangents would grow without bound.
[[nodiscard]] inline glm::dvec2 rough_tilt(const glm::dvec2& roughness_rad, int sample) {
  constexpr double kSteepest = 1.5;
  return glm::clamp(normal_pair(sample) * roughness_rad, -kSteepest, kSteepest);
}

/// The camera's axes in the world, unit. Throws catoptra::Error for a camera that has no picture.
struct CameraAxes {
  glm::dvec3 right, up, forward;
};
[[nodiscard]] inline CameraAxes camera_axes(const Camera& camera) {
  const glm::dvec3 view = camera.target_mm - camera.eye_mm, across = glm::cross(view, camera.up);
  if (!(glm::length(across) > 1e-12 * glm::length(view) * glm::length(camera.up)))
    throw Error({}, "camera", "looks along its own up vector, or at its own eye", "change target or up");
  if (!(camera.fov_rad > 0 && camera.fov_rad < std::numbers::pi))
    throw Error({}, "camera", "field of view is not between 0 and 180 degrees");
  const glm::dvec3 forward = glm::normalize(view), right = glm::normalize(across);
  return {right, glm::cross(right, forward), forward};
}

/// The camera of one sample: `offset_px` within the pixel, and where there is a pupil the eye at its place in
/// it, with the picture shifted so that the plane in focus stays where it is (thin lens; Cook et al. 1984).
[[nodiscard]] inline Camera sample_camera(const Camera& camera, int index, int samples) {
  Camera of_sample = camera;
  of_sample.offset_px = sample_offset(index, samples);
  of_sample.sample = index;
  if (!(camera.pupil_mm > 0)) return of_sample;
  const CameraAxes axes = camera_axes(camera);
  const glm::dvec2 place = 0.5 * camera.pupil_mm * pupil_point(index, samples);
  const glm::dvec3 moved = place.x * axes.right + place.y * axes.up;
  const double focus_mm =
      camera.focus_mm > 0 ? camera.focus_mm : glm::length(camera.target_mm - camera.eye_mm);
  of_sample.eye_mm += moved;
  of_sample.target_mm += moved;
  of_sample.shift = -place / focus_mm;
  return of_sample;
}

/// The rays of a pinhole camera. `corner` + column * `dx` + row * `dy` is the direction through the centre of
/// pixel (column, row), scaled so that its component along `forward` is 1; fractions of pixels are allowed.
struct CameraRays {
  glm::dvec3 eye_mm, forward, corner, dx, dy;
  double pixel = 0;  ///< side of a pixel at unit distance along `forward`
  int sample = 0;    ///< see Camera

  [[nodiscard]] glm::dvec3 direction(double column, double row) const {
    return corner + column * dx + row * dy;
  }
};

/// Columns run to the right, rows down. Throws catoptra::Error for a camera that has no picture.
[[nodiscard]] inline CameraRays camera_rays(const Camera& camera, int width, int height) {
  const CameraAxes axes = camera_axes(camera);
  CameraRays rays;
  rays.eye_mm = camera.eye_mm;
  rays.sample = camera.sample;
  rays.forward = axes.forward;
  rays.pixel = 2 * std::tan(0.5 * camera.fov_rad) / height;
  rays.dx = rays.pixel * axes.right;
  rays.dy = -rays.pixel * axes.up;
  rays.corner = rays.forward + camera.shift.x * axes.right + camera.shift.y * axes.up +
                (camera.offset_px.x - 0.5 * (width - 1)) * rays.dx +
                (camera.offset_px.y - 0.5 * (height - 1)) * rays.dy;
  return rays;
}

}  // namespace catoptra::render

// Where in a pixel its samples lie, and the ray through each: the same in every mode.
#pragma once

#include <cmath>
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

/// The rays of a pinhole camera. `corner` + column * `dx` + row * `dy` is the direction through the centre of
/// pixel (column, row), scaled so that its component along `forward` is 1; fractions of pixels are allowed.
struct CameraRays {
  glm::dvec3 eye_mm, forward, corner, dx, dy;
  double pixel = 0;  ///< side of a pixel at unit distance along `forward`

  [[nodiscard]] glm::dvec3 direction(double column, double row) const {
    return corner + column * dx + row * dy;
  }
};

/// Columns run to the right, rows down. Throws catoptra::Error for a camera that has no picture.
[[nodiscard]] inline CameraRays camera_rays(const Camera& camera, int width, int height) {
  const glm::dvec3 view = camera.target_mm - camera.eye_mm, across = glm::cross(view, camera.up);
  if (!(glm::length(across) > 1e-12 * glm::length(view) * glm::length(camera.up)))
    throw Error({}, "camera", "looks along its own up vector, or at its own eye", "change target or up");
  if (!(camera.fov_rad > 0 && camera.fov_rad < std::numbers::pi))
    throw Error({}, "camera", "field of view is not between 0 and 180 degrees");
  CameraRays rays;
  rays.eye_mm = camera.eye_mm;
  rays.forward = glm::normalize(view);
  const glm::dvec3 right = glm::normalize(across), up = glm::cross(right, rays.forward);
  rays.pixel = 2 * std::tan(0.5 * camera.fov_rad) / height;
  rays.dx = rays.pixel * right;
  rays.dy = -rays.pixel * up;
  rays.corner = rays.forward - 0.5 * (width - 1) * rays.dx - 0.5 * (height - 1) * rays.dy;
  return rays;
}

}  // namespace catoptra::render

// The power of a lens by brute force: real rays next to a chief ray, from the object through both surfaces.
// No second derivative of any surface and no wavefront is in it.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <stdexcept>

#include "optics/exact_hit.h"
#include "optics/lens_path.h"
#include "optics/refraction.h"

namespace catoptra::test {

struct Line {
  glm::dvec3 point{0}, direction{0};
};

/// Refracts at the first face of a side whose surface has u = x and v = y.
inline Line refract_at(const cad_import::Face& face, const Line& in, double eta) {
  optics::Ray ray;
  ray.origin_mm = in.point - 20.0 * in.direction;
  ray.direction = in.direction;
  // Twice: the second start is within rounding of the point, and so is its result.
  auto hit = optics::newton_hit(*face.surface, ray, {in.point.x, in.point.y});
  if (hit) hit = optics::newton_hit(*face.surface, ray, hit->uv);
  if (!hit) throw std::runtime_error("a ray misses a surface");
  const glm::dvec3 normal = glm::dot(hit->normal, in.direction) < 0 ? hit->normal : -hit->normal;
  const auto out = optics::refract(in.direction, normal, eta);
  if (!out) throw std::runtime_error("total reflection");
  return {hit->position_mm, *out};
}

/// The chief ray from the eye through the lens: direction of its object side and its point on the front.
inline Line chief_ray(const optics::Optic& lens, const Line& eye_side, const optics::LensIndices& n) {
  const Line inside = refract_at(lens.back.faces[0], eye_side, n.around / n.lens);
  return refract_at(lens.faces[0], inside, n.lens / n.around);
}

/// The vergence matrix, 1/mm, in the unit vectors `x`, `y` across the eye-side ray, of light from an object
/// `object_mm` before the front (infinite: a plane wave) where it crosses the plane through `at` across the
/// eye-side ray. Central differences at four steps, extrapolated: error of order step^8.
inline glm::dmat2 pencil_vergence(const optics::Optic& lens, const Line& eye_side, const glm::dvec3& at,
                                  const glm::dvec3& x, const glm::dvec3& y, double object_mm,
                                  const optics::LensIndices& n) {
  const Line object = chief_ray(lens, eye_side, n);  // towards the object
  const glm::dvec3 helper = std::abs(object.direction.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 ex = glm::normalize(glm::cross(object.direction, helper)),
                   ey = glm::cross(object.direction, ex);
  struct Arrival {
    glm::dvec2 position, direction;
  };
  const auto arrive = [&](const glm::dvec2& step) {
    const glm::dvec3 beside = object.point + step.x * ex + step.y * ey;
    glm::dvec3 d = -object.direction;
    if (std::isfinite(object_mm)) d = glm::normalize(beside - (object.point + object_mm * object.direction));
    const Line inside = refract_at(lens.faces[0], {beside, d}, n.around / n.lens);
    const Line out = refract_at(lens.back.faces[0], inside, n.lens / n.around);
    const double t =
        glm::dot(at - out.point, eye_side.direction) / glm::dot(out.direction, eye_side.direction);
    const glm::dvec3 p = out.point + t * out.direction - at;
    // Slopes against the chief ray: directions and positions of one ray in the same plane.
    const double along = -glm::dot(out.direction, eye_side.direction);
    return Arrival{{glm::dot(p, x), glm::dot(p, y)},
                   {glm::dot(out.direction, x) / along, glm::dot(out.direction, y) / along}};
  };
  constexpr int kLevels = 4;
  std::array<glm::dmat2, kLevels> positions, slopes;
  for (int level = 0; level < kLevels; ++level) {
    const double h = 1.6 / (1 << level);
    for (int axis = 0; axis < 2; ++axis) {
      const glm::dvec2 step = axis == 0 ? glm::dvec2(h, 0) : glm::dvec2(0, h);
      const Arrival plus = arrive(step), minus = arrive(-step);
      positions[level][axis] = (plus.position - minus.position) / (2 * h);
      slopes[level][axis] = (plus.direction - minus.direction) / (2 * h);
    }
  }
  for (int order = 1; order < kLevels; ++order)
    for (int level = 0; level + order < kLevels; ++level) {
      const double power = double(1 << (2 * order));
      positions[level] = (power * positions[level + 1] - positions[level]) / (power - 1);
      slopes[level] = (power * slopes[level + 1] - slopes[level]) / (power - 1);
    }
  return -(slopes[0] * glm::inverse(positions[0]));
}

}  // namespace catoptra::test

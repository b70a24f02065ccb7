// Measures a lens as a focimeter does: a narrow pencil of real rays through both exact surfaces. Knows
// nothing of how the lens was made.
#pragma once

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "cad_import/cad_model.h"
#include "optics/exact_hit.h"
#include "optics/refraction.h"

namespace catoptra::test {

struct OutgoingRay {
  glm::dvec3 position{0}, direction{0};
};

inline const cad_import::Face& face_called(const cad_import::CadModel& model, const std::string& name) {
  for (const cad_import::Face& face : model.faces)
    if (face.name == name) return face;
  throw std::runtime_error("no face is called " + name);
}

/// A lens whose surfaces have u = x and v = y, in air.
struct MeasuredLens {
  const cad_import::Face& front;
  const cad_import::Face& back;
  double index;

  MeasuredLens(const cad_import::CadModel& model, double n)
      : front(face_called(model, "front")), back(face_called(model, "back")), index(n) {}

  /// Refracts at both surfaces a ray that comes along `direction` (z < 0) and would cross z = 0 at (x, y).
  [[nodiscard]] OutgoingRay trace(double x, double y, const glm::dvec3& direction = {0, 0, -1}) const {
    const glm::dvec3 start = glm::dvec3(x, y, 0) - 100.0 * direction;
    const OutgoingRay inside = refracted(front, {start, direction}, 1 / index);
    return refracted(back, inside, index);
  }

 private:
  [[nodiscard]] static OutgoingRay refracted(const cad_import::Face& face, const OutgoingRay& in,
                                             double eta) {
    optics::Ray ray;
    ray.origin_mm = in.position;
    ray.direction = in.direction;
    const auto hit = optics::newton_hit(*face.surface, ray, {in.position.x, in.position.y});
    if (!hit) throw std::runtime_error("a ray misses the " + face.name);
    const glm::dvec3 against = glm::dot(hit->normal, in.direction) < 0 ? hit->normal : -hit->normal;
    const auto out = optics::refract(in.direction, against, eta);
    if (!out) throw std::runtime_error("total reflection at the " + face.name);
    return {hit->position_mm, *out};
  }
};

struct MeasuredPower {
  glm::dmat2 power_d{
      0};  ///< vergences at the point where the middle ray leaves, along x and y turned with it
  glm::dvec2 prism_d{0};  ///< deviation of the middle ray, positive towards +x and +y
};

/// The pencil around the ray that comes along `direction` and would cross z = 0 at (x, y). A wavefront of
/// vergence V gives a ray at q from the middle one the slope -V q; V follows from central differences, whose
/// error grows with the square of the pencil's radius: below 1e-4 D at 0.1 mm for radii of 20 mm and more.
inline MeasuredPower measure(const MeasuredLens& lens, double x = 0, double y = 0,
                             const glm::dvec3& direction = {0, 0, -1}, double pencil_mm = 0.1) {
  const OutgoingRay middle = lens.trace(x, y, direction);
  const glm::dvec3 d = middle.direction;
  // Axes that the rotation from -z to d makes of x and y (Rodrigues' formula).
  const glm::dvec3 w = glm::cross(glm::dvec3(0, 0, -1), d);
  const auto turned = [&](const glm::dvec3& v) {
    const glm::dvec3 across = glm::cross(w, v);
    return v + across + glm::cross(w, across) / (1 - d.z);
  };
  const glm::dvec3 ux = turned({1, 0, 0}), uy = turned({0, 1, 0});
  glm::dmat2 offsets{0}, slopes{0};
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const double h = side * pencil_mm;
      const OutgoingRay ray = lens.trace(x + (axis == 0 ? h : 0), y + (axis == 1 ? h : 0), direction);
      const double along = glm::dot(ray.direction, d);
      const glm::dvec3 at =
          ray.position + ray.direction * (glm::dot(middle.position - ray.position, d) / along);
      const glm::dvec3 from = at - middle.position;
      offsets[axis] += side * glm::dvec2(glm::dot(from, ux), glm::dot(from, uy));
      slopes[axis] += side * glm::dvec2(glm::dot(ray.direction, ux), glm::dot(ray.direction, uy)) / along;
    }
  return {-1000.0 * (slopes * glm::inverse(offsets)), {-100 * d.x / d.z, -100 * d.y / d.z}};
}

}  // namespace catoptra::test

// Rows whose expected value is a formula.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "cad_import/import.h"
#include "cad_import/mirror_blank.h"
#include "optics/exact_hit.h"
#include "optics/ray_scene.h"
#include "optics/reflection.h"
#include "tessellate/optic_mesh.h"
#include "tests/support/analytic_optic.h"
#include "tests/validation/table.h"

namespace catoptra::validation {
namespace {

/// A ray that a mirror sends on: from `origin_mm` on the mirror.
struct Reflected {
  glm::dvec3 origin_mm, direction;
};

Reflected reflect_at(const cad_import::ExactSurface& surface, const optics::Ray& ray) {
  const auto hit = optics::newton_hit(surface, ray, {ray.origin_mm.x, ray.origin_mm.y});
  if (!hit) throw Error("validation", "", "a ray misses its mirror");
  return {hit->position_mm, optics::reflect(ray.direction, hit->normal)};
}

/// Rays parallel to the axis meet in the focus of a concave paraboloid (Hecht 2017, 5.4.2).
Row paraboloid_focus() {
  constexpr double kRadius_mm = 800;
  const test::ConicSurface surface(-1 / kRadius_mm, -1, 60, 60);
  const glm::dvec3 focus(0, 0, kRadius_mm / 2);
  double farthest = 0;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j) {
      const Reflected out = reflect_at(surface, {{3.0 * i, 3.0 * j, 1000}, {0, 0, -1}});
      farthest = std::max(farthest, glm::length(glm::cross(focus - out.origin_mm, out.direction)));
    }
  return {"Concave paraboloid, R 800: greatest distance of 1,681 axial rays from the focus", "0 mm",
          below(farthest, "mm"), below(farthest, "mm")};
}

/// A ray parallel to the axis of a concave sphere at height h crosses the axis at R - R / (2 cos a), sin a =
/// h / R.
Row sphere_aberration() {
  constexpr double kRadius_mm = 1200, kHeight_mm = 80;
  const test::ConicSurface surface(-1 / kRadius_mm, 0, 100, 100);
  const Reflected out = reflect_at(surface, {{kHeight_mm, 0, 1000}, {0, 0, -1}});
  const double computed = out.origin_mm.z - out.direction.z * out.origin_mm.x / out.direction.x;
  const double expected = kRadius_mm - kRadius_mm / (2 * std::sqrt(1 - std::pow(kHeight_mm / kRadius_mm, 2)));
  return {"Concave sphere, R 1200: where a ray 80 mm off the axis crosses it", number(expected, 8, "mm"),
          number(computed, 8, "mm"), below(std::abs(computed - expected), "mm")};
}

/// Angle turned by the eye's ray over angle turned by the reflected ray, by central differences.
double traced_magnification(double eye_distance_mm, double radius_mm, double incidence_rad, bool tangential) {
  const test::ConicSurface surface(1 / radius_mm, 0, 200, 200);
  const glm::dvec3 eye = eye_distance_mm * glm::dvec3(std::sin(incidence_rad), 0, std::cos(incidence_rad));
  const glm::dvec3 forward = -glm::normalize(eye);
  const glm::dvec3 turn = tangential ? glm::dvec3(forward.z, 0, -forward.x) : glm::dvec3(0, 1, 0);
  constexpr double kStep_rad = 1e-4;  // the error falls with its square: 1e-8 of the value
  glm::dvec3 out[2];
  for (int side = 0; side < 2; ++side) {
    const double angle = (2 * side - 1) * kStep_rad;
    const glm::dvec3 direction = std::cos(angle) * forward + std::sin(angle) * turn;
    const auto hit = optics::newton_hit(surface, {eye, direction}, {0, 0});
    if (!hit) throw Error("validation", "", "a ray misses its mirror");
    out[side] = optics::reflect(direction, hit->normal);
  }
  return 2 * kStep_rad / std::asin(glm::length(glm::cross(out[0], out[1])));
}

Row magnification(bool tangential) {
  constexpr double kEye_mm = 840, kRadius_mm = 1260, kIncidence_deg = 35;
  const auto closed = optics::mirror_magnification(kEye_mm, kRadius_mm, glm::radians(kIncidence_deg));
  const double expected = tangential ? closed.tangential : closed.sagittal;
  const double computed = traced_magnification(kEye_mm, kRadius_mm, glm::radians(kIncidence_deg), tangential);
  return {std::string("Convex R 1260, eye at 840 mm, incidence 35°: magnification ") +
              (tangential ? "in the plane of incidence" : "across it"),
          number(expected, 6), number(computed, 6), below(std::abs(computed - expected), "")};
}

/// A mirror glass from STEP, judged by the sphere that it was ordered as.
std::vector<Row> step_sphere(const std::filesystem::path& folder) {
  constexpr double kRadius_mm = 1200;
  const auto file = folder / "validation_sphere.step";
  cad_import::write_mirror_blank({}, file);  // 170 x 110 mm, R 1200
  const auto model = cad_import::import_cad(file);
  optics::Optic optic;
  for (const auto& face : model.faces)
    if (face.name == "Glass") optic.faces.push_back(face);
  optic.mesh = tessellate::tessellate_optic(optic.faces).mesh.arrays();
  optics::RayScene scene;
  scene.add_optic(optic.mesh);
  scene.commit();

  const glm::dvec3 centre(0, 0, -kRadius_mm);
  double farthest = 0, turned = 0, least = std::numeric_limits<double>::max(), greatest = 0;
  for (int i = -40; i <= 40; ++i)
    for (int j = -25; j <= 25; ++j) {
      const optics::Ray ray{{2.1 * i, 2.1 * j, 800}, {0, 0, -1}};
      const auto hit = optics::exact_hit(optic, ray, scene.intersect(ray));
      if (!hit) throw Error(file.string(), "", "a ray misses the mirror");
      const glm::dvec3 from_centre = hit->position_mm - centre;
      farthest = std::max(farthest, std::abs(glm::length(from_centre) - kRadius_mm));
      turned = std::max(turned, glm::length(glm::cross(hit->normal, glm::normalize(from_centre))));
      const auto curvature = optic.faces[0].surface->principal_curvatures(hit->uv.x, hit->uv.y);
      least = std::min(least, 1 / curvature.k1);
      greatest = std::max(greatest, 1 / curvature.k2);
    }
  const double off = std::max(greatest - kRadius_mm, kRadius_mm - least);
  return {
      {"Glass R 1200 from STEP (B-spline): distance of 4,131 exact hits from the sphere", "0 mm",
       below(farthest, "mm"), below(farthest, "mm")},
      {"... angle between its normals and the sphere's", "0 rad", below(turned, "rad"), below(turned, "rad")},
      {"... principal radii", "1200 mm", number(least, 5) + " to " + number(greatest, 5, "mm"),
       below(off, "mm")}};
}

}  // namespace

std::vector<Row> closed_form_rows(const std::filesystem::path& folder) {
  std::vector<Row> rows = {paraboloid_focus(), sphere_aberration(), magnification(true),
                           magnification(false)};
  for (Row& row : step_sphere(folder)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace catoptra::validation

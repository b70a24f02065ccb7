#include "optics/light_path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "cad_import/error.h"
#include "optics/planar_glass.h"
#include "optics/refraction.h"

namespace catoptra::optics {
namespace {

/// Least sine of the angle between light and face: what comes in flatter (0.2 arcsec) has no aperture.
constexpr double kLeastSlope = 1e-6;
/// Least area of an aperture over that of its face: below it clipping leaves nothing but rounding.
constexpr double kLeastArea = 1e-12;

/// Twice the area, as a vector.
glm::dvec3 area_vector(const ConvexPolygon& polygon) {
  glm::dvec3 sum(0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return sum;
}

double total_area(std::span<const ConvexPolygon> pieces) {
  double sum = 0;
  for (const ConvexPolygon& piece : pieces) sum += glm::length(area_vector(piece));
  return sum;
}

double cosine_at(const LightFace& face, const LightPlace& place, const glm::dvec3& point) {
  return std::min(1.0, std::abs(glm::dot(face.normal, glm::normalize(towards(place, point)))));
}

glm::dvec4 plane_through(const glm::dvec3& normal, const glm::dvec3& point) {
  return {normal, -glm::dot(normal, point)};
}

/// Indices of the light that comes from the side of `incoming` (unit normal of the face on that side).
void set_indices(const LightFace& face, bool from_front, VirtualLight& light) {
  if (!is_planar_glass(face.kind)) return;
  const bool out = face.kind == OpticKind::refractor && !from_front;  // a pane has air on both sides
  light.n_from = out ? face.ior : 1;
  light.n_to = out ? 1 : face.ior;
}

/// Mirrors a place at the face.
LightPlace mirrored(const LightPlace& place, const LightFace& face) {
  const double height = glm::dot(face.normal, towards(place, face.centroid_mm));
  return place - LightPlace(2 * height * face.normal, 0);
}

/// A point light seen through a plate stands nearer by t (1 - 1 / n), on any side no nearer than a hundredth
/// of its height: a light nearer to the pane than that stays on its side of it.
LightPlace through_pane(const LightPlace& place, const LightFace& face) {
  if (place.w == 0) return place;
  const double height = glm::dot(face.normal, towards(place, face.centroid_mm));
  const double shift =
      std::min(face.thickness_mm * (1 - 1 / face.ior), 0.99 * std::abs(height)) * (height > 0 ? 1 : -1);
  return place - LightPlace(shift * face.normal, 0);
}

/// Refracts the light at the centroid into `light`. False beyond the critical angle.
bool refract_light(const LightPlace& place, const LightFace& face, const glm::dvec3& incoming,
                   VirtualLight& light) {
  const glm::dvec3 way = towards(place, face.centroid_mm);
  const double distance = glm::length(way), n = light.n_to / light.n_from;
  const glm::dvec3 direction = -way / distance;
  const auto refracted = refract(direction, incoming, 1 / n);
  if (!refracted) return false;
  const double cos_a = -glm::dot(direction, incoming), cos_b = -glm::dot(*refracted, incoming);
  if (cos_b < kLeastSlope) return false;
  // The power on the face at the centroid is the same before and behind it.
  light.gain *= cos_a / cos_b;
  if (place.w == 0) {
    light.place = {-*refracted, 0};
    return true;
  }
  light.place = {face.centroid_mm - distance * n * *refracted, 1};
  light.gain *= n * n;
  return true;
}

/// The part of the face that the light before reaches.
std::vector<ConvexPolygon> make_aperture(const LightFace& face, const VirtualLight* before) {
  if (!before) return face.pieces;
  const double least = kLeastArea * total_area(face.pieces);
  std::vector<ConvexPolygon> aperture;
  for (const ConvexPolygon& opening : before->aperture) {
    const std::vector<glm::dvec4> volume = light_volume(*before, opening);
    for (ConvexPolygon piece : face.pieces) {
      for (const glm::dvec4& plane : volume) piece = clip(piece, plane);
      if (glm::length(area_vector(piece)) > least) aperture.push_back(std::move(piece));
    }
  }
  return aperture;
}

/// Adds what the face makes of a light (null: the source), reflected and passed.
void add_step(const LightPlace& source, std::span<const LightFace> faces, std::size_t index, int before,
              std::vector<VirtualLight>& lights) {
  const LightFace& face = faces[index];
  const LightPlace place = before < 0 ? source : lights[std::size_t(before)].place;
  const glm::dvec3 way = towards(place, face.centroid_mm);
  const double slope = glm::dot(face.normal, way) / glm::length(way);
  if (!(std::abs(slope) > kLeastSlope) || (face.one_sided && slope < 0)) return;
  VirtualLight light;
  light.aperture = make_aperture(face, before < 0 ? nullptr : &lights[std::size_t(before)]);
  if (light.aperture.empty()) return;
  light.before = before;
  light.face = index;
  light.gain = before < 0 ? 1 : lights[std::size_t(before)].gain;
  set_indices(face, slope > 0, light);
  const glm::dvec3 incoming = slope > 0 ? face.normal : -face.normal;

  VirtualLight reflected = light;
  reflected.place = mirrored(place, face);
  reflected.lit_side = plane_through(incoming, face.centroid_mm);
  lights.push_back(std::move(reflected));
  if (face.kind == OpticKind::mirror) return;

  light.reflected = false;
  light.lit_side = plane_through(-incoming, face.centroid_mm);
  if (face.kind == OpticKind::pane)
    light.place = through_pane(place, face);
  else if (!refract_light(place, face, incoming, light))
    return;
  lights.push_back(std::move(light));
}

}  // namespace

std::vector<glm::dvec2> disc_points(int count) {
  if (count < 1) throw Error("", "disc", "needs at least one point");
  std::vector<glm::dvec2> points;
  const int odd = count % 2;
  if (odd) points.emplace_back(0, 0);
  // Rings of equal area, one for each pair; the centre's share of an odd count is a disc of one share.
  for (int i = 0; i < count / 2; ++i) {
    const double radius = std::sqrt((odd + 2 * i + 1) / double(count));
    const double angle = std::numbers::pi * i / std::numbers::phi;
    const glm::dvec2 point = radius * glm::dvec2(std::cos(angle), std::sin(angle));
    points.push_back(point);
    points.push_back(-point);
  }
  return points;
}

std::vector<LightPlace> disc_lights(const LightPlace& centre, const glm::dvec3& axis, double radius_mm,
                                    int count) {
  if (radius_mm <= 0 || count == 1) return {centre};
  constexpr double kDiscDistance_mm = 1000;  // of directional lights
  const glm::dvec3 n = glm::normalize(centre.w == 0 ? glm::dvec3(centre) : axis);
  const glm::dvec3 e =
      glm::normalize(glm::cross(n, std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
  const glm::dvec3 f = glm::cross(n, e);
  std::vector<LightPlace> places;
  for (const glm::dvec2& point : disc_points(count)) {
    const glm::dvec3 offset = radius_mm * (point.x * e + point.y * f);
    places.push_back(centre.w == 0 ? LightPlace(glm::normalize(kDiscDistance_mm * n + offset), 0)
                                   : centre + LightPlace(offset, 0));
  }
  return places;
}

ConvexPolygon clip(const ConvexPolygon& polygon, const glm::dvec4& plane) {
  // Sutherland and Hodgman, Communications of the ACM 17(1), 1974, for one plane.
  ConvexPolygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double from = side_of(plane, a), to = side_of(plane, b);
    if (from >= 0) inside.push_back(a);
    if ((from < 0 && to > 0) || (from > 0 && to < 0)) inside.push_back(a + from / (from - to) * (b - a));
  }
  return inside.size() < 3 ? ConvexPolygon{} : inside;
}

double side_of(const glm::dvec4& plane, const glm::dvec3& point) {
  return glm::dot(glm::dvec3(plane), point) + plane.w;
}

glm::dvec3 towards(const LightPlace& place, const glm::dvec3& point) {
  return glm::dvec3(place) - place.w * point;
}

glm::dvec3 crossing(const glm::dvec4& plane, const LightPlace& place, const glm::dvec3& point) {
  const glm::dvec3 way = towards(place, point);
  return point - side_of(plane, point) / glm::dot(glm::dvec3(plane), way) * way;
}

std::vector<glm::dvec4> light_volume(const VirtualLight& light, const ConvexPolygon& piece) {
  std::vector<glm::dvec4> planes{light.lit_side};
  // Seen from the light, sides run about the piece in one sense, which its area tells.
  const glm::dvec3 area = area_vector(piece);
  const double sense = glm::dot(area, towards(light.place, piece[0])) > 0 ? 1 : -1;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const glm::dvec3 &a = piece[i], &b = piece[(i + 1) % piece.size()];
    const glm::dvec3 across = glm::cross(towards(light.place, a), b - a);
    const double length = glm::length(across);
    if (length > 0) planes.push_back(plane_through(sense / length * across, a));
  }
  return planes;
}

std::vector<VirtualLight> virtual_lights(const LightPlace& source, std::span<const LightFace> faces,
                                         int depth) {
  std::vector<VirtualLight> lights;
  std::size_t first = 0;
  for (int step = 0; step < depth; ++step) {
    const std::size_t last = lights.size();
    for (std::size_t face = 0; face < faces.size(); ++face) {
      if (step == 0) add_step(source, faces, face, -1, lights);
      for (std::size_t before = first; before < last; ++before)
        if (lights[before].face != face) add_step(source, faces, face, int(before), lights);
    }
    if (lights.size() == last) break;
    first = last;
  }
  return lights;
}

int step_count(std::span<const VirtualLight> lights, std::size_t index) {
  int count = 1;
  for (int before = lights[index].before; before >= 0; before = lights[std::size_t(before)].before) ++count;
  return count;
}

glm::dvec3 face_share(const LightFace& face, const VirtualLight& light, double cos_theta_i) {
  if (face.kind == OpticKind::mirror) return glm::dvec3(face.reflectance);
  const double r =
      fresnel_dielectric(std::clamp(cos_theta_i, 0.0, 1.0), light.n_from, light.n_to).unpolarised;
  const double reflected = face.kind == OpticKind::pane ? plate_reflectance(r) : r;
  return light.reflected ? glm::dvec3(reflected) : (1 - reflected) * glm::dvec3(face.tint);
}

std::optional<LightPath> light_path(std::span<const VirtualLight> lights, std::span<const LightFace> faces,
                                    const LightPlace& source, std::size_t index, const glm::dvec3& point) {
  LightPath path;
  glm::dvec3 lit = point;
  for (int i = int(index); i >= 0; i = lights[std::size_t(i)].before) {
    const VirtualLight& light = lights[std::size_t(i)];
    if (side_of(light.lit_side, lit) <= 0) return {};
    // The apertures hold all earlier ones: the last alone decides.
    const auto inside = [&](const ConvexPolygon& piece) {
      const auto planes = light_volume(light, piece);
      return std::ranges::all_of(planes, [&](const glm::dvec4& plane) { return side_of(plane, lit) >= 0; });
    };
    if (path.points.empty() && std::ranges::none_of(light.aperture, inside)) return {};
    lit = crossing(light.lit_side, light.place, lit);
    const LightPlace& place = light.before < 0 ? source : lights[std::size_t(light.before)].place;
    path.points.push_back(lit);
    path.share *= face_share(faces[light.face], light, cosine_at(faces[light.face], place, lit));
  }
  return path;
}

double unit_irradiance(const LightPlace& place, const glm::dvec3& point, const glm::dvec3& normal) {
  const glm::dvec3 way = towards(place, point);
  const double squared = glm::dot(way, way), cosine = glm::dot(way, normal) / std::sqrt(squared);
  constexpr double kUnitDistance_mm = 1000;
  return std::max(0.0, cosine) * (place.w == 0 ? 1 : kUnitDistance_mm * kUnitDistance_mm / squared);
}

}  // namespace catoptra::optics

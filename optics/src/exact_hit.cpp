#include "optics/exact_hit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

namespace catoptra::optics {
namespace {

using cad_import::ExactSurface;
using cad_import::Face;
using cad_import::ParameterDomain;
using cad_import::SurfaceFrame;

constexpr int kMaxIterations = 20;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Two unit vectors that complete `w` to an orthonormal frame without a branch on a small component.
// Source: Duff et al., Building an orthonormal basis, revisited, JCGT 6(1), 2017.
std::array<glm::dvec3, 2> perpendiculars(const glm::dvec3& w) {
  const double sign = std::copysign(1.0, w.z);
  const double a = -1 / (sign + w.z), b = w.x * w.y * a;
  return {glm::dvec3(1 + sign * w.x * w.x * a, sign * b, -sign * w.x),
          glm::dvec3(b, sign + w.y * w.y * a, -w.y)};
}

// A parameter brought back into its period, or held within half a range beyond its ends while iterating.
double restrain(double x, double low, double high, double period) {
  if (period > 0) return x - period * std::floor((x - low) / period);
  const double slack = 0.5 * (high - low);
  return std::clamp(x, low - slack, high + slack);
}

glm::dvec2 restrain(const glm::dvec2& uv, const ParameterDomain& d) {
  return {restrain(uv.x, d.u_min, d.u_max, d.u_period), restrain(uv.y, d.v_min, d.v_max, d.v_period)};
}

bool inside(double x, double low, double high, double period) {
  const double slack = 1e-9 * (high - low);  // a hit on the very border belongs to the surface
  if (x >= low - slack && x <= high + slack) return true;
  return period > 0 && (x + period <= high + slack || x - period >= low - slack);
}

glm::dvec3 normal_of(const ExactSurface& surface, const SurfaceFrame& frame, const glm::dvec2& uv) {
  const glm::dvec3 n = glm::cross(frame.du, frame.dv);
  const double length = glm::length(n);
  const bool regular = length > 1e-8 * (glm::dot(frame.du, frame.du) + glm::dot(frame.dv, frame.dv));
  return regular ? n * (surface.orientation() / length) : surface.unit_normal(uv.x, uv.y);
}

std::optional<ExactHit> hit_face(const Face& face, const Ray& ray, const glm::dvec2& start) {
  auto hit = newton_hit(*face.surface, ray, start);
  if (hit && face.trim && !face.trim->contains(hit->uv.x, hit->uv.y)) return std::nullopt;
  return hit;
}

}  // namespace

std::optional<ExactHit> newton_hit(const ExactSurface& surface, const Ray& ray, glm::dvec2 start_uv) {
  const ParameterDomain domain = surface.domain();
  const auto [e1, e2] = perpendiculars(ray.direction);
  glm::dvec2 uv = restrain(start_uv, domain);
  glm::dvec2 step{0};
  double last_distance = kInfinity;
  // The unknowns are (u, v) alone: the ray's distance along itself follows from the point, so the system is
  // the two components of surface(u, v) - origin across the ray.
  for (int iteration = 0; iteration <= kMaxIterations; ++iteration) {
    const SurfaceFrame frame = surface.d1(uv.x, uv.y);
    const glm::dvec3 offset = frame.point - ray.origin_mm;
    const glm::dvec2 f{glm::dot(offset, e1), glm::dot(offset, e2)};
    const double distance = std::hypot(f.x, f.y);
    // Beyond some 100 m from the origin of coordinates 1e-10 mm is below the rounding of the coordinates
    // themselves.
    const double scale = std::max(glm::length(ray.origin_mm), glm::length(frame.point));
    if (distance <= std::max(kExactHitTolerance, 4 * kEpsilon * scale)) {
      const double t = glm::dot(offset, ray.direction);
      if (!inside(uv.x, domain.u_min, domain.u_max, domain.u_period) ||
          !inside(uv.y, domain.v_min, domain.v_max, domain.v_period) || t < ray.t_min_mm || t > ray.t_max_mm)
        return std::nullopt;
      return ExactHit{t, frame.point, normal_of(surface, frame, uv), 0, uv, iteration};
    }
    if (!std::isfinite(distance)) return std::nullopt;
    if (distance > 2 * last_distance && iteration < kMaxIterations) {  // overshot: go half way back
      step *= 0.5;
      uv = restrain(uv - step, domain);
      continue;
    }
    last_distance = distance;
    const double a = glm::dot(frame.du, e1), b = glm::dot(frame.dv, e1);
    const double c = glm::dot(frame.du, e2), d = glm::dot(frame.dv, e2);
    const double determinant = a * d - b * c;
    if (determinant == 0) return std::nullopt;  // the ray runs along the surface
    step = glm::dvec2(b * f.y - d * f.x, c * f.x - a * f.y) / determinant;
    uv = restrain(uv + step, domain);
  }
  return std::nullopt;
}

std::optional<ExactHit> exact_hit(const Optic& optic, const Ray& ray, const Hit& mesh_hit) {
  return exact_hit(optic.faces, optic.mesh, ray, mesh_hit);
}

std::optional<ExactHit> exact_hit(std::span<const Face> faces, const tessellate::OpticArrays& mesh,
                                  const Ray& ray, const Hit& mesh_hit) {
  if (!mesh_hit || mesh_hit.triangle >= mesh.triangles.size()) return std::nullopt;
  const auto& triangle = mesh.triangles[mesh_hit.triangle];
  const glm::dvec2 w = mesh_hit.barycentric;
  const glm::dvec2 start = (1 - w.x - w.y) * triangle.uv[0] + w.x * triangle.uv[1] + w.y * triangle.uv[2];
  if (auto hit = hit_face(faces[triangle.face], ray, start)) {
    hit->face = triangle.face;
    return hit;
  }
  if (faces.size() < 2) return std::nullopt;

  // Near a border the chord and the surface can be on different sides of it: try the faces that the
  // triangle's corners also belong to, from that corner's own parameters there.
  std::optional<ExactHit> nearest;
  const auto& vertices = mesh.vertices;
  std::vector<bool> tried(faces.size(), false);
  tried[triangle.face] = true;
  for (const auto& other : mesh.triangles) {
    if (tried[other.face]) continue;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3& corner = vertices[other.vertices[k]].position_mm;
      const bool shared = std::ranges::any_of(
          triangle.vertices, [&](std::uint32_t v) { return vertices[v].position_mm == corner; });
      if (!shared) continue;
      tried[other.face] = true;
      auto hit = hit_face(faces[other.face], ray, other.uv[k]);
      if (hit && (!nearest || hit->t_mm < nearest->t_mm)) {
        hit->face = other.face;
        nearest = hit;
      }
      break;
    }
  }
  return nearest;
}

}  // namespace catoptra::optics

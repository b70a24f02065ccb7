#include "optics/src/reflection_point.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/reflection.h"
#include "optics/vertex_hits.h"

namespace catoptra::optics {
namespace {

using cad_import::ParameterDomain;
using cad_import::SurfaceDerivatives;

constexpr std::size_t kStartsPerFace = 25;
constexpr int kMaxSteps = 30;
constexpr double kConverged_mm = 1e-9;

glm::dvec3 towards(const SightTarget& target, const glm::dvec3& from) {
  return target.far ? target.point_mm : glm::normalize(target.point_mm - from);
}

/// Gradient and Hessian of the path's length in (u, v).
struct PathSlope {
  double u, v, uu, uv, vv;
};

PathSlope path_slope(const SurfaceDerivatives& s, const glm::dvec3& eye, const SightTarget& target) {
  const glm::dvec3 from_eye = s.point - eye;
  const double eye_distance = glm::length(from_eye);
  const glm::dvec3 a = from_eye / eye_distance;
  glm::dvec3 b = -target.point_mm;
  double bend_target = 0;  // 1 / distance
  if (!target.far) {
    b = s.point - target.point_mm;
    bend_target = 1 / glm::length(b);
    b *= bend_target;
  }
  const double bend_eye = 1 / eye_distance;
  const auto curve = [&](const glm::dvec3& i, const glm::dvec3& j, const glm::dvec3& ij) {
    const double d = glm::dot(i, j);
    return bend_eye * (d - glm::dot(a, i) * glm::dot(a, j)) +
           bend_target * (d - glm::dot(b, i) * glm::dot(b, j)) + glm::dot(a + b, ij);
  };
  return {glm::dot(a + b, s.du), glm::dot(a + b, s.dv), curve(s.du, s.du, s.duu), curve(s.du, s.dv, s.duv),
          curve(s.dv, s.dv, s.dvv)};
}

double restrain(double x, double low, double high, double period) {
  if (period > 0) return x - period * std::floor((x - low) / period);
  const double slack = 0.5 * (high - low);
  return std::clamp(x, low - slack, high + slack);
}

}  // namespace

ReflectionFinder::ReflectionFinder(const MirrorGlass& glass, const glm::dvec3& eye_mm)
    : glass_(&glass), eye_(eye_mm), starts_(glass.optic().faces.size()) {
  std::vector<std::vector<Start>> all(starts_.size());
  for (const auto& triangle : glass.optic().mesh.triangles) {
    const auto& vertex = glass.optic().mesh.vertices[triangle.vertices[0]];
    all[std::size_t(triangle.face)].push_back(
        {vertex.position_mm, reflect(glm::normalize(vertex.position_mm - eye_), vertex.normal),
         triangle.uv[0]});
  }
  for (std::size_t face = 0; face < all.size(); ++face) {
    const std::size_t count = std::min(kStartsPerFace, all[face].size());
    for (std::size_t i = 0; i < count; ++i) starts_[face].push_back(all[face][i * all[face].size() / count]);
  }
}

bool ReflectionFinder::faces_both(const glm::dvec3& position, const glm::dvec3& normal,
                                  const SightTarget& target) const {
  return glm::dot(normal, eye_ - position) > 0 && glm::dot(normal, towards(target, position)) > 0;
}

std::optional<ReflectionPoint> ReflectionFinder::find_on(int face, const SightTarget& target) const {
  const auto& starts = starts_[std::size_t(face)];
  if (starts.empty()) return std::nullopt;
  const auto best = std::max_element(starts.begin(), starts.end(), [&](const Start& p, const Start& q) {
    return glm::dot(p.reflected, towards(target, p.position)) <
           glm::dot(q.reflected, towards(target, q.position));
  });
  const cad_import::ExactSurface& surface = *glass_->optic().faces[std::size_t(face)].surface;
  const ParameterDomain domain = surface.domain();
  const glm::dvec2 longest_step{0.5 * (domain.u_max - domain.u_min), 0.5 * (domain.v_max - domain.v_min)};
  glm::dvec2 uv = best->uv;
  for (int step = 0; step < kMaxSteps; ++step) {
    const SurfaceDerivatives s = surface.d2(uv.x, uv.y);
    const PathSlope f = path_slope(s, eye_, target);
    const double determinant = f.uu * f.vv - f.uv * f.uv;
    if (!(std::abs(determinant) > 0)) return std::nullopt;  // a caustic, or not a number
    glm::dvec2 move = -glm::dvec2(f.vv * f.u - f.uv * f.v, f.uu * f.v - f.uv * f.u) / determinant;
    const double share = std::max(std::abs(move.x) / longest_step.x, std::abs(move.y) / longest_step.y);
    if (share > 1) move /= share;
    if (glm::length(move.x * s.du + move.y * s.dv) < kConverged_mm) {
      const glm::dvec3 normal = reflecting_normal(glass_->optic(), surface.unit_normal(uv.x, uv.y));
      if (!faces_both(s.point, normal, target)) return std::nullopt;
      return ReflectionPoint{face, uv, s.point, glass_->on_glass(face, uv)};
    }
    uv = {restrain(uv.x + move.x, domain.u_min, domain.u_max, domain.u_period),
          restrain(uv.y + move.y, domain.v_min, domain.v_max, domain.v_period)};
  }
  return std::nullopt;
}

double ReflectionFinder::miss_angle(const SightTarget& target) const {
  double cosine = -1;
  for (const auto& starts : starts_)
    for (const Start& start : starts)
      cosine = std::max(cosine, glm::dot(start.reflected, towards(target, start.position)));
  return std::acos(std::min(1.0, cosine));
}

std::optional<ReflectionPoint> ReflectionFinder::find(const SightTarget& target) const {
  std::optional<ReflectionPoint> beside;
  for (int face = 0; face < int(starts_.size()); ++face) {
    const auto found = find_on(face, target);
    if (found && found->on_glass) return found;
    if (found && !beside) beside = found;
  }
  return beside;
}

}  // namespace catoptra::optics

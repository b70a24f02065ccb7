#include "cad_import/src/lens_side.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>

namespace catoptra::cad_import {
namespace {

constexpr int kPerEdge = 64;

/// Points along the use of an edge, in the sense of the loop.
std::vector<glm::dvec3> points_along(const EdgeUse& use) {
  std::vector<glm::dvec3> points;
  for (int i = 0; i <= kPerEdge; ++i) {
    const double share = double(use.reversed ? kPerEdge - i : i) / kPerEdge;
    points.push_back(use.curve->point(use.t_begin + share * (use.t_end - use.t_begin)));
  }
  return points;
}

/// On a border of the parameters (a sphere's pole, a seam) the trimming may say either: a millionth of the
/// way to the middle it is sure.
glm::dvec2 drawn_in(const glm::dvec2& uv, const ParameterDomain& d) {
  constexpr double kShare = 1e-6;
  const glm::dvec2 middle(0.5 * (d.u_min + d.u_max), 0.5 * (d.v_min + d.v_max));
  return uv + kShare * (middle - uv);
}

/// The nearest to `line` of the points around a pole, which Newton's steps cannot leave by themselves.
template <typename OffLine>
glm::dvec2 beside_pole(const ExactSurface& surface, const glm::dvec2& pole, bool along_u,
                       const OffLine& off_line) {
  constexpr int kAround = 24;
  constexpr double kShare = 1e-3;
  const ParameterDomain d = surface.domain();
  glm::dvec2 best = pole;
  double nearest = 1e300;
  for (int k = 0; k < kAround; ++k) {
    glm::dvec2 uv = pole + kShare * (glm::dvec2(0.5 * (d.u_min + d.u_max), 0.5 * (d.v_min + d.v_max)) - pole);
    if (along_u)
      uv.x = d.u_min + (d.u_max - d.u_min) * k / kAround;
    else
      uv.y = d.v_min + (d.v_max - d.v_min) * k / kAround;
    if (const double distance = glm::length(off_line(surface.point(uv.x, uv.y))); distance < nearest) {
      nearest = distance;
      best = uv;
    }
  }
  return best;
}

/// Gauss-Newton on the distance of `off_line` from zero, down to `precision_mm`.
template <typename OffLine>
std::optional<SidePoint> find_on_face(const Face& face, const glm::dvec2& start, const glm::dvec3& axis,
                                      double precision_mm, const OffLine& off_line) {
  SidePoint at{&face, start, {0, 0, 0}};
  bool left_pole = false;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const SurfaceFrame f = face.surface->d1(at.uv.x, at.uv.y);
    at.position = f.point;
    const glm::dvec3 miss = off_line(f.point);
    if (glm::length(miss) < precision_mm) {
      if (face.trim->contains(at.uv.x, at.uv.y)) return at;
      at.uv = drawn_in(at.uv, face.surface->domain());
      return face.trim->contains(at.uv.x, at.uv.y) ? std::optional(at) : std::nullopt;
    }
    const glm::dvec3 du = f.du - glm::dot(f.du, axis) * axis, dv = f.dv - glm::dot(f.dv, axis) * axis;
    const double a = glm::dot(du, du), b = glm::dot(du, dv), c = glm::dot(dv, dv);
    const double determinant = a * c - b * b;
    if (!(determinant > 1e-14 * a * c)) {
      if (left_pole) return std::nullopt;
      left_pole = true;
      at.uv = beside_pole(*face.surface, at.uv, a < c, off_line);
      continue;
    }
    const double p = glm::dot(du, miss), q = glm::dot(dv, miss);
    at.uv -= glm::dvec2(c * p - b * q, a * q - b * p) / determinant;
  }
  return std::nullopt;
}

}  // namespace

glm::dvec3 area_vector(const Face& face) {
  glm::dvec3 sum{0};
  for (const TrimLoop& loop : face.loops)
    for (const EdgeUse& use : loop.edges) {
      if (use.degenerate || !use.curve) continue;
      const std::vector<glm::dvec3> points = points_along(use);
      for (std::size_t i = 1; i < points.size(); ++i) sum += glm::cross(points[i - 1], points[i]);
    }
  return sum * (0.5 * face.surface->orientation());
}

LensSide::LensSide(std::span<const Face> faces) : faces_(faces) {
  std::map<int, int> uses;  // of an edge by the faces of this side: two are a seam inside it
  for (const Face& face : faces)
    for (const TrimLoop& loop : face.loops)
      for (const EdgeUse& use : loop.edges) ++uses[use.edge];
  for (const Face& face : faces) {
    area_vector_ += cad_import::area_vector(face);
    for (const TrimLoop& loop : face.loops)
      for (const EdgeUse& use : loop.edges)
        if (uses[use.edge] == 1 && !use.degenerate && use.curve)
          for (const glm::dvec3& p : points_along(use)) boundary_.push_back(p);
  }
  // The middle of the box, which does not depend on how the points are spread along the edges.
  BoundingBox box;
  for (const glm::dvec3& p : boundary_) {
    box.min = glm::min(box.min, p);
    box.max = glm::max(box.max, p);
  }
  if (box.empty()) return;
  middle_ = 0.5 * (box.min + box.max);
  for (const glm::dvec3& p : boundary_) extent_ = std::max(extent_, glm::distance(p, middle_));
}

glm::dvec3 LensSide::inner_point() const {
  constexpr int kSteps = 12;
  glm::dvec3 sum{0};
  int points = 0;
  for (const Face& face : faces_) {
    const ParameterDomain d = face.surface->domain();
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; j <= kSteps; ++j) {
        const double u = d.u_min + (d.u_max - d.u_min) * i / kSteps;
        const double v = d.v_min + (d.v_max - d.v_min) * j / kSteps;
        if (!face.trim->contains(u, v)) continue;
        sum += face.surface->point(u, v);
        ++points;
      }
  }
  return points > 0 ? sum / double(points) : middle_;
}

std::optional<SidePoint> LensSide::on_face(const Face& face, const glm::dvec3& point,
                                           const glm::dvec3& axis) const {
  const auto off_line = [&](const glm::dvec3& p) { return p - point - glm::dot(p - point, axis) * axis; };
  const ParameterDomain d = face.surface->domain();
  constexpr int kStarts = 12;
  // The whole surface may meet the line twice, as a ball does: points of the face go first.
  struct Start {
    glm::dvec2 uv{0};
    double distance = 1e300;
  } on_the_face, anywhere;
  for (int i = 0; i <= kStarts; ++i)
    for (int j = 0; j <= kStarts; ++j) {
      const glm::dvec2 uv(d.u_min + (d.u_max - d.u_min) * i / kStarts,
                          d.v_min + (d.v_max - d.v_min) * j / kStarts);
      const double distance = glm::length(off_line(face.surface->point(uv.x, uv.y)));
      if (distance < anywhere.distance) anywhere = {uv, distance};
      if (distance < on_the_face.distance && face.trim->contains(uv.x, uv.y)) on_the_face = {uv, distance};
    }
  for (const Start& start : {on_the_face, anywhere})
    if (start.distance < 1e300)
      if (const auto found = find_on_face(face, start.uv, axis, 1e-10 * (1 + extent_), off_line))
        return found;
  return std::nullopt;
}

std::optional<SidePoint> LensSide::on_line(const glm::dvec3& point, const glm::dvec3& axis) const {
  for (const Face& face : faces_)
    if (const auto found = on_face(face, point, axis)) return found;
  return std::nullopt;
}

std::optional<SidePoint> LensSide::vertex(const SidePoint& from, const glm::dvec3& axis) const {
  SidePoint at = from;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const SurfaceDerivatives s = at.face->surface->d2(at.uv.x, at.uv.y);
    at.position = s.point;
    const glm::dvec3 off = s.point - from.position;
    if (glm::length(off - glm::dot(off, axis) * axis) > 0.25 * extent_) return std::nullopt;
    const double a = glm::dot(s.duu, axis), b = glm::dot(s.duv, axis), c = glm::dot(s.dvv, axis);
    const double p = glm::dot(s.du, axis), q = glm::dot(s.dv, axis);
    const double determinant = a * c - b * b;
    // A curvature of 1e-7 / mm (R 10 km) has no vertex worth the name.
    const double area = glm::length(glm::cross(s.du, s.dv));
    if (!(std::abs(determinant) > 1e-14 * area * area)) return std::nullopt;
    const glm::dvec2 change = glm::dvec2(c * p - b * q, a * q - b * p) / determinant;
    at.uv -= change;
    if (glm::length(change.x * s.du + change.y * s.dv) < 1e-9) {
      at.position = at.face->surface->point(at.uv.x, at.uv.y);
      return at;
    }
  }
  return std::nullopt;
}

/// The squared distance of the two points is stationary there: its gradient and Hessian in (u, v, s, t).
std::optional<CommonNormal> common_normal(SidePoint front, SidePoint back, double reach_mm) {
  const glm::dvec3 front_start = front.position, back_start = back.position;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const SurfaceDerivatives f = front.face->surface->d2(front.uv.x, front.uv.y);
    const SurfaceDerivatives b = back.face->surface->d2(back.uv.x, back.uv.y);
    front.position = f.point;
    back.position = b.point;
    if (glm::distance(f.point, front_start) > reach_mm || glm::distance(b.point, back_start) > reach_mm)
      return std::nullopt;
    const glm::dvec3 apart = f.point - b.point;
    const glm::dvec3 tangents[4]{f.du, f.dv, -b.du, -b.dv};
    glm::dmat4 hessian;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) hessian[i][k] = glm::dot(tangents[i], tangents[k]);
    hessian[0][0] += glm::dot(f.duu, apart);
    hessian[0][1] = hessian[1][0] += glm::dot(f.duv, apart);
    hessian[1][1] += glm::dot(f.dvv, apart);
    hessian[2][2] -= glm::dot(b.duu, apart);
    hessian[2][3] = hessian[3][2] -= glm::dot(b.duv, apart);
    hessian[3][3] -= glm::dot(b.dvv, apart);
    const glm::dvec4 gradient(glm::dot(tangents[0], apart), glm::dot(tangents[1], apart),
                              glm::dot(tangents[2], apart), glm::dot(tangents[3], apart));
    const glm::dvec4 change = glm::inverse(hessian) * gradient;
    const double moved = glm::length(change.x * f.du + change.y * f.dv);
    if (!std::isfinite(moved)) return std::nullopt;
    front.uv -= glm::dvec2(change.x, change.y);
    back.uv -= glm::dvec2(change.z, change.w);
    if (moved > 1e-9) continue;
    const bool on_both =
        front.face->trim->contains(front.uv.x, front.uv.y) && back.face->trim->contains(back.uv.x, back.uv.y);
    return on_both ? std::optional(CommonNormal{front, back}) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace catoptra::cad_import

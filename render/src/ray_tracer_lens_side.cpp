#include "render/src/ray_tracer_lens_side.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/exact_hit.h"
#include "render/src/shading_vector_clones.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = LaneVectors::kLanes;

/// Distance in mm between ray and surface before the last step, below which that step ends on the surface to
/// 1e-12 mm and the normal taken before it is right to 5e-9 rad, on surfaces with a radius of 40 mm or more:
/// a tenth of what a float holds of a unit direction.
constexpr double kConverged = 2e-7;

/// Weight of the corners on an outline up to which a hit on the mesh is safely within the face. The mesh's
/// chords leave the outline, and its triangles the surface, by some hundredths of a triangle.
constexpr double kSafeWeight = 0.9;

struct Vec {
  double x, y, z;
};
[[gnu::always_inline]] inline Vec load(const LaneVectors& v, int i) {
  return {v.x[i], v.y[i], v.z[i]};
}
[[gnu::always_inline]] inline void store(const Vec& v, int i, LaneVectors& to) {
  to.x[i] = v.x;
  to.y[i] = v.y;
  to.z[i] = v.z;
}
/// Stores where `chosen`, by arithmetic that every lane does alike.
[[gnu::always_inline]] inline void store_if(bool chosen, const Vec& v, int i, LaneVectors& to) {
  to.x[i] = chosen ? v.x : to.x[i];
  to.y[i] = chosen ? v.y : to.y[i];
  to.z[i] = chosen ? v.z : to.z[i];
}
[[gnu::always_inline]] inline Vec operator+(const Vec& a, const Vec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[gnu::always_inline]] inline Vec operator-(const Vec& a, const Vec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[gnu::always_inline]] inline Vec operator*(double s, const Vec& a) {
  return {s * a.x, s * a.y, s * a.z};
}
[[gnu::always_inline]] inline double dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec vec(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

/// A patch in single pieces.
struct PatchFrame {
  Vec corner, g1, g2, n;
  double c[SurfacePatch::kCoefficients];
};

/// All lanes against one patch: Newton in the distance alone, from the mesh's hit, as for mirrors
/// (hit_patch()), and what the beams' changes become in the tangent plane there.
CATOPTRA_VECTOR_CLONES void meet_patch(const PatchFrame& patch, const BeamLanes& beams,
                                       const double (&start)[kLanes], const double (&chosen)[kLanes],
                                       MetLanes& met, double (&done)[kLanes]) {
  const PatchFrame p = patch;  // a copy, so that no store can be thought to change it
  const double* c = p.c;
  for (int i = 0; i < kLanes; ++i) {
    const Vec from = load(beams.point, i), d = load(beams.direction, i), offset = from - p.corner;
    const double ex = dot(p.g1, offset), ey = dot(p.g2, offset), ez = dot(p.n, offset);
    const double dx = dot(p.g1, d), dy = dot(p.g2, d), dz = dot(p.n, d), t0 = start[i];
    const PatchHeight h0 = patch_height_cubic(c, ex + t0 * dx, ey + t0 * dy);
    const double rate = dz - h0.dx * dx - h0.dy * dy;
    const double t1 = t0 - ((ez + t0 * dz) - h0.value) / rate;
    const double t2 = t1 - ((ez + t1 * dz) - patch_value(c, ex + t1 * dx, ey + t1 * dy)) / rate;
    const double x = ex + t2 * dx, y = ey + t2 * dy;
    const PatchHeight h = patch_height(c, x, y);
    const double miss = (ez + t2 * dz) - h.value, t = t2 - miss / (dz - h.dx * dx - h.dy * dy);
    const Vec raw = p.n - h.dx * p.g1 - h.dy * p.g2;
    const double inverse = 1 / std::sqrt(dot(raw, raw));
    const Vec n = inverse * raw;
    const double per_cosine = 1 / dot(n, d);
    const Bend bend = patch_bend(c, x, y);
    const bool use = (chosen[i] != 0) & (std::abs(miss) < kConverged);
    done[i] = use ? 1.0 : done[i];
    met.distance[i] = use ? t : met.distance[i];
    store_if(use, from + t * d, i, met.point);
    store_if(use, n, i, met.normal);
    const auto change = [&](const LaneVectors& point, const LaneVectors& direction, LaneVectors& met_point,
                            LaneVectors& met_normal) __attribute__((always_inline)) {
      const Vec moved = load(point, i) + t * load(direction, i);
      const Vec in_plane = moved - (dot(n, moved) * per_cosine) * d;
      const double b1 = dot(p.g1, in_plane), b2 = dot(p.g2, in_plane);
      const Vec turned = -(bend.xx * b1 + bend.xy * b2) * p.g1 - (bend.xy * b1 + bend.yy * b2) * p.g2;
      store_if(use, in_plane, i, met_point);
      store_if(use, inverse * (turned - dot(n, turned) * n), i, met_normal);
    };
    change(beams.point_right, beams.direction_right, met.point_right, met.normal_right);
    change(beams.point_down, beams.direction_down, met.point_down, met.normal_down);
  }
}

}  // namespace

CATOPTRA_VECTOR_CLONES void aim_beams(const CameraRays& camera, const double (&column)[kLanes],
                                      const double (&row)[kLanes], double (&stretch)[kLanes],
                                      BeamLanes& beams) {
  const Vec eye{camera.eye_mm.x, camera.eye_mm.y, camera.eye_mm.z},
      corner{camera.corner.x, camera.corner.y, camera.corner.z};
  const Vec right{camera.dx.x, camera.dx.y, camera.dx.z}, down{camera.dy.x, camera.dy.y, camera.dy.z};
  for (int i = 0; i < kLanes; ++i) {
    const Vec way = corner + column[i] * right + row[i] * down;
    const double length = std::sqrt(dot(way, way)), inverse = 1 / length;
    const Vec d = inverse * way;
    stretch[i] = length;
    store(eye, i, beams.point);
    store(d, i, beams.direction);
    store({0, 0, 0}, i, beams.point_right);
    store({0, 0, 0}, i, beams.point_down);
    store(inverse * (right - dot(d, right) * d), i, beams.direction_right);
    store(inverse * (down - dot(d, down) * d), i, beams.direction_down);
  }
}

// out = eta d - mu n with mu = eta d.n - out.n.
CATOPTRA_VECTOR_CLONES void refract_beams(const BeamLanes& beams, const MetLanes& met,
                                          const double (&eta)[kLanes], RefractedBeams& result) {
  BeamLanes& out = result.beams;
  for (int i = 0; i < kLanes; ++i) {
    const Vec d = load(beams.direction, i), n = load(met.normal, i);
    const double e = eta[i], cos_in = dot(d, n), square = 1 - e * e * (1 - cos_in * cos_in);
    const double root = std::sqrt(square > 0 ? square : 0), ci = std::abs(cos_in);
    const double cos_out = cos_in < 0 ? -root : root;
    const double mu = e * cos_in - cos_out, mu_slope = e - e * e * cos_in / cos_out;
    const double s = (e * ci - root) / (e * ci + root), p = (ci - e * root) / (ci + e * root);
    result.transmittance[i] = 1 - 0.5 * (s * s + p * p);
    result.possible[i] = square >= 0;
    store(load(met.point, i), i, out.point);
    store(load(met.point_right, i), i, out.point_right);
    store(load(met.point_down, i), i, out.point_down);
    store(e * d - mu * n, i, out.direction);
    const Vec turn_right = load(beams.direction_right, i), turn_down = load(beams.direction_down, i);
    const Vec normal_right = load(met.normal_right, i), normal_down = load(met.normal_down, i);
    const double cos_right = dot(turn_right, n) + dot(d, normal_right),
                 cos_down = dot(turn_down, n) + dot(d, normal_down);
    store(e * turn_right - mu * normal_right - (mu_slope * cos_right) * n, i, out.direction_right);
    store(e * turn_down - mu * normal_down - (mu_slope * cos_down) * n, i, out.direction_down);
  }
}

// r = d - 2 (d . n) n.
CATOPTRA_VECTOR_CLONES void reflect_beams(const BeamLanes& beams, const MetLanes& met, BeamLanes& out) {
  for (int i = 0; i < kLanes; ++i) {
    const Vec d = load(beams.direction, i), n = load(met.normal, i);
    const double twice = 2 * dot(d, n);
    store(load(met.point, i), i, out.point);
    store(load(met.point_right, i), i, out.point_right);
    store(load(met.point_down, i), i, out.point_down);
    store(d - twice * n, i, out.direction);
    const Vec turn_right = load(beams.direction_right, i), turn_down = load(beams.direction_down, i);
    const Vec normal_right = load(met.normal_right, i), normal_down = load(met.normal_down, i);
    const double twice_right = 2 * (dot(turn_right, n) + dot(d, normal_right)),
                 twice_down = 2 * (dot(turn_down, n) + dot(d, normal_down));
    store(turn_right - twice * normal_right - twice_right * n, i, out.direction_right);
    store(turn_down - twice * normal_down - twice_down * n, i, out.direction_down);
  }
}

CATOPTRA_VECTOR_CLONES void set_areas(const BeamLanes& beams, const float (&way_mm)[kLanes],
                                      float (&area_mm2)[kLanes]) {
  for (int i = 0; i < kLanes; ++i) {
    const double way = way_mm[i];
    const Vec right = load(beams.point_right, i) + way * load(beams.direction_right, i),
              down = load(beams.point_down, i) + way * load(beams.direction_down, i);
    const Vec across{right.y * down.z - right.z * down.y, right.z * down.x - right.x * down.z,
                     right.x * down.y - right.y * down.x};
    area_mm2[i] = float(std::abs(dot(across, load(beams.direction, i))));
  }
}

void meet_vertex(const tessellate::OpticVertex& vertex, const BeamLanes& beams, int lane, MetLanes& met) {
  const glm::dvec3 d = beams.direction.at(lane), n = vertex.normal,
                   direction2 = glm::cross(n, vertex.direction1);
  const double distance = glm::dot(vertex.position_mm - beams.point.at(lane), d),
               per_cosine = 1 / glm::dot(n, d);
  met.distance[lane] = distance;
  met.point.set(lane, vertex.position_mm);
  met.normal.set(lane, n);
  const auto change = [&](const LaneVectors& point, const LaneVectors& direction, LaneVectors& met_point,
                          LaneVectors& met_normal) {
    const glm::dvec3 moved = point.at(lane) + distance * direction.at(lane);
    const glm::dvec3 in_plane = moved - (glm::dot(n, moved) * per_cosine) * d;
    met_point.set(lane, in_plane);
    met_normal.set(lane, vertex.k1 * glm::dot(in_plane, vertex.direction1) * vertex.direction1 +
                             vertex.k2 * glm::dot(in_plane, direction2) * direction2);
  };
  change(beams.point_right, beams.direction_right, met.point_right, met.normal_right);
  change(beams.point_down, beams.direction_down, met.point_down, met.normal_down);
}

tessellate::OpticVertex exact_side_point(const optics::LensSideView& side, const optics::ExactHit& hit) {
  const auto curvature = side.faces[std::size_t(hit.face)].surface->principal_curvatures(hit.uv.x, hit.uv.y);
  return {hit.position_mm, hit.normal, curvature.k1, curvature.k2, curvature.direction1, hit.face, hit.uv};
}

tessellate::OpticVertex exact_side_point(const optics::LensSideView& side, const optics::Ray& ray,
                                         const optics::Hit& mesh_hit) {
  if (const auto hit = optics::exact_hit(side.faces, *side.mesh, ray, mesh_hit))
    return exact_side_point(side, *hit);
  const tessellate::OpticTriangle& triangle = side.mesh->triangles[mesh_hit.triangle];
  const auto corner = [&](std::size_t k) -> const tessellate::OpticVertex& {
    return side.mesh->vertices[triangle.vertices[k]];
  };
  const double u = mesh_hit.barycentric.x, v = mesh_hit.barycentric.y, w = 1 - u - v;
  tessellate::OpticVertex point = corner(w >= u && w >= v ? 0 : u >= v ? 1 : 2);
  point.position_mm = w * corner(0).position_mm + u * corner(1).position_mm + v * corner(2).position_mm;
  point.normal = glm::normalize(w * corner(0).normal + u * corner(1).normal + v * corner(2).normal);
  return point;
}

LensSidePatches::LensSidePatches(const optics::LensSideView& side)
    : side_(side), patches_(side.faces, *side.mesh), outline_corners_(side.mesh->triangles.size(), 0) {
  // An edge within a face belongs to two of its triangles. A mesh may be wider than its faces: then the
  // triangles whose corners are trimmed away are left out too.
  struct Edge {
    std::uint64_t ends;
    int face;
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  for (const auto& t : side.mesh->triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t.vertices[k], t.vertices[(k + 1) % 3]);
      edges.push_back({std::uint64_t(a) << 32 | b, t.face});
    }
  std::ranges::sort(edges);
  std::vector<char> on_outline(side.mesh->vertices.size(), 0);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (k + 1 < edges.size() && edges[k] == edges[k + 1]) {
      ++k;
      continue;
    }
    on_outline[edges[k].ends >> 32] = on_outline[edges[k].ends & 0xffffffffu] = 1;
  }
  for (std::size_t i = 0; i < outline_corners_.size(); ++i) {
    const auto& t = side.mesh->triangles[i];
    const auto& trim = side.faces[std::size_t(t.face)].trim;
    for (std::size_t k = 0; k < 3; ++k) {
      if (on_outline[t.vertices[k]]) outline_corners_[i] |= std::uint8_t(1u << k);
      if (trim && !trim->contains(t.uv[k].x, t.uv[k].y)) outline_corners_[i] |= 7u;
    }
  }
}

const SurfacePatch* LensSidePatches::patch_within(std::uint32_t triangle, double u, double v) const {
  const std::uint8_t corners = outline_corners_[triangle];
  const double weight =
      (corners & 1u ? 1 - u - v : 0.0) + (corners & 2u ? u : 0.0) + (corners & 4u ? v : 0.0);
  if (weight > kSafeWeight) return nullptr;
  const SurfacePatch* patch = patches_.patch_of(triangle, u, v);
  return patch->valid ? patch : nullptr;
}

void LensSidePatches::meet(const BeamLanes& beams, const MeshHits& hits, MetLanes& met,
                           bool (&solved)[kLanes]) const {
  const SurfacePatch* patch[kLanes];
  double chosen[kLanes], done[kLanes] = {};
  for (int i = 0; i < kLanes; ++i)
    patch[i] = hits.active[i] ? patch_within(hits.triangle[i], hits.u[i], hits.v[i]) : nullptr;
  // Neighbouring pixels mostly share a patch: one pass of all lanes for each that occurs.
  for (int first = 0; first < kLanes; ++first) {
    const SurfacePatch* const shared = patch[first];
    if (!shared) continue;
    for (int i = 0; i < kLanes; ++i) {
      chosen[i] = patch[i] == shared;
      if (patch[i] == shared) patch[i] = nullptr;
    }
    PatchFrame frame{vec(shared->corner), vec(shared->g1), vec(shared->g2), vec(shared->normal), {}};
    std::copy(std::begin(shared->c), std::end(shared->c), frame.c);
    meet_patch(frame, beams, hits.distance, chosen, met, done);
  }
  for (int i = 0; i < kLanes; ++i) solved[i] = done[i] != 0;
}

void LensSidePatches::meet_all(const BeamLanes& beams, const MeshHits& hits, MetLanes& met) const {
  bool solved[kLanes];
  meet(beams, hits, met, solved);
  for (int i = 0; i < kLanes; ++i) {
    if (!hits.active[i] || (solved[i] && met.distance[i] > 0)) continue;
    const optics::Hit hit{hits.distance[i], 0, hits.triangle[i], {double(hits.u[i]), double(hits.v[i])}};
    meet_vertex(exact_side_point(side_, {beams.point.at(i), beams.direction.at(i)}, hit), beams, i, met);
  }
}

}  // namespace catoptra::render

#include "render/src/ray_tracer_exact.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/exact_hit.h"
#include "optics/reflection.h"
#include "render/src/shading_vector_clones.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = MirrorLanes::kLanes;

/// What reflection does to a spherical wave from the eye at `distance` (generalised Coddington for a mirror;
/// Landgrave and Moya-Cessa 1996). With the surface's curvatures a in the plane of incidence, b across it,
/// their mixed term m and the incidence cosine c, the reflected wavefront is [w + 2 a / c, 2 m; 2 m, w + 2 b
/// c], w = 1 / distance.
struct Wave {
  double sum, product;  ///< of its principal curvatures
};

/// `across`: b times `squared`, the squared length of the vector in whose direction it was taken; `cosine`:
/// of ray and normal, > 0 where the ray comes from behind; `curvature_sum`: a + b; `gaussian`: a b - m^2.
[[gnu::always_inline]] inline Wave reflected_wave(double across, double squared, double cosine,
                                                  double curvature_sum, double gaussian, double distance) {
  const double c = std::abs(cosine) > 1e-6 ? std::abs(cosine) : 1e-6;
  const double b = squared > 1e-9 ? across / squared : 0.5 * curvature_sum, a = curvature_sum - b;
  const double w = 1 / distance, added = (cosine > 0 ? -2 : 2) * (a / c + b * c);
  return {2 * w + added, w * w + w * added + 4 * gaussian};
}

/// A patch and an eye as the rays' arithmetic needs them.
struct PatchRays {
  glm::dvec3 eye_mm;
  glm::dvec3 eye;                  ///< in the patch's coordinates (b1, b2, height)
  glm::dvec3 g1, g2, n, g1n, g2n;  ///< dual basis; g1 x n, g2 x n
  double g11, g12, g22;            ///< products of g1 and g2
  const double* c;
};

struct alignas(64) PatchHits {
  MirrorRays rays;
  double miss[kLanes];  ///< mm between ray and surface before the last step
};

/// Distance in mm between ray and surface before the last step, below which that step ends on the surface to
/// 1e-12 mm and the normal taken before it is right to 1e-9 rad (on surfaces with a radius of 200 mm or
/// more).
constexpr double kConverged = 2e-7;

/// All lanes against one patch: Newton in the distance t alone, from the mesh's hit. The error squares from
/// the mesh's chord height (0.1 mm) to 1e-5, 1e-9 and less, so that the first step can do with cubic terms,
/// and the second with the first one's slopes. Then r = d - 2 (d . n) n / n^2 at the polynomial's own normal.
CATOPTRA_VECTOR_CLONES void hit_patch(const PatchRays& p, const MirrorLanes& lanes, PatchHits& hits) {
  const double eye_x = p.eye.x, eye_y = p.eye.y, eye_z = p.eye.z;
  const glm::dvec3 eye_mm = p.eye_mm, g1 = p.g1, g2 = p.g2, n = p.n, g1n = p.g1n, g2n = p.g2n;
  const double g11 = p.g11, g12 = p.g12, g22 = p.g22;
  double c[SurfacePatch::kCoefficients];  // a copy, so that no store into `hits` can be thought to change it
  std::copy(p.c, p.c + SurfacePatch::kCoefficients, c);
  for (int i = 0; i < kLanes; ++i) {
    const double wx = lanes.direction_x[i], wy = lanes.direction_y[i], wz = lanes.direction_z[i];
    const double dx = g1.x * wx + g1.y * wy + g1.z * wz, dy = g2.x * wx + g2.y * wy + g2.z * wz;
    const double dz = n.x * wx + n.y * wy + n.z * wz;
    const double t0 = lanes.start[i];
    const PatchHeight h0 = patch_height_cubic(c, eye_x + t0 * dx, eye_y + t0 * dy);
    const double rate = dz - h0.dx * dx - h0.dy * dy;
    const double t1 = t0 - ((eye_z + t0 * dz) - h0.value) / rate;
    const double t2 = t1 - ((eye_z + t1 * dz) - patch_value(c, eye_x + t1 * dx, eye_y + t1 * dy)) / rate;
    const PatchHeight h = patch_height(c, eye_x + t2 * dx, eye_y + t2 * dy);
    const double miss = (eye_z + t2 * dz) - h.value, t = t2 - miss / (dz - h.dx * dx - h.dy * dy);
    const double nx = n.x - h.dx * g1.x - h.dy * g2.x, ny = n.y - h.dx * g1.y - h.dy * g2.y;
    const double nz = n.z - h.dx * g1.z - h.dy * g2.z;
    const double squared = nx * nx + ny * ny + nz * nz, along = wx * nx + wy * ny + wz * nz;
    const double twice = 2 * along / squared;
    hits.miss[i] = miss;
    hits.rays.distance[i] = t;
    hits.rays.surface_x[i] = eye_mm.x + t * wx;
    hits.rays.surface_y[i] = eye_mm.y + t * wy;
    hits.rays.surface_z[i] = eye_mm.z + t * wz;
    hits.rays.reflected_x[i] = wx - twice * nx;
    hits.rays.reflected_y[i] = wy - twice * ny;
    hits.rays.reflected_z[i] = wz - twice * nz;
    // Components of n x d in (b1, b2): the normal curvature in that direction, times its squared length.
    const double s1 = g1n.x * wx + g1n.y * wy + g1n.z * wz, s2 = g2n.x * wx + g2n.y * wy + g2n.z * wz;
    const Bend bend = patch_bend(c, eye_x + t2 * dx, eye_y + t2 * dy);
    const double across = -(bend.xx * s1 * s1 + 2 * bend.xy * s1 * s2 + bend.yy * s2 * s2);
    const double sum = -(bend.xx * g11 + 2 * bend.xy * g12 + bend.yy * g22);
    const double gaussian = (bend.xx * bend.yy - bend.xy * bend.xy) * (g11 * g22 - g12 * g12);
    const Wave wave = reflected_wave(across, 1 - dz * dz, along / std::sqrt(squared), sum, gaussian, t);
    hits.rays.wave_sum[i] = wave.sum;
    hits.rays.wave_product[i] = wave.product;
  }
}

}  // namespace

ExactMirror::ExactMirror(const optics::Optic& optic) : optic_(optic), patches_(optic.faces, optic.mesh) {}

void ExactMirror::reflect(const glm::dvec3& eye_mm, MirrorLanes& lanes) const {
  const SurfacePatch* patch[kLanes];
  for (int i = 0; i < kLanes; ++i)
    patch[i] = lanes.active[i] ? patches_.patch_of(lanes.triangle[i], lanes.u[i], lanes.v[i]) : nullptr;
  // Neighbouring pixels mostly share a patch: one pass of all lanes for each that occurs.
  bool chosen[kLanes], solved[kLanes];
  for (int first = 0; first < kLanes; ++first) {
    if (!patch[first]) continue;
    const SurfacePatch* const shared = patch[first];
    for (int i = 0; i < kLanes; ++i) {
      chosen[i] = patch[i] == shared;
      solved[i] = false;
      if (chosen[i]) patch[i] = nullptr;
    }
    if (shared->valid) reflect_on_patch(*shared, eye_mm, chosen, lanes, solved);
    for (int i = first; i < kLanes; ++i)
      if (chosen[i] && !solved[i]) reflect_by_newton(eye_mm, i, lanes);
  }
}

void ExactMirror::reflect_on_patch(const SurfacePatch& patch, const glm::dvec3& eye_mm,
                                   const bool (&chosen)[kLanes], MirrorLanes& lanes,
                                   bool (&solved)[kLanes]) const {
  const glm::dvec3 offset = eye_mm - patch.corner;
  const PatchRays rays{
      eye_mm,
      {glm::dot(patch.g1, offset), glm::dot(patch.g2, offset), glm::dot(patch.normal, offset)},
      patch.g1,
      patch.g2,
      patch.normal,
      glm::cross(patch.g1, patch.normal),
      glm::cross(patch.g2, patch.normal),
      glm::dot(patch.g1, patch.g1),
      glm::dot(patch.g1, patch.g2),
      glm::dot(patch.g2, patch.g2),
      patch.c};
  PatchHits hits;
  hit_patch(rays, lanes, hits);
  bool all = true;
  for (int i = 0; i < kLanes; ++i) {
    solved[i] = chosen[i] && std::abs(hits.miss[i]) < kConverged && hits.rays.distance[i] > 0;
    all = all && solved[i];
  }
  if (all) {
    lanes.out = hits.rays;
    return;
  }
  for (int i = 0; i < kLanes; ++i)
    if (solved[i]) lanes.out.copy_lane(hits.rays, i);
}

void ExactMirror::reflect_by_newton(const glm::dvec3& eye_mm, int lane, MirrorLanes& lanes) const {
  const glm::dvec3 direction(lanes.direction_x[lane], lanes.direction_y[lane], lanes.direction_z[lane]);
  const tessellate::OpticTriangle& triangle = optic_.mesh.triangles[lanes.triangle[lane]];
  const auto vertex = [&](std::size_t k) -> const tessellate::OpticVertex& {
    return optic_.mesh.vertices[triangle.vertices[k]];
  };
  const double u = lanes.u[lane], v = lanes.v[lane], w = 1 - u - v;
  glm::dvec3 position, normal;
  const optics::Hit mesh_hit{0, 0, lanes.triangle[lane], {u, v}};
  if (const auto hit = optics::exact_hit(optic_, {eye_mm, direction}, mesh_hit)) {
    position = hit->position_mm;
    normal = hit->normal;
  } else {
    // The mesh reaches past the trimmed face by less than its chord error: here the mesh itself is the
    // mirror.
    position = w * vertex(0).position_mm + u * vertex(1).position_mm + v * vertex(2).position_mm;
    normal = glm::normalize(w * vertex(0).normal + u * vertex(1).normal + v * vertex(2).normal);
  }
  const glm::dvec3 reflected = optics::reflect(direction, normal), across = glm::cross(normal, direction);
  const double distance = glm::length(position - eye_mm);
  // Curvatures of the nearest vertex.
  const tessellate::OpticVertex& near = vertex(w >= u && w >= v ? 0 : u >= v ? 1 : 2);
  const double c1 = glm::dot(near.direction1, across), squared = glm::dot(across, across);
  const Wave wave =
      reflected_wave(near.k1 * c1 * c1 + near.k2 * (squared - c1 * c1), squared, glm::dot(normal, direction),
                     near.k1 + near.k2, near.k1 * near.k2, distance);
  MirrorRays& out = lanes.out;
  out.surface_x[lane] = position.x;
  out.surface_y[lane] = position.y;
  out.surface_z[lane] = position.z;
  out.reflected_x[lane] = reflected.x;
  out.reflected_y[lane] = reflected.y;
  out.reflected_z[lane] = reflected.z;
  out.distance[lane] = distance;
  out.wave_sum[lane] = wave.sum;
  out.wave_product[lane] = wave.product;
}

}  // namespace catoptra::render

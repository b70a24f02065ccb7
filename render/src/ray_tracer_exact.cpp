#include "render/src/ray_tracer_exact.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "optics/exact_hit.h"
#include "optics/reflection.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = MirrorLanes::kLanes;
constexpr double kEnlarged =
    1.15;  // samples reach this far beyond the triangle: exact hits may lie just outside

/// Compiled for wider vector units too, the best of which is chosen when the program is loaded. The results
/// are the same on all: no operation is contracted or reordered. (Sanitizers cannot run the code that
/// chooses.)
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define CATOPTRA_VECTOR_CLONES [[gnu::target_clones("default", "avx2", "avx512f")]]
#else
#define CATOPTRA_VECTOR_CLONES
#endif

struct Height {
  double value, dx, dy;
};

/// Height and slopes at (x, y) by Horner's scheme in both variables; without loops, so that the compiler can
/// run it for several rays at once. `c` by power of y: 6, 5, 4, 3, 2, 1 coefficients.
[[gnu::always_inline]] inline Height evaluate(const double* c, double x, double y) {
  const double p4 = c[18] + x * c[19];
  const double p3 = c[15] + x * (c[16] + x * c[17]), p3x = c[16] + x * (2 * c[17]);
  const double p2 = c[11] + x * (c[12] + x * (c[13] + x * c[14])),
               p2x = c[12] + x * (2 * c[13] + x * (3 * c[14]));
  const double p1 = c[6] + x * (c[7] + x * (c[8] + x * (c[9] + x * c[10])));
  const double p1x = c[7] + x * (2 * c[8] + x * (3 * c[9] + x * (4 * c[10])));
  const double p0 = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  const double p0x = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * (5 * c[5]))));
  return {p0 + y * (p1 + y * (p2 + y * (p3 + y * (p4 + y * c[20])))),
          p0x + y * (p1x + y * (p2x + y * (p3x + y * c[19]))),
          p1 + y * (2 * p2 + y * (3 * p3 + y * (4 * p4 + y * (5 * c[20]))))};
}

/// What reflection does to a spherical wave from the eye at `distance` (generalised Coddington for a mirror;
/// Landgrave and Moya-Cessa 1996). With the surface's curvatures a in the plane of incidence, b across it,
/// their mixed term m and the incidence cosine c, the reflected wavefront is [w + 2 a / c, 2 m; 2 m, w + 2 b
/// c], w = 1 / distance.
struct Wave {
  double sum, product;  ///< of its principal curvatures
};

/// `across`: b sin^2 of incidence; `cosine`: of ray and normal, > 0 where the ray comes from behind;
/// `curvature_sum`: a + b; `gaussian`: a b - m^2.
[[gnu::always_inline]] inline Wave reflected_wave(double across, double cosine, double curvature_sum,
                                                  double gaussian, double distance) {
  const double sine2 = 1 - cosine * cosine, c = std::abs(cosine) > 1e-6 ? std::abs(cosine) : 1e-6;
  const double b = sine2 > 1e-9 ? across / sine2 : 0.5 * curvature_sum, a = curvature_sum - b;
  const double w = 1 / distance, added = (cosine > 0 ? -2 : 2) * (a / c + b * c);
  return {2 * w + added, w * w + w * added + 4 * gaussian};
}

/// A patch and an eye as the rays' arithmetic needs them.
struct PatchRays {
  glm::dvec3 eye_mm;
  glm::dvec3 eye;                  ///< in the patch's coordinates (b1, b2, height)
  glm::dvec3 g1, g2, n, g1n, g2n;  ///< dual basis; g1 x n, g2 x n
  double h11, h12, h22, curvature_sum, gaussian;
  const double* c;
};

struct alignas(64) PatchHits {
  MirrorRays rays;
  double miss[kLanes];  ///< mm between ray and surface after the last step
};

constexpr double kConverged = 1e-9;  // mm

/// All lanes against one patch. Newton in the distance t alone, from the triangle's plane: the error squares
/// from the chord height (0.1 mm) to 1e-6 to 1e-15 mm. Then r = d - 2 (d . n) n / n^2 at the polynomial's own
/// normal.
CATOPTRA_VECTOR_CLONES void hit_patch(const PatchRays& p, const MirrorLanes& lanes, PatchHits& hits) {
  const double eye_x = p.eye.x, eye_y = p.eye.y, eye_z = p.eye.z;
  const glm::dvec3 eye_mm = p.eye_mm, g1 = p.g1, g2 = p.g2, n = p.n, g1n = p.g1n, g2n = p.g2n;
  const double h11 = p.h11, h12 = p.h12, h22 = p.h22, sum = p.curvature_sum, gaussian = p.gaussian;
  double c[21];  // a copy, so that no store into `hits` can be thought to change it
  std::copy(p.c, p.c + 21, c);
  for (int i = 0; i < kLanes; ++i) {
    const double wx = lanes.direction_x[i], wy = lanes.direction_y[i], wz = lanes.direction_z[i];
    const double dx = g1.x * wx + g1.y * wy + g1.z * wz, dy = g2.x * wx + g2.y * wy + g2.z * wz;
    const double dz = n.x * wx + n.y * wy + n.z * wz;
    const double t0 = -eye_z / dz;
    const Height h0 = evaluate(c, eye_x + t0 * dx, eye_y + t0 * dy);
    const double t1 = t0 - ((eye_z + t0 * dz) - h0.value) / (dz - h0.dx * dx - h0.dy * dy);
    const Height h1 = evaluate(c, eye_x + t1 * dx, eye_y + t1 * dy);
    const double t2 = t1 - ((eye_z + t1 * dz) - h1.value) / (dz - h1.dx * dx - h1.dy * dy);
    const Height h = evaluate(c, eye_x + t2 * dx, eye_y + t2 * dy);
    const double nx = n.x - h.dx * g1.x - h.dy * g2.x, ny = n.y - h.dx * g1.y - h.dy * g2.y;
    const double nz = n.z - h.dx * g1.z - h.dy * g2.z;
    const double twice = 2 * (wx * nx + wy * ny + wz * nz) / (nx * nx + ny * ny + nz * nz);
    hits.miss[i] = (eye_z + t2 * dz) - h.value;
    hits.rays.distance[i] = t2;
    hits.rays.surface_x[i] = eye_mm.x + t2 * wx;
    hits.rays.surface_y[i] = eye_mm.y + t2 * wy;
    hits.rays.surface_z[i] = eye_mm.z + t2 * wz;
    hits.rays.reflected_x[i] = wx - twice * nx;
    hits.rays.reflected_y[i] = wy - twice * ny;
    hits.rays.reflected_z[i] = wz - twice * nz;
    // Components of n x d in (b1, b2): the normal curvature in that direction, times its squared length.
    const double s1 = g1n.x * wx + g1n.y * wy + g1n.z * wz, s2 = g2n.x * wx + g2n.y * wy + g2n.z * wz;
    const Wave wave =
        reflected_wave(-(h11 * s1 * s1 + 2 * h12 * s1 * s2 + h22 * s2 * s2), dz, sum, gaussian, t2);
    hits.rays.wave_sum[i] = wave.sum;
    hits.rays.wave_product[i] = wave.product;
  }
}

}  // namespace

/// Samples the exact surface over a triangle.
struct PatchBuilder {
  using Patch = ExactMirror::Patch;
  static constexpr int kDegree = ExactMirror::kDegree, kCount = ExactMirror::kCoefficients;
  using Matrix = std::array<std::array<double, kCount>, kCount>;

  struct Sample {
    double height;
    glm::dvec3 normal;  ///< unit, on the side of the patch's normal
  };

  /// Sample `k` of the principal lattice of degree 5, enlarged about the centroid.
  static std::array<glm::dvec2, kCount> lattice() {
    std::array<glm::dvec2, kCount> points;
    std::size_t k = 0;
    for (int j = 0; j <= kDegree; ++j)
      for (int i = 0; i + j <= kDegree; ++i) {
        const glm::dvec2 b(double(i) / kDegree, double(j) / kDegree);
        points[k++] = 1 / 3.0 + kEnlarged * (b - 1 / 3.0);
      }
    return points;
  }

  /// Inverse of the lattice's Vandermonde matrix: coefficients = inverse x heights. Gauss and Jordan with
  /// pivoting.
  static Matrix inverse_vandermonde() {
    Matrix a{}, inverse{};
    const auto points = lattice();
    for (std::size_t r = 0; r < kCount; ++r) {
      std::size_t k = 0;
      for (int j = 0; j <= kDegree; ++j)
        for (int i = 0; i + j <= kDegree; ++i)
          a[r][k++] = std::pow(points[r].x, i) * std::pow(points[r].y, j);
      inverse[r][r] = 1;
    }
    for (std::size_t col = 0; col < kCount; ++col) {
      std::size_t pivot = col;
      for (std::size_t r = col; r < kCount; ++r)
        if (std::abs(a[r][col]) > std::abs(a[pivot][col])) pivot = r;
      std::swap(a[col], a[pivot]);
      std::swap(inverse[col], inverse[pivot]);
      const double scale = 1 / a[col][col];
      for (std::size_t k = 0; k < kCount; ++k) {
        a[col][k] *= scale;
        inverse[col][k] *= scale;
      }
      for (std::size_t r = 0; r < kCount; ++r) {
        const double f = a[r][col];
        if (r == col || f == 0) continue;
        for (std::size_t k = 0; k < kCount; ++k) {
          a[r][k] -= f * a[col][k];
          inverse[r][k] -= f * inverse[col][k];
        }
      }
    }
    return inverse;
  }

  /// The surface point above barycentric position `b`: Newton in (u, v) until its foot is there.
  static std::optional<Sample> sample(const Patch& patch, const cad_import::ExactSurface& surface,
                                      glm::dvec2 uv, glm::dvec2 b) {
    for (int step = 0; step < 8; ++step) {
      const cad_import::SurfaceFrame f = surface.d1(uv.x, uv.y);
      const glm::dvec3 offset = f.point - patch.corner;
      const glm::dvec2 miss = b - glm::dvec2(glm::dot(patch.g1, offset), glm::dot(patch.g2, offset));
      const glm::dmat2 jacobian(glm::dot(patch.g1, f.du), glm::dot(patch.g2, f.du), glm::dot(patch.g1, f.dv),
                                glm::dot(patch.g2, f.dv));
      const double determinant = glm::determinant(jacobian);
      if (determinant == 0 || !std::isfinite(determinant)) return std::nullopt;
      const glm::dvec2 delta = glm::inverse(jacobian) * miss;
      if (std::max(std::abs(miss.x), std::abs(miss.y)) < 1e-11) {
        glm::dvec3 n = glm::normalize(glm::cross(f.du, f.dv));
        if (glm::dot(n, patch.normal) < 0) n = -n;
        // The last step, shorter than 1e-11 of the triangle, is taken along the tangent plane.
        return Sample{glm::dot(patch.normal, offset + delta.x * f.du + delta.y * f.dv), n};
      }
      uv += delta;
    }
    return std::nullopt;
  }

  static glm::dvec2 start_uv(const tessellate::OpticTriangle& t, glm::dvec2 b) {
    return (1 - b.x - b.y) * t.uv[0] + b.x * t.uv[1] + b.y * t.uv[2];
  }

  /// Compares polynomial and surface between the samples: at the edges' quarter points and inside.
  static bool agrees(const Patch& patch, const cad_import::ExactSurface& surface,
                     const tessellate::OpticTriangle& t) {
    constexpr std::array<glm::dvec2, 10> kChecks{{{1 / 3.0, 1 / 3.0},
                                                  {0.5, 0.5},
                                                  {0, 0.5},
                                                  {0.5, 0},
                                                  {0.27, 0.03},
                                                  {0.7, 0.27},
                                                  {0.03, 0.7},
                                                  {0.13, 0.13},
                                                  {0.74, 0.13},
                                                  {0.13, 0.74}}};
    for (const glm::dvec2& b : kChecks) {
      const auto exact = sample(patch, surface, start_uv(t, b), b);
      if (!exact) return false;
      const Height fit = evaluate(patch.c, b.x, b.y);
      const glm::dvec3 normal = glm::normalize(patch.normal - fit.dx * patch.g1 - fit.dy * patch.g2);
      if (!(std::abs(fit.value - exact->height) < kHeightTolerance)) return false;
      if (!(glm::length(normal - exact->normal) < kSlopeTolerance)) return false;
    }
    return true;
  }

  /// Second derivatives at the centroid, and from them the surface's curvatures (the triangle's plane is
  /// nearly tangent).
  static void set_curvatures(Patch& p) {
    const double x = 1 / 3.0, step = 1e-3;
    const Height right = evaluate(p.c, x + step, x), left = evaluate(p.c, x - step, x);
    const Height up = evaluate(p.c, x, x + step), down = evaluate(p.c, x, x - step);
    p.h11 = (right.dx - left.dx) / (2 * step);
    p.h12 = (right.dy - left.dy) / (2 * step);
    p.h22 = (up.dy - down.dy) / (2 * step);
    const double g11 = glm::dot(p.g1, p.g1), g12 = glm::dot(p.g1, p.g2), g22 = glm::dot(p.g2, p.g2);
    p.curvature_sum = -(p.h11 * g11 + 2 * p.h12 * g12 + p.h22 * g22);
    p.gaussian = (p.h11 * p.h22 - p.h12 * p.h12) * (g11 * g22 - g12 * g12);
  }

  static Patch build(const optics::Optic& optic, const tessellate::OpticTriangle& t, const Matrix& inverse) {
    Patch patch{};
    const auto corner = [&](std::size_t k) { return optic.mesh.vertices[t.vertices[k]].position_mm; };
    patch.corner = corner(0);
    const glm::dvec3 e1 = corner(1) - corner(0), e2 = corner(2) - corner(0), n = glm::cross(e1, e2);
    const double doubled_area = glm::length(n);
    if (!(doubled_area > 0)) return patch;
    patch.normal = n / doubled_area;
    patch.g1 = glm::cross(e2, patch.normal) / doubled_area;
    patch.g2 = glm::cross(patch.normal, e1) / doubled_area;
    const cad_import::ExactSurface& surface = *optic.faces[std::size_t(t.face)].surface;
    static const auto points = lattice();
    std::array<double, kCount> heights;
    for (std::size_t k = 0; k < kCount; ++k) {
      const auto s = sample(patch, surface, start_uv(t, points[k]), points[k]);
      if (!s) return patch;
      heights[k] = s->height;
    }
    for (std::size_t r = 0; r < kCount; ++r) {
      patch.c[r] = 0;
      for (std::size_t k = 0; k < kCount; ++k) patch.c[r] += inverse[r][k] * heights[k];
    }
    set_curvatures(patch);
    patch.valid = agrees(patch, surface, t);
    return patch;
  }
};

ExactMirror::ExactMirror(const optics::Optic& optic) : optic_(optic), patches_(optic.mesh.triangles.size()) {
  static const PatchBuilder::Matrix inverse = PatchBuilder::inverse_vandermonde();
  tbb::parallel_for(std::size_t(0), patches_.size(), [&](std::size_t i) {
    patches_[i] = PatchBuilder::build(optic, optic.mesh.triangles[i], inverse);
  });
}

double ExactMirror::polynomial_share() const {
  const auto valid = std::count_if(patches_.begin(), patches_.end(), [](const Patch& p) { return p.valid; });
  return patches_.empty() ? 1 : double(valid) / double(patches_.size());
}

void ExactMirror::reflect(const glm::dvec3& eye_mm, MirrorLanes& lanes) const {
  bool left[kLanes], chosen[kLanes], solved[kLanes];
  std::copy(std::begin(lanes.active), std::end(lanes.active), left);
  // Neighbouring pixels mostly share a triangle: one pass of all lanes for each triangle that occurs.
  for (int first = 0; first < kLanes; ++first) {
    if (!left[first]) continue;
    const Patch& patch = patches_[lanes.triangle[first]];
    for (int i = 0; i < kLanes; ++i) {
      chosen[i] = left[i] && lanes.triangle[i] == lanes.triangle[first];
      solved[i] = false;
      left[i] = left[i] && !chosen[i];
    }
    if (patch.valid) reflect_on_patch(patch, eye_mm, chosen, lanes, solved);
    for (int i = first; i < kLanes; ++i)
      if (chosen[i] && !solved[i]) reflect_by_newton(patch, eye_mm, i, lanes);
  }
}

void ExactMirror::reflect_on_patch(const Patch& patch, const glm::dvec3& eye_mm, const bool (&chosen)[kLanes],
                                   MirrorLanes& lanes, bool (&solved)[kLanes]) const {
  const glm::dvec3 offset = eye_mm - patch.corner;
  const PatchRays rays{
      eye_mm,
      {glm::dot(patch.g1, offset), glm::dot(patch.g2, offset), glm::dot(patch.normal, offset)},
      patch.g1,
      patch.g2,
      patch.normal,
      glm::cross(patch.g1, patch.normal),
      glm::cross(patch.g2, patch.normal),
      patch.h11,
      patch.h12,
      patch.h22,
      patch.curvature_sum,
      patch.gaussian,
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

void ExactMirror::reflect_by_newton(const Patch& patch, const glm::dvec3& eye_mm, int lane,
                                    MirrorLanes& lanes) const {
  const glm::dvec3 direction(lanes.direction_x[lane], lanes.direction_y[lane], lanes.direction_z[lane]);
  const auto& corners = optic_.mesh.triangles[lanes.triangle[lane]].vertices;
  const auto vertex = [&](std::size_t k) -> const tessellate::OpticVertex& {
    return optic_.mesh.vertices[corners[k]];
  };
  const double u = lanes.u[lane], v = lanes.v[lane], w = 1 - u - v;
  const optics::Ray ray{eye_mm, direction};
  const optics::Hit mesh_hit{0, 0, lanes.triangle[lane], {u, v}};
  glm::dvec3 position, normal;
  if (const auto hit = optics::exact_hit(optic_, ray, mesh_hit)) {
    position = hit->position_mm;
    normal = hit->normal;
  } else {
    // The mesh reaches past the trimmed face by less than its chord error: here the mesh itself is the
    // mirror.
    position = w * vertex(0).position_mm + u * vertex(1).position_mm + v * vertex(2).position_mm;
    normal = glm::normalize(w * vertex(0).normal + u * vertex(1).normal + v * vertex(2).normal);
  }
  const glm::dvec3 reflected = optics::reflect(direction, normal);
  const double distance = glm::length(position - eye_mm);
  const glm::dvec3 across = glm::cross(normal, direction);
  const double s1 = glm::dot(patch.g1, across), s2 = glm::dot(patch.g2, across);
  const Wave wave =
      reflected_wave(-(patch.h11 * s1 * s1 + 2 * patch.h12 * s1 * s2 + patch.h22 * s2 * s2),
                     glm::dot(normal, direction), patch.curvature_sum, patch.gaussian, distance);
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

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

/// Two lanes' worth of doubles is what every x86-64 has; wider units run several of these at once.
using Double4 = double __attribute__((vector_size(32)));

/// Height and slopes at (x, y) by Horner's scheme in both variables.
template <typename Number>
struct Height {
  Number value, dx, dy;
};

template <typename Number>
[[gnu::always_inline]] inline void evaluate(const double* c, const Number& x, const Number& y,
                                            Height<Number>& out) {
  // Rows by power of y: 6, 5, 4, 3, 2, 1 coefficients. Unrolled, so that all stays in registers.
  const Number p5 = Number{} + c[20];
  const Number p4 = c[18] + x * c[19], p4x = Number{} + c[19];
  const Number p3 = c[15] + x * (c[16] + x * c[17]), p3x = c[16] + x * (2 * c[17]);
  const Number p2 = c[11] + x * (c[12] + x * (c[13] + x * c[14])),
               p2x = c[12] + x * (2 * c[13] + x * (3 * c[14]));
  const Number p1 = c[6] + x * (c[7] + x * (c[8] + x * (c[9] + x * c[10])));
  const Number p1x = c[7] + x * (2 * c[8] + x * (3 * c[9] + x * (4 * c[10])));
  const Number p0 = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  const Number p0x = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * (5 * c[5]))));
  out.value = p0 + y * (p1 + y * (p2 + y * (p3 + y * (p4 + y * p5))));
  out.dx = p0x + y * (p1x + y * (p2x + y * (p3x + y * p4x)));
  out.dy = p1 + y * (2.0 * p2 + y * (3.0 * p3 + y * (4.0 * p4 + y * (5.0 * p5))));
}

/// What reflection does to a spherical wave from the eye (generalised Coddington for a mirror; Landgrave and
/// Moya-Cessa 1996): with the surface's curvatures a in the plane of incidence, b across it and their mixed
/// term m, incidence cosine c, the reflected wavefront has [w + 2 a / c, 2 m; 2 m, w + 2 b c], w = 1 /
/// distance.
struct Incidence {
  double across;         ///< b times sine^2 of incidence
  double sine2;          ///< of the angle of incidence, squared
  double cosine;         ///< > 0
  bool from_behind;      ///< the ray comes from the side that the normal points away from
  double sum, gaussian;  ///< a + b, a b - m^2
};

inline void set_wavefront(const Incidence& at, int lane, MirrorLanes& lanes) {
  const double side = at.from_behind ? -1 : 1;
  const double b = side * (at.sine2 > 1e-9 ? at.across / at.sine2 : 0.5 * at.sum), a = side * at.sum - b;
  const double w = 1 / lanes.distance[lane], added = 2 * (a / at.cosine + b * at.cosine);
  lanes.wave_sum[lane] = 2 * w + added;
  lanes.wave_product[lane] = w * w + w * added + 4 * at.gaussian;
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
      Height<double> fit;
      evaluate(patch.c, b.x, b.y, fit);
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
    Height<double> right, left, up, down;
    evaluate(p.c, x + step, x, right);
    evaluate(p.c, x - step, x, left);
    evaluate(p.c, x, x + step, up);
    evaluate(p.c, x, x - step, down);
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
  const double ox = glm::dot(patch.g1, offset), oy = glm::dot(patch.g2, offset),
               oz = glm::dot(patch.normal, offset);
  const glm::dvec3 &g1 = patch.g1, &g2 = patch.g2, &n = patch.normal;
  for (int first = 0; first < kLanes; first += 4) {
    if (!(chosen[first] || chosen[first + 1] || chosen[first + 2] || chosen[first + 3])) continue;
    Double4 wx, wy,
        wz;  // loaded by copy: a function returning such a vector would depend on the processor's ABI
    std::memcpy(&wx, &lanes.direction_x[first], sizeof wx);
    std::memcpy(&wy, &lanes.direction_y[first], sizeof wy);
    std::memcpy(&wz, &lanes.direction_z[first], sizeof wz);
    const Double4 dx = g1.x * wx + g1.y * wy + g1.z * wz, dy = g2.x * wx + g2.y * wy + g2.z * wz;
    const Double4 dz = n.x * wx + n.y * wy + n.z * wz;
    // Newton in the distance t alone, from the triangle's plane. The error squares from the chord (0.1 mm) to
    // 1e-6 to 1e-15.
    Double4 t = -oz / dz, miss{};
    Height<Double4> h{};
    for (int step = 0; step < 3; ++step) {
      evaluate<Double4>(patch.c, ox + t * dx, oy + t * dy, h);
      miss = (oz + t * dz) - h.value;
      if (step < 2) t = t - miss / (dz - h.dx * dx - h.dy * dy);
    }
    Double4 nx = n.x - h.dx * g1.x - h.dy * g2.x, ny = n.y - h.dx * g1.y - h.dy * g2.y,
            nz = n.z - h.dx * g1.z - h.dy * g2.z;
    const Double4 squared = nx * nx + ny * ny + nz * nz, across = wx * nx + wy * ny + wz * nz;
    const Double4 twice = 2 * across / squared;  // r = d - 2 (d . n) n / n^2
    const Double4 rx = wx - twice * nx, ry = wy - twice * ny, rz = wz - twice * nz;
    // Normal curvature across the plane of incidence: along e = n x d / |n x d|, with g_i . (n x d) by
    // components.
    const Double4 s1 =
        (g1.y * n.z - g1.z * n.y) * wx + (g1.z * n.x - g1.x * n.z) * wy + (g1.x * n.y - g1.y * n.x) * wz;
    const Double4 s2 =
        (g2.y * n.z - g2.z * n.y) * wx + (g2.z * n.x - g2.x * n.z) * wy + (g2.x * n.y - g2.y * n.x) * wz;
    for (int k = 0; k < 4; ++k) {
      const int i = first + k;
      if (!chosen[i] || !(std::abs(miss[k]) < 1e-9) || !(t[k] > 0))
        continue;  // mm; else the iteration has not converged
      solved[i] = true;
      lanes.distance[i] = t[k];
      lanes.surface_x[i] = eye_mm.x + t[k] * wx[k];
      lanes.surface_y[i] = eye_mm.y + t[k] * wy[k];
      lanes.surface_z[i] = eye_mm.z + t[k] * wz[k];
      lanes.reflected_x[i] = rx[k];
      lanes.reflected_y[i] = ry[k];
      lanes.reflected_z[i] = rz[k];
      const double cosine = std::abs(dz[k]), sine2 = 1 - cosine * cosine;
      const double curved =
          -(patch.h11 * s1[k] * s1[k] + 2 * patch.h12 * s1[k] * s2[k] + patch.h22 * s2[k] * s2[k]);
      set_wavefront({curved, sine2, cosine, dz[k] > 0, patch.curvature_sum, patch.gaussian}, i, lanes);
    }
  }
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
  lanes.surface_x[lane] = position.x;
  lanes.surface_y[lane] = position.y;
  lanes.surface_z[lane] = position.z;
  lanes.reflected_x[lane] = reflected.x;
  lanes.reflected_y[lane] = reflected.y;
  lanes.reflected_z[lane] = reflected.z;
  lanes.distance[lane] = glm::length(position - eye_mm);
  const glm::dvec3 across = glm::cross(normal, direction);
  const double s1 = glm::dot(patch.g1, across), s2 = glm::dot(patch.g2, across);
  const double curved = -(patch.h11 * s1 * s1 + 2 * patch.h12 * s1 * s2 + patch.h22 * s2 * s2);
  const double cosine = glm::dot(normal, direction);
  set_wavefront({curved, glm::dot(across, across), std::max(std::abs(cosine), 1e-6), cosine > 0,
                 patch.curvature_sum, patch.gaussian},
                lane, lanes);
}

}  // namespace catoptra::render

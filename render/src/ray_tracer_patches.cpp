#include "render/src/ray_tracer_patches.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <optional>

#include "cad_import/bspline_surface.h"

namespace catoptra::render {
namespace {

constexpr int kDegree = SurfacePatch::kDegree;
constexpr std::size_t kCount = SurfacePatch::kCoefficients;
constexpr int kMaxDepth = 9;  // 512 cells a side
constexpr std::size_t kMaxCells =
    65536;  // 30 MB; a surface that asks for more is left to Newton iteration where it does
// How far beyond a cell its polynomial must hold, as a share of the cell: exact hits may lie outside by what
// the mesh's chord error and the angle of incidence make of it. The samples themselves stay inside, where a
// spline is one polynomial.
constexpr double kMargin = 0.002;

using Points = std::array<glm::dvec2, kCount>;
using Matrix = std::array<std::array<double, kCount>, kCount>;

/// The Padua points of degree 5 on the unit square: as many as there are coefficients, and near the best
/// there are for interpolation. Source: Caliari, De Marchi, Vianello 2005.
Points padua_points() {
  Points points;
  std::size_t k = 0;
  const double pi = std::numbers::pi;
  for (int i = 0; i <= kDegree; ++i)
    for (int j = 0; j <= kDegree + 1; ++j)
      if ((i + j) % 2 == 0) points[k++] = {std::cos(i * pi / kDegree), std::cos(j * pi / (kDegree + 1))};
  for (glm::dvec2& p : points) p = 0.5 + 0.5 * p;
  return points;
}

/// Inverse of the points' Vandermonde matrix: coefficients = inverse x heights. Gauss and Jordan with
/// pivoting.
Matrix inverse_vandermonde(const Points& points) {
  Matrix a{}, inverse{};
  for (std::size_t r = 0; r < kCount; ++r) {
    std::size_t k = 0;
    for (int j = 0; j <= kDegree; ++j)
      for (int i = 0; i + j <= kDegree; ++i) a[r][k++] = std::pow(points[r].x, i) * std::pow(points[r].y, j);
    inverse[r][r] = 1;
  }
  for (std::size_t column = 0; column < kCount; ++column) {
    std::size_t pivot = column;
    for (std::size_t r = column; r < kCount; ++r)
      if (std::abs(a[r][column]) > std::abs(a[pivot][column])) pivot = r;
    std::swap(a[column], a[pivot]);
    std::swap(inverse[column], inverse[pivot]);
    const double scale = 1 / a[column][column];
    for (std::size_t k = 0; k < kCount; ++k) {
      a[column][k] *= scale;
      inverse[column][k] *= scale;
    }
    for (std::size_t r = 0; r < kCount; ++r) {
      const double f = a[r][column];
      if (r == column || f == 0) continue;
      for (std::size_t k = 0; k < kCount; ++k) {
        a[r][k] -= f * a[column][k];
        inverse[r][k] -= f * inverse[column][k];
      }
    }
  }
  return inverse;
}

glm::dvec2 in_box(const UvBox& box, glm::dvec2 share) {
  return box.low + share * (box.high - box.low);
}

/// The surface's height above position `b` of the patch's plane: Newton in (u, v) until its foot is there.
std::optional<double> height_above(const SurfacePatch& patch, const cad_import::ExactSurface& surface,
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
    // The last step, shorter than 1e-11 of the cell, is taken along the tangent plane.
    if (std::max(std::abs(miss.x), std::abs(miss.y)) < 1e-11)
      return glm::dot(patch.normal, offset + delta.x * f.du + delta.y * f.dv);
    uv += delta;
  }
  return std::nullopt;
}

/// Compares polynomial and surface between the samples, on the cell's border and beyond it.
bool agrees(const SurfacePatch& patch, const cad_import::ExactSurface& surface, const UvBox& box) {
  constexpr double low = -kMargin, high = 1 + kMargin;
  constexpr std::array<glm::dvec2, 16> kChecks{{{low, low},
                                                {high, low},
                                                {low, high},
                                                {high, high},
                                                {0.5, low},
                                                {0.5, high},
                                                {low, 0.5},
                                                {high, 0.5},
                                                {0.5, 0.5},
                                                {0.2, 0.3},
                                                {0.7, 0.2},
                                                {0.8, 0.7},
                                                {0.3, 0.8},
                                                {0.37, 0.61},
                                                {0.07, 0.9},
                                                {0.93, 0.11}}};
  for (const glm::dvec2& share : kChecks) {
    const glm::dvec2 uv = in_box(box, share);
    const cad_import::SurfaceFrame f = surface.d1(uv.x, uv.y);
    const glm::dvec3 offset = f.point - patch.corner;
    const PatchHeight fit = patch_height(patch.c, glm::dot(patch.g1, offset), glm::dot(patch.g2, offset));
    const glm::dvec3 normal = glm::normalize(patch.normal - fit.dx * patch.g1 - fit.dy * patch.g2);
    const glm::dvec3 exact = glm::normalize(glm::cross(f.du, f.dv));
    if (!(std::abs(fit.value - glm::dot(patch.normal, offset)) < kHeightTolerance)) return false;
    if (!(std::min(glm::length(normal - exact), glm::length(normal + exact)) < kSlopeTolerance)) return false;
  }
  return true;
}

SurfacePatch fit_patch(const cad_import::ExactSurface& surface, const UvBox& box) {
  static const Points points = padua_points();
  static const Matrix inverse = inverse_vandermonde(points);
  SurfacePatch patch;
  patch.corner = surface.point(box.low.x, box.low.y);
  const glm::dvec3 e1 = surface.point(box.high.x, box.low.y) - patch.corner,
                   e2 = surface.point(box.low.x, box.high.y) - patch.corner;
  glm::dvec3 n = glm::cross(e1, e2);
  const double area = glm::length(n);
  if (!(area > 1e-6 * (glm::dot(e1, e1) + glm::dot(e2, e2)))) return patch;  // a closed direction or a pole
  n = n / area;
  // The plane's normal points to the side that the surface's does.
  patch.g1 = glm::cross(e2, n) / area;
  patch.g2 = glm::cross(n, e1) / area;
  patch.normal =
      glm::dot(n, surface.unit_normal(0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y))) < 0
          ? -n
          : n;
  std::array<double, kCount> heights;
  for (std::size_t k = 0; k < kCount; ++k) {
    const auto height = height_above(patch, surface, in_box(box, points[k]), points[k]);
    if (!height) return patch;
    heights[k] = *height;
  }
  for (std::size_t r = 0; r < kCount; ++r)
    for (std::size_t k = 0; k < kCount; ++k) patch.c[r] += inverse[r][k] * heights[k];
  patch.valid = agrees(patch, surface, box);
  return patch;
}

/// Where to split (low, high): at the knot nearest to the middle, or there.
double split_at(double low, double high, const cad_import::SpanAxis* axis) {
  const double middle = 0.5 * (low + high), margin = 1e-6 * (high - low);
  double best = middle, nearest = 0.5 * (high - low) - margin;
  for (int s = 1; axis && s < axis->span_count(); ++s) {
    const double distance = std::abs(axis->span_begin(s) - middle);
    if (distance >= nearest) continue;
    nearest = distance;
    best = axis->span_begin(s);
  }
  return best;
}

double into_domain(double x, double low, double high, double period) {
  if (period > 0) x -= period * std::floor((x - low) / period);
  return std::clamp(x, low, high);
}

bool overlap(const UvBox& a, const UvBox& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

}  // namespace

FacePatches::FacePatches(const cad_import::ExactSurface& surface, std::span<const UvBox> used)
    : domain_(surface.domain()) {
  cells_.push_back({{{domain_.u_min, domain_.v_min}, {domain_.u_max, domain_.v_max}}});
  // Periodic parameters may be given in any period: then no cell can be told to be unused.
  const bool periodic = domain_.u_period > 0 || domain_.v_period > 0;
  std::size_t done = 0;
  while (done < cells_.size()) {  // level by level
    const std::size_t first = done, last = cells_.size();
    std::vector<SurfacePatch> fitted(last - first);
    std::vector<char> needed(last - first, 1);
    tbb::parallel_for(first, last, [&](std::size_t i) {
      const bool met = periodic || std::any_of(used.begin(), used.end(),
                                               [&](const UvBox& box) { return overlap(box, cells_[i].box); });
      needed[i - first] = met;
      if (met) fitted[i - first] = fit_patch(surface, cells_[i].box);
    });
    for (std::size_t i = first; i < last; ++i) {
      const SurfacePatch& patch = fitted[i - first];
      if (needed[i - first] && !patch.valid && cells_[i].depth < kMaxDepth && cells_.size() < kMaxCells) {
        split(i, surface);
        continue;
      }
      cells_[i].patch = int(patches_.size());
      patches_.push_back(patch);
    }
    done = last;
  }
}

void FacePatches::split(std::size_t cell, const cad_import::ExactSurface& surface) {
  const cad_import::BSplineSurface* spline = surface.as_bspline();
  const UvBox box = cells_[cell].box;
  const glm::dvec2 at(split_at(box.low.x, box.high.x, spline ? &spline->axis_u() : nullptr),
                      split_at(box.low.y, box.high.y, spline ? &spline->axis_v() : nullptr));
  cells_[cell].split = at;
  cells_[cell].first_child = int(cells_.size());
  const int depth = cells_[cell].depth + 1;
  for (const UvBox& child : {UvBox{box.low, at}, UvBox{{at.x, box.low.y}, {box.high.x, at.y}},
                             UvBox{{box.low.x, at.y}, {at.x, box.high.y}}, UvBox{at, box.high}}) {
    Cell& added = cells_.emplace_back();
    added.box = child;
    added.depth = depth;
  }
}

int FacePatches::find(glm::dvec2 uv) const {
  uv.x = into_domain(uv.x, domain_.u_min, domain_.u_max, domain_.u_period);
  uv.y = into_domain(uv.y, domain_.v_min, domain_.v_max, domain_.v_period);
  const Cell* cell = cells_.data();
  while (cell->first_child >= 0)
    cell = &cells_[std::size_t(cell->first_child + (uv.x >= cell->split.x ? 1 : 0) +
                               (uv.y >= cell->split.y ? 2 : 0))];
  return cell->patch;
}

MeshPatches::MeshPatches(std::span<const cad_import::Face> faces, const tessellate::OpticArrays& mesh)
    : mesh_(mesh) {
  std::vector<std::vector<UvBox>> used(faces.size());
  for (const tessellate::OpticTriangle& t : mesh.triangles)
    used[std::size_t(t.face)].push_back(
        {glm::min(glm::min(t.uv[0], t.uv[1]), t.uv[2]), glm::max(glm::max(t.uv[0], t.uv[1]), t.uv[2])});
  for (std::size_t f = 0; f < faces.size(); ++f) faces_.emplace_back(*faces[f].surface, used[f]);
  patch_of_triangle_.reserve(mesh.triangles.size());
  for (const tessellate::OpticTriangle& t : mesh.triangles) {
    const FacePatches& face = faces_[std::size_t(t.face)];
    // Corners are taken a little inside: many lie on the cells' borders, and patches hold a little beyond
    // them.
    const glm::dvec2 middle = (t.uv[0] + t.uv[1] + t.uv[2]) / 3.0;
    const auto patch = [&](std::size_t k) { return face.find(middle + 0.999 * (t.uv[k] - middle)); };
    const int a = patch(0);
    patch_of_triangle_.push_back(a == patch(1) && a == patch(2) ? &face.patches()[std::size_t(a)] : nullptr);
  }
}

double MeshPatches::patched_share() const {
  std::size_t valid = 0;
  for (const tessellate::OpticTriangle& t : mesh_.triangles) {
    const FacePatches& face = faces_[std::size_t(t.face)];
    valid += face.patches()[std::size_t(face.find((t.uv[0] + t.uv[1] + t.uv[2]) / 3.0))].valid;
  }
  return mesh_.triangles.empty() ? 1 : double(valid) / double(mesh_.triangles.size());
}

std::size_t MeshPatches::patch_count() const {
  std::size_t count = 0;
  for (const FacePatches& face : faces_) count += face.patches().size();
  return count;
}

const SurfacePatch* MeshPatches::patch_of(std::uint32_t triangle, double u, double v) const {
  if (const SurfacePatch* patch = patch_of_triangle_[triangle]) return patch;
  const tessellate::OpticTriangle& t = mesh_.triangles[triangle];
  const FacePatches& face = faces_[std::size_t(t.face)];
  return &face.patches()[std::size_t(face.find((1 - u - v) * t.uv[0] + u * t.uv[1] + v * t.uv[2]))];
}

}  // namespace catoptra::render

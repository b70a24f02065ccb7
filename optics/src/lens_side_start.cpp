#include "optics/src/lens_side_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace catoptra::optics {
namespace {

using cad_import::Face;
using tessellate::OpticArrays;

constexpr int kFewestCells = 8,
              kMostCells = 32;            // a side; 32 x 32 cells of both sides stay in a second-level cache
constexpr double kSteepestMargin = 0.05;  // rad, on the steepest normal of the mesh
constexpr int kSearchSteps = 5;
constexpr double kSearchStep =
    0.05;  // cells: the search on the expansions ends with such a step; what is left is its square
constexpr int kEvaluations = 6;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kLeastArea =
    1e-3;  // sine of du and dv as seen along the normal below which a cell is of no use

double polynomial(const double (&c)[6], double x, double y) {
  return c[0] + x * (c[1] + c[3] * x + c[4] * y) + y * (c[2] + c[5] * y);
}

// Corners of a triangle on the plane, counter-clockwise or not.
struct FlatTriangle {
  std::array<glm::dvec2, 3> p;

  static double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }
  // Weights of the corners; nullopt outside and where the triangle stands on the plane.
  std::optional<glm::dvec3> weights(const glm::dvec2& q) const {
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    if (area == 0) return std::nullopt;
    const double b = cross(q - p[0], p[2] - p[0]) / area, c = cross(p[1] - p[0], q - p[0]) / area;
    if (b < 0 || c < 0 || b + c > 1) return std::nullopt;
    return glm::dvec3(1 - b - c, b, c);
  }
};

bool within(double x, double low, double high) {
  const double slack = 1e-9 * (high - low);  // as newton_hit: the border belongs to the surface
  return x >= low - slack && x <= high + slack;
}

}  // namespace

LensSideStart::LensSideStart(std::span<const Face> faces, const OpticArrays& mesh) {
  for (const Face& face : faces)
    faces_.push_back(
        {face.surface.get(), face.trim.get(), face.surface->domain(), face.surface->orientation()});
  set_plane(mesh);
  expand_cells(mesh);
  mark_outlines(mesh);
  spread_to_empty_cells();
}

void LensSideStart::set_plane(const OpticArrays& mesh) {
  glm::dvec3 normal{0};
  const auto corner = [&](const tessellate::OpticTriangle& t, std::size_t k) -> const glm::dvec3& {
    return mesh.vertices[t.vertices[k]].position_mm;
  };
  for (const auto& t : mesh.triangles)
    normal += glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
  if (!(glm::length(normal) > 0)) return;  // a closed surface: no ray is steep enough
  normal_ = glm::normalize(normal);
  const glm::dvec3 helper = std::abs(normal_.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  axis_x_ = glm::normalize(glm::cross(normal_, helper));
  axis_y_ = glm::cross(normal_, axis_x_);

  // Over a plane on which the side's slope stays below tan(steepest), a ray that is steeper against it meets
  // the side once: along it, the distance from the side only grows or only falls.
  double least_cosine = 1;
  glm::dvec2 low(1e300), high(-1e300);
  for (const auto& vertex : mesh.vertices) origin_ += vertex.position_mm / double(mesh.vertices.size());
  for (const auto& vertex : mesh.vertices) {
    least_cosine = std::min(least_cosine, glm::dot(vertex.normal, normal_));
    const glm::dvec2 p = on_plane(vertex.position_mm);
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const double steepest = std::acos(std::clamp(least_cosine, -1.0, 1.0)) + kSteepestMargin;
  if (steepest < 1.5) least_slope_ = std::sin(steepest);

  count_ = std::clamp(int(std::sqrt(double(mesh.triangles.size()))), kFewestCells, kMostCells);
  const double size = std::max({high.x - low.x, high.y - low.y, 1e-6});
  x_min_ = 0.5 * (low.x + high.x - size);
  y_min_ = 0.5 * (low.y + high.y - size);
  cells_per_mm_ = count_ / size;
}

glm::dvec2 LensSideStart::on_plane(const glm::dvec3& point) const {
  return {glm::dot(point - origin_, axis_x_), glm::dot(point - origin_, axis_y_)};
}

// What is no number ends in the first cell.
int LensSideStart::cell_number(double x, double y) const {
  const double last = count_ - 1;
  const int i = int(std::min(std::max(0.0, (x - x_min_) * cells_per_mm_), last));
  const int j = int(std::min(std::max(0.0, (y - y_min_) * cells_per_mm_), last));
  return j * count_ + i;
}

// Visits the cell and those within `reach` of it.
template <class Visit>
void LensSideStart::around(int at, int reach, const Visit& visit) const {
  const int i = at % count_, j = at / count_;
  for (int y = std::max(j - reach, 0); y <= std::min(j + reach, count_ - 1); ++y)
    for (int x = std::max(i - reach, 0); x <= std::min(i + reach, count_ - 1); ++x) visit(y * count_ + x);
}

// The parameters as functions of the plane's coordinates, by inverting those to second order: with J the
// first derivatives, q the second ones applied to a = J^-1 d, the parameters change by J^-1 (d - q / 2).
LensSideStart::Cell LensSideStart::expanded(std::int32_t face, const glm::dvec2& uv) const {
  const auto s = faces_[std::size_t(face)].surface->d2(uv.x, uv.y);
  const auto local = [&](const glm::dvec3& d) {
    return glm::dvec3(glm::dot(d, axis_x_), glm::dot(d, axis_y_), glm::dot(d, normal_));
  };
  const glm::dvec3 p = local(s.point - origin_), du = local(s.du), dv = local(s.dv);
  const double area = du.x * dv.y - du.y * dv.x;
  Cell cell;
  if (!(std::abs(area) > kLeastArea * glm::length(s.du) * glm::length(s.dv))) return cell;
  cell.face = face;
  cell.x = p.x;
  cell.y = p.y;
  const double ax = dv.y / area, ay = -dv.x / area, bx = -du.y / area, by = du.x / area;  // J^-1
  // Products of the first-order changes as polynomials x^2, x y, y^2.
  const glm::dvec3 aa(ax * ax, 2 * ax * ay, ay * ay), ab(ax * bx, ax * by + ay * bx, ay * by),
      bb(bx * bx, 2 * bx * by, by * by);
  const glm::dvec3 duu = local(s.duu), duv = local(s.duv), dvv = local(s.dvv);
  const auto bend = [&](int k) { return 0.5 * duu[k] * aa + duv[k] * ab + 0.5 * dvv[k] * bb; };
  const glm::dvec3 bend_x = bend(0), bend_y = bend(1), bend_height = bend(2);
  const glm::dvec3 u2 = -ax * bend_x - ay * bend_y, v2 = -bx * bend_x - by * bend_y;
  const glm::dvec3 h2 = bend_height + du.z * u2 + dv.z * v2;
  const auto set = [](double(&to)[6], double a, double b, double c, const glm::dvec3& second) {
    const double all[6] = {a, b, c, second.x, second.y, second.z};
    std::ranges::copy(all, to);
  };
  set(cell.height, p.z, du.z * ax + dv.z * bx, du.z * ay + dv.z * by, h2);
  set(cell.u, uv.x, ax, ay, u2);
  set(cell.v, uv.y, bx, by, v2);
  return cell;
}

// A cell belongs to the triangle under its middle.
void LensSideStart::expand_cells(const OpticArrays& mesh) {
  cells_.assign(std::size_t(count_ * count_), {});
  for (const auto& triangle : mesh.triangles) {
    FlatTriangle flat;
    for (std::size_t k = 0; k < 3; ++k) flat.p[k] = on_plane(mesh.vertices[triangle.vertices[k]].position_mm);
    const glm::dvec2 low = glm::min(flat.p[0], glm::min(flat.p[1], flat.p[2])),
                     high = glm::max(flat.p[0], glm::max(flat.p[1], flat.p[2]));
    const int first = cell_number(low.x, low.y), last = cell_number(high.x, high.y);
    for (int j = first / count_; j <= last / count_; ++j)
      for (int i = first % count_; i <= last % count_; ++i) {
        Cell& cell = cells_[std::size_t(j * count_ + i)];
        if (cell.face >= 0) continue;
        const auto w = flat.weights({x_min_ + (i + 0.5) / cells_per_mm_, y_min_ + (j + 0.5) / cells_per_mm_});
        if (!w) continue;
        cell = expanded(triangle.face, w->x * triangle.uv[0] + w->y * triangle.uv[1] + w->z * triangle.uv[2]);
        const SideFace& face = faces_[std::size_t(triangle.face)];
        cell.inside = cell.face >= 0 && (!face.trim || face.trim->contains(cell.u[0], cell.v[0]));
      }
  }
}

// Cells that a border of a face passes, and those beside them, must ask the face's trimming: the mesh's
// borders are chords, but far nearer to the true ones than a cell is wide. So must those beside a cell whose
// middle is trimmed away (a mesh may be wider than its faces).
void LensSideStart::mark_outlines(const OpticArrays& mesh) {
  std::vector<bool> near_outline(cells_.size(), false);
  const auto mark = [&](int at) { around(at, 1, [&](int n) { near_outline[std::size_t(n)] = true; }); };
  for (int at = 0; at < int(cells_.size()); ++at)
    if (cells_[std::size_t(at)].face >= 0 && !cells_[std::size_t(at)].inside) mark(at);
  struct Edge {
    std::uint64_t ends;
    std::int32_t face;
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t.vertices[k], t.vertices[(k + 1) % 3]);
      edges.push_back({std::uint64_t(a) << 32 | b, t.face});
    }
  std::ranges::sort(edges);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (k + 1 < edges.size() && edges[k] == edges[k + 1]) {  // within a face
      ++k;
      continue;
    }
    const glm::dvec2 a = on_plane(mesh.vertices[edges[k].ends >> 32].position_mm),
                     b = on_plane(mesh.vertices[edges[k].ends & 0xffffffffu].position_mm);
    const int parts = 1 + int(2 * glm::distance(a, b) * cells_per_mm_);
    for (int part = 0; part <= parts; ++part) {
      const glm::dvec2 p = a + (b - a) * (double(part) / parts);
      mark(cell_number(p.x, p.y));
    }
  }
  for (std::size_t at = 0; at < cells_.size(); ++at)
    cells_[at].inside = cells_[at].inside && !near_outline[at];
}

// Cells off the mesh get the nearest expansion, ring by ring; cells near another face learn of it.
void LensSideStart::spread_to_empty_cells() {
  for (int ring = 0; ring < count_; ++ring) {
    const std::vector<Cell> before = cells_;
    bool empty = false;
    for (int at = 0; at < int(cells_.size()); ++at) {
      if (before[std::size_t(at)].face >= 0) continue;
      around(at, 1, [&](int n) {
        const Cell& from = before[std::size_t(n)];
        if (from.face < 0 || cells_[std::size_t(at)].face >= 0) return;
        cells_[std::size_t(at)] = from;
        cells_[std::size_t(at)].inside = false;
        cells_[std::size_t(at)].near = ring == 0;
      });
      empty = empty || cells_[std::size_t(at)].face < 0;
    }
    if (!empty) break;
  }
  if (faces_.size() < 2) return;
  for (int at = 0; at < int(cells_.size()); ++at) {
    Cell& cell = cells_[std::size_t(at)];
    for (int reach = 1; reach <= 2 && cell.other < 0; ++reach)
      around(at, reach, [&](int n) {
        if (cell.other < 0 && cells_[std::size_t(n)].face != cell.face) cell.other = n;
      });
  }
}

std::optional<ExactHit> LensSideStart::hit(const Ray& ray) const {
  const double slope = glm::dot(normal_, ray.direction);
  if (!(std::abs(slope) > least_slope_)) return std::nullopt;
  // The ray over its height z above the plane, and z by Newton on the expansion of the cell that it is in.
  const glm::dvec3 from = ray.origin_mm - origin_;
  const double per_height = 1 / slope, height = glm::dot(normal_, from);
  const double x_slope = glm::dot(axis_x_, ray.direction) * per_height,
               y_slope = glm::dot(axis_y_, ray.direction) * per_height;
  const double x0 = glm::dot(axis_x_, from) - height * x_slope,
               y0 = glm::dot(axis_y_, from) - height * y_slope;
  double x = x0, y = y0, z = 0;
  const Cell* cell = nullptr;
  bool settled = false;
  for (int k = 0; k < kSearchSteps && !settled; ++k) {
    cell = &cells_[std::size_t(cell_number(x, y))];
    if (cell->face < 0) return std::nullopt;
    const auto& c = cell->height;
    const double dx = x - cell->x, dy = y - cell->y;
    const double along =
        x_slope * (c[1] + 2 * c[3] * dx + c[4] * dy) + y_slope * (c[2] + c[4] * dx + 2 * c[5] * dy);
    const double step = (polynomial(c, dx, dy) - z) / (1 - along);
    z += step;
    x = x0 + z * x_slope;
    y = y0 + z * y_slope;
    settled = std::abs(step) * cells_per_mm_ < kSearchStep;
  }
  if (!settled || !cell->near) return std::nullopt;
  auto hit = hit_from(*cell, ray, x, y);
  if (!hit && cell->other >= 0) hit = hit_from(cells_[std::size_t(cell->other)], ray, x, y);
  return hit;
}

// q + t d = a S_u + b S_v: with w = d x q, a = S_v.w / n.d and b = -S_u.w / n.d; |w| is the distance of ray
// and surface point. The last step is taken without evaluation.
std::optional<ExactHit> LensSideStart::hit_from(const Cell& cell, const Ray& ray, double x, double y) const {
  const SideFace& face = faces_[std::size_t(cell.face)];
  const auto& domain = face.domain;
  std::optional<ExactHit> hit;
  const double dx = x - cell.x, dy = y - cell.y;
  glm::dvec2 uv(polynomial(cell.u, dx, dy), polynomial(cell.v, dx, dy));
  const double far2 = glm::dot(ray.origin_mm, ray.origin_mm);
  for (int k = 1; k <= kEvaluations; ++k) {
    const auto frame = face.surface->d1(uv.x, uv.y);
    const glm::dvec3 n = glm::cross(frame.du, frame.dv);
    const glm::dvec3 w = glm::cross(frame.point - ray.origin_mm, ray.direction);
    const double inverse = 1 / glm::dot(n, ray.direction);
    const double step_u = glm::dot(frame.dv, w) * inverse, step_v = -glm::dot(frame.du, w) * inverse;
    uv += glm::dvec2(step_u, step_v);
    const double tolerance2 =
        std::max(kExactHitTolerance * kExactHitTolerance,
                 16 * kEpsilon * kEpsilon * std::max(far2, glm::dot(frame.point, frame.point)));
    const double distance2 = glm::dot(w, w);
    if (!(distance2 < kInfinity)) return hit;
    if (distance2 > tolerance2) continue;

    if (domain.u_period > 0) uv.x -= domain.u_period * std::floor((uv.x - domain.u_min) / domain.u_period);
    if (domain.v_period > 0) uv.y -= domain.v_period * std::floor((uv.y - domain.v_min) / domain.v_period);
    if (!within(uv.x, domain.u_min, domain.u_max) || !within(uv.y, domain.v_min, domain.v_max)) return hit;
    if (!cell.inside && face.trim && !face.trim->contains(uv.x, uv.y)) return hit;
    const double length2 = glm::dot(n, n);
    const double size = glm::dot(frame.du, frame.du) + glm::dot(frame.dv, frame.dv);
    if (!(length2 > 1e-16 * size * size)) return hit;  // a pole: its normal is a limit
    const glm::dvec3 position = frame.point + step_u * frame.du + step_v * frame.dv;
    const glm::dvec2 moved = (on_plane(position) - glm::dvec2(x, y)) * cells_per_mm_;
    if (std::abs(moved.x) > 0.5 || std::abs(moved.y) > 0.5) return hit;  // another part of the surface
    const double t = glm::dot(position - ray.origin_mm, ray.direction);
    if (!(t >= ray.t_min_mm && t <= ray.t_max_mm)) return hit;
    hit = ExactHit{t, position, n * (face.orientation / std::sqrt(length2)), cell.face, uv, k};
    return hit;
  }
  return hit;
}

}  // namespace catoptra::optics

#include "tessellate/src/sizing.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace catoptra::tessellate {
namespace {

using cad_import::ExactSurface;

constexpr int kIntervals = 8;        // per direction, at whose ends the surface is sampled
constexpr double kMaxAspect = 8;     // a cell's longer side over its shorter one
constexpr double kParallel = 1e-9;   // |du x dv| / (|du| |dv|) below which a sample says nothing
constexpr double kCollapsed = 1e-4;  // of the longest |du|: a pole, where second derivatives per mm are noise
constexpr double kProminent = 4;     // medians: what stands out further is left to local refinement

/// Largest admissible steps at one point, in mm or in parameter units.
struct Steps {
  double u = kUnlimited, v = kUnlimited;
};

/// A cell of steps (a, b) has on its diagonal the deviation (l a^2 + 2 m a b + n b^2) / 8. For a given
/// deviation the largest cell has l a^2 = n b^2; where the surface is straight in one direction, half the
/// deviation goes to the twist.
Steps chord_steps(double l, double m, double n, double chord_mm) {
  if (chord_mm == kUnlimited) return {};
  const double budget = 8 * chord_mm;
  const double root = std::sqrt(l * n);
  if (root > 0) {
    const double share = budget / (2 + 2 * m / root);
    return {std::sqrt(share / l), std::sqrt(share / n)};
  }
  if (m == 0) return {l > 0 ? std::sqrt(budget / l) : kUnlimited, n > 0 ? std::sqrt(budget / n) : kUnlimited};
  if (l > 0) return {std::sqrt(0.5 * budget / l), std::sqrt(0.5 * budget * l) / (2 * m)};
  if (n > 0) return {std::sqrt(0.5 * budget * n) / (2 * m), std::sqrt(0.5 * budget / n)};
  return {std::sqrt(0.5 * budget / m), std::sqrt(0.5 * budget / m)};
}

/// Where one step hit a cap (the face's extent or the aspect ratio), the other may take what is left of the
/// budget.
double rest_of_budget(double own, double mixed, double other, double other_step, double chord_mm,
                      double step) {
  const double budget = 8 * chord_mm - other * other_step * other_step;
  const double linear = 2 * mixed * other_step;
  if (own <= 0 || budget <= 0) return step;
  return std::max(step, (std::sqrt(linear * linear + 4 * own * budget) - linear) / (2 * own));
}

Steps steps_at(const cad_import::SurfaceDerivatives& s, const glm::dvec2& extent, const StepLimits& limits) {
  const double length_u = glm::length(s.du), length_v = glm::length(s.dv);
  const glm::dvec3 cross = glm::cross(s.du, s.dv);
  const double area = glm::length(cross);
  if (!(area > kParallel * length_u * length_v)) return {};
  const glm::dvec3 normal = cross / area;
  // Second fundamental form per mm in both directions.
  const double l = std::abs(glm::dot(s.duu, normal)) / (length_u * length_u);
  const double m = std::abs(glm::dot(s.duv, normal)) / (length_u * length_v);
  const double n = std::abs(glm::dot(s.dvv, normal)) / (length_v * length_v);
  const Steps chord = chord_steps(l, m, n, limits.chord_mm);

  // Turn of the unit normal per mm; each direction gets half of the squared angle of the diagonal.
  const auto tangential = [&](const glm::dvec3& d) {
    return glm::length(d - normal * glm::dot(normal, d)) / area;
  };
  const double turn_u = tangential(glm::cross(s.duu, s.dv) + glm::cross(s.du, s.duv)) / length_u;
  const double turn_v = tangential(glm::cross(s.duv, s.dv) + glm::cross(s.du, s.dvv)) / length_v;
  const double angle = limits.angle_rad * std::sqrt(0.5);
  const double most_u = std::min(turn_u > 0 ? angle / turn_u : kUnlimited, limits.length_mm);
  const double most_v = std::min(turn_v > 0 ? angle / turn_v : kUnlimited, limits.length_mm);
  const Steps wanted{std::min(chord.u, most_u), std::min(chord.v, most_v)};

  // The aspect cap compares what the shape asks for; the face's extent only ends a step (it vanishes at a
  // pole).
  const double cap_u = std::min({most_u, kMaxAspect * wanted.v, extent.x * length_u});
  const double cap_v = std::min({most_v, kMaxAspect * wanted.u, extent.y * length_v});
  Steps mm{std::min(chord.u, cap_u), std::min(chord.v, cap_v)};
  if (limits.chord_mm < kUnlimited) {
    if (mm.u < chord.u)
      mm.v = std::min(rest_of_budget(n, m, l, mm.u, limits.chord_mm, mm.v), cap_v);
    else if (mm.v < chord.v)
      mm.u = std::min(rest_of_budget(l, m, n, mm.v, limits.chord_mm, mm.u), cap_u);
  }
  // What is smaller than the chord itself cannot stray further than that.
  const double least = limits.chord_mm < kUnlimited ? limits.chord_mm : 0;
  return {std::max(mm.u, least) / length_u, std::max(mm.v, least) / length_v};
}

/// The largest value, but at most kProminent medians.
double prominent(std::vector<double>& values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return std::min(values.back(), kProminent * values[values.size() / 2]);
}

}  // namespace

CellCount::CellCount(double begin, double end, const std::vector<double>& density)
    : begin_(begin), end_(end) {
  const double interval = (end - begin) / static_cast<double>(density.size());
  nodes_.assign(1, 0);
  for (const double d : density) nodes_.push_back(nodes_.back() + d * interval);
  even_cells_ = *std::max_element(density.begin(), density.end()) * (end - begin);
}

double CellCount::to_cells(double parameter) const {
  const auto last = static_cast<double>(nodes_.size() - 1);
  const double x = (parameter - begin_) / (end_ - begin_) * last;
  const double k = std::clamp(std::floor(x), 0.0, last - 1);
  const auto i = static_cast<std::size_t>(k);
  return nodes_[i] + (x - k) * (nodes_[i + 1] - nodes_[i]);
}

double CellCount::to_parameter(double cells) const {
  const auto after = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, cells);
  const auto i = static_cast<std::size_t>(after - nodes_.begin()) - 1;
  const double x = static_cast<double>(i) + (cells - nodes_[i]) / (nodes_[i + 1] - nodes_[i]);
  return begin_ + x / static_cast<double>(nodes_.size() - 1) * (end_ - begin_);
}

FaceSizing size_face(const ExactSurface& surface, const UvBox& box, const StepLimits& limits) {
  const glm::dvec2 extent = box.extent();
  if (limits.grid) {
    const double columns = limits.grid->columns - 1, rows = limits.grid->rows - 1;
    return {box, CellCount(box.min.x, box.max.x, {columns / extent.x}),
            CellCount(box.min.y, box.max.y, {rows / extent.y})};
  }
  constexpr std::size_t kNodes = kIntervals + 1;
  std::vector<cad_import::SurfaceDerivatives> samples;
  double longest_u = 0, longest_v = 0;
  for (std::size_t k = 0; k < kNodes * kNodes; ++k) {
    const glm::dvec2 share(static_cast<double>(k % kNodes) / kIntervals,
                           static_cast<double>(k / kNodes) / kIntervals);
    const glm::dvec2 uv = box.min + share * extent;
    samples.push_back(surface.d2(uv.x, uv.y));
    longest_u = std::max(longest_u, glm::length(samples.back().du));
    longest_v = std::max(longest_v, glm::length(samples.back().dv));
  }
  std::array<std::vector<double>, kNodes> column, row;  // densities along each line of samples
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto& s = samples[k];
    if (glm::length(s.du) < kCollapsed * longest_u || glm::length(s.dv) < kCollapsed * longest_v) continue;
    const Steps steps = steps_at(s, extent, limits);
    column[k % kNodes].push_back(1 / steps.u);
    row[k / kNodes].push_back(1 / steps.v);
  }
  std::vector<double> node_u(kNodes), node_v(kNodes);
  for (std::size_t i = 0; i < kNodes; ++i) {
    node_u[i] = std::max(prominent(column[i]), 1 / extent.x);
    node_v[i] = std::max(prominent(row[i]), 1 / extent.y);
  }
  for (auto* nodes :
       {&node_u, &node_v}) {  // the same along the face: a crest in one place, or noise at its rim
    std::vector<double> sorted = *nodes;
    const double most = prominent(sorted);
    for (double& node : *nodes) node = std::min(node, most);
  }
  std::vector<double> density_u, density_v;
  for (std::size_t i = 0; i < kIntervals; ++i) {
    density_u.push_back(std::max(node_u[i], node_u[i + 1]));
    density_v.push_back(std::max(node_v[i], node_v[i + 1]));
  }
  return {box, CellCount(box.min.x, box.max.x, density_u), CellCount(box.min.y, box.max.y, density_v)};
}

}  // namespace catoptra::tessellate

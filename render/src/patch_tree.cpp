#include "render/src/patch_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <utility>

#include "render/src/patch_mesh.h"

namespace catoptra::render {
namespace {

using optics::VertexHit;
using tessellate::OpticArrays;

// A cut that is there stays down to this share of the limits, so that patches do not come and go while an eye
// passes them slowly. Half a patch has about half the field and half the parallax: the band is narrower than
// a cut.
constexpr double kKeepPatch = 0.7;
// A cut is made where it leaves at most this share of what is too much. Of a parallax that comes from both
// principal directions alike, a cut across one leaves about 0.8; of a field that the other one makes, all.
constexpr double kHelps = 0.9;
constexpr std::size_t kFewestTriangles = 2;
// Relative difference of the curvatures below which a surface has no principal directions.
constexpr double kUmbilic = 1e-3;
// Where an optic magnifies more than this, pixels no longer tell what is shown apart (as in
// pvrr_refinement.cpp).
constexpr double kMostMagnification = 20;

using Triangles = std::vector<std::uint32_t>;

struct Cut {
  int axis = 0;
  std::array<Triangles, 2> halves;
  std::array<PatchMeasure, 2> measures;
};

struct Node {
  std::uint64_t number = 1;
  Triangles triangles;
  PatchMeasure measure;
};

double nearness(const VertexHit& hit) {
  return hit.scene_hit ? 1 / std::max(hit.scene_hit.t_mm, optics::kSelfHitDistance_mm) : 0;
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return 2 * std::atan2(glm::length(a - b), glm::length(a + b));
}

/// The two principal directions of a part, or along and across its longer side where there are none.
std::array<glm::dvec3, 2> principal_axes(const OpticArrays& mesh) {
  glm::dvec3 normal{0}, centre{0};
  for (const auto& v : mesh.vertices) {
    normal += v.normal;
    centre += v.position_mm / double(mesh.vertices.size());
  }
  normal = glm::length(normal) > 0 ? glm::normalize(normal) : mesh.vertices[0].normal;
  const glm::dvec3 helper = std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 e1 = glm::normalize(glm::cross(normal, helper)), e2 = glm::cross(normal, e1);
  struct Tensor {
    double xx = 0, xy = 0, yy = 0;
    void add(double x, double y, double weight) {
      xx += weight * x * x;
      xy += weight * x * y;
      yy += weight * y * y;
    }
  } curved, extent;
  double curvature = 0;
  for (const auto& v : mesh.vertices) {
    curved.add(glm::dot(v.direction1, e1), glm::dot(v.direction1, e2), v.k1 - v.k2);
    const glm::dvec3 offset = v.position_mm - centre;
    extent.add(glm::dot(offset, e1), glm::dot(offset, e2), 1);
    curvature += std::abs(v.k1) + std::abs(v.k2);
  }
  const auto anisotropy = [](const Tensor& t) { return 2 * std::hypot(0.5 * (t.xx - t.yy), t.xy); };
  const Tensor& used = anisotropy(curved) > kUmbilic * curvature ? curved : extent;
  const double angle = 0.5 * std::atan2(2 * used.xy, used.xx - used.yy);
  const glm::dvec3 first = std::cos(angle) * e1 + std::sin(angle) * e2;
  return {first, glm::cross(normal, first)};
}

/// What the request says, with what the nodes of one tree share.
class Cutter {
 public:
  explicit Cutter(const PatchRequest& request) : request_(request) {
    for (const auto& t : request.mesh.triangles) {
      const auto& v = request.mesh.vertices;
      const glm::dvec3 &a = v[t.vertices[0]].position_mm, &b = v[t.vertices[1]].position_mm,
                       &c = v[t.vertices[2]].position_mm;
      centres_.push_back((a + b + c) / 3.0);
      areas_.push_back(glm::length(glm::cross(b - a, c - a)));
    }
  }

  /// Zeros where nothing of the part faces the eye.
  [[nodiscard]] PatchMeasure measure(const Triangles& triangles) const {
    const PatchMesh part = part_of(triangles);
    const auto hits = gathered(request_.hits, part.source);
    if (std::none_of(hits.begin(), hits.end(), [](const VertexHit& h) { return h.faces_eye; })) return {};
    const auto view = optics::make_virtual_view(request_.optic, part.patches[0], hits, request_.bounds);
    return measure_patch(part.patches[0], hits, view, request_.px_per_rad);
  }

  /// Field and parallax in units of their limits: above 1, one is exceeded.
  [[nodiscard]] glm::dvec2 excess(const PatchMeasure& measure) const {
    return {std::max(measure.fov_rad.x, measure.fov_rad.y) / request_.most_fov_rad,
            measure.parallax_px / kMostParallax_px};
  }

  /// What `cut` leaves of that which is above `limit` times its limit in `node`.
  [[nodiscard]] double left(const Node& node, const Cut& cut, double limit) const {
    const glm::dvec2 above = excess(node.measure);
    const auto &whole = node.measure, &a = cut.measures[0], &b = cut.measures[1];
    double least = 1;
    const auto too_wide = [&](const PatchMeasure& m) {
      return glm::length(glm::max(m.fov_rad - limit * request_.most_fov_rad, glm::dvec2(0)));
    };
    if (above.x > limit) least = std::min(least, std::max(too_wide(a), too_wide(b)) / too_wide(whole));
    if (above.y > limit)
      least = std::min(least, std::sqrt((a.parallax_squares + b.parallax_squares) / whole.parallax_squares));
    return least;
  }

  /// Across principal direction `axis`; nullopt where that leaves a half with nearly nothing.
  [[nodiscard]] std::optional<Cut> cut(const Triangles& triangles, int axis) const {
    const glm::dvec3 along = principal_axes(part_of(triangles).patches[0])[std::size_t(axis)];
    std::vector<std::pair<double, std::uint32_t>> places;
    double area = 0;
    for (const std::uint32_t t : triangles) {
      places.emplace_back(glm::dot(centres_[t], along), t);
      area += areas_[t];
    }
    std::sort(places.begin(), places.end());
    double half = 0;
    std::size_t middle = 0;
    while (middle + 1 < places.size() && (half += areas_[places[middle].second]) < 0.5 * area) ++middle;
    const double farthest = std::max(std::abs(places.front().first), std::abs(places.back().first));
    // Triangles of one row of a grid stay together, whatever rounding says of their centres.
    const double border = places[middle].first - 1e-9 * farthest;
    Cut made;
    made.axis = axis;
    for (const std::uint32_t t : triangles)
      made.halves[glm::dot(centres_[t], along) < border ? 0 : 1].push_back(t);
    if (std::min(made.halves[0].size(), made.halves[1].size()) < kFewestTriangles) return std::nullopt;
    for (std::size_t k = 0; k < 2; ++k) made.measures[k] = measure(made.halves[k]);
    return made;
  }

 private:
  [[nodiscard]] PatchMesh part_of(const Triangles& triangles) const {
    std::vector<std::uint32_t> labels(request_.mesh.triangles.size(), 1);
    for (const std::uint32_t t : triangles) labels[t] = 0;
    OpticArrays whole = {request_.mesh.vertices, request_.mesh.triangles, {}};
    return cut_into_patches(whole, labels, 1);
  }

  const PatchRequest& request_;
  std::vector<glm::dvec3> centres_;
  std::vector<double> areas_;
};

/// The cut that helps more, or the one of last time; nullopt where none helps.
std::optional<Cut> best_cut(const Cutter& cutter, const Node& node, const int* last) {
  if (last) {
    auto again = cutter.cut(node.triangles, *last);
    if (again && cutter.left(node, *again, kKeepPatch) < 1) return again;
  }
  std::optional<Cut> best;
  double least = kHelps;
  for (const int axis : {0, 1}) {
    auto tried = cutter.cut(node.triangles, axis);
    if (!tried) continue;
    const double left = cutter.left(node, *tried, 1);
    if (!(left < least)) continue;
    least = left;
    best = std::move(tried);
  }
  return best;
}

PatchLabels labels_of(const PatchRequest& request, const std::vector<Node>& leaves) {
  PatchLabels labels;
  labels.of_triangle.assign(request.mesh.triangles.size(), 0);
  std::uint32_t next = 0;
  const auto faces_eye = [&](std::uint32_t t) {
    return std::ranges::any_of(request.mesh.triangles[t].vertices,
                               [&](std::uint32_t v) { return request.hits[v].faces_eye; });
  };
  for (const Node& leaf : leaves) {
    // One that shows nothing needs no map: it is drawn with the first.
    if (std::ranges::none_of(leaf.triangles, faces_eye)) continue;
    for (const std::uint32_t t : leaf.triangles) labels.of_triangle[t] = next;
    ++next;
  }
  labels.count = std::max(1u, next);
  return labels;
}

}  // namespace

PatchMeasure measure_patch(const OpticArrays& mesh, std::span<const VertexHit> hits,
                           const optics::VirtualView& view, double px_per_rad) {
  PatchMeasure measure;
  measure.fov_rad = view.fov_rad;
  if (view.fov_clamped)
    for (const VertexHit& hit : hits) {
      if (!hit.faces_eye) continue;
      const double ahead = glm::dot(hit.direction, view.direction);
      const auto side = [&](const glm::dvec3& axis) {
        return 2 * std::abs(std::atan2(glm::dot(hit.direction, axis), ahead));
      };
      measure.fov_rad = glm::max(measure.fov_rad, glm::dvec2(side(view.right), side(view.up)));
    }
  if (view.projection == optics::MapProjection::parallel) return measure;
  const auto miss = [&](const VertexHit& hit) {
    return glm::length(glm::cross(hit.surface_point_mm - view.viewpoint_mm, hit.direction));
  };
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexHit &a = hits[triangle.vertices[k]], &b = hits[triangle.vertices[(k + 1) % 3]];
      if (!a.faces_eye || !b.faces_eye) continue;
      const double step = std::abs(nearness(a) - nearness(b));
      const double turned = angle_between(a.direction, b.direction),
                   turn = angle_between(a.from_eye, b.from_eye);
      const double magnification = std::min(turn / std::max(turned, 1e-12), kMostMagnification);
      const double parallax = std::max(miss(a), miss(b)) * step * magnification * px_per_rad;
      measure.parallax_px = std::max(measure.parallax_px, parallax);
      measure.parallax_squares += parallax * parallax;
    }
  return measure;
}

PatchLabels PatchTree::choose(const PatchRequest& request) {
  if (!request.remember) cut_last_.clear();
  const Cutter cutter(request);
  Node root;
  for (std::uint32_t t = 0; t < request.mesh.triangles.size(); ++t) root.triangles.push_back(t);
  root.measure = cutter.measure(root.triangles);
  // By how much a node asks for its cut.
  const auto asks = [&](const Node& node) {
    const glm::dvec2 excess = cutter.excess(node.measure);
    return std::max(excess.x, excess.y) / (cut_last_.contains(node.number) ? kKeepPatch : 1.0);
  };
  std::map<std::uint64_t, int> cut_now;
  std::vector<Node> leaves{std::move(root)}, whole;
  while (!leaves.empty() && leaves.size() + whole.size() < request.most_patches) {
    const auto worst = std::max_element(leaves.begin(), leaves.end(),
                                        [&](const Node& a, const Node& b) { return asks(a) < asks(b); });
    if (!(asks(*worst) > 1)) break;
    Node node = std::move(*worst);
    leaves.erase(worst);
    const auto last = cut_last_.find(node.number);
    auto cut = best_cut(cutter, node, last == cut_last_.end() ? nullptr : &last->second);
    if (!cut) {
      whole.push_back(std::move(node));
      continue;
    }
    cut_now[node.number] = cut->axis;
    for (std::size_t k = 0; k < 2; ++k)
      leaves.push_back({2 * node.number + k, std::move(cut->halves[k]), cut->measures[k]});
  }
  cut_last_ = std::move(cut_now);
  leaves.insert(leaves.end(), std::make_move_iterator(whole.begin()), std::make_move_iterator(whole.end()));
  // By their first triangles, so that a patch's number does not depend on which was cut first.
  std::sort(leaves.begin(), leaves.end(),
            [](const Node& a, const Node& b) { return a.triangles.front() < b.triangles.front(); });
  return labels_of(request, leaves);
}

}  // namespace catoptra::render

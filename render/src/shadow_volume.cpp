#include "render/src/shadow_volume.h"

#include <algorithm>
#include <array>
#include <bit>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "render/src/shadow_overlaps.h"

namespace catoptra::render {
namespace {

struct PlaceHash {
  std::size_t operator()(const std::array<std::uint32_t, 3>& key) const {
    std::size_t hash = 0;
    for (const std::uint32_t part : key) hash = (hash ^ part) * 0x9E3779B97F4A7C15u + (hash >> 29);
    return hash;
  }
};

/// Both zeros are one place.
std::array<std::uint32_t, 3> key_of(const glm::vec3& p) {
  return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
          std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

struct Welded {
  std::vector<glm::vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Welded weld(std::span<const glm::vec3> corners) {
  Welded welded;
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, PlaceHash> known;
  known.reserve(corners.size() / 2);
  const auto vertex = [&](const glm::vec3& p) {
    const auto [at, fresh] = known.emplace(key_of(p), std::uint32_t(welded.positions.size()));
    if (fresh) welded.positions.push_back(p);
    return at->second;
  };
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const std::array<std::uint32_t, 3> t{vertex(corners[i]), vertex(corners[i + 1]), vertex(corners[i + 2])};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) welded.triangles.push_back(t);
  }
  return welded;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t i) {
  while (parents[i] != i) i = parents[i] = parents[parents[i]];
  return i;
}

/// Brings the triangles of a body together, bodies in the order of their first triangles, and returns how
/// many each has.
std::vector<std::size_t> sort_by_body(Welded& welded) {
  std::vector<std::uint32_t> parents(welded.positions.size());
  std::iota(parents.begin(), parents.end(), 0u);
  for (const auto& t : welded.triangles)
    for (const std::uint32_t other : {t[1], t[2]}) parents[root_of(parents, other)] = root_of(parents, t[0]);
  std::unordered_map<std::uint32_t, std::size_t> numbers;
  std::vector<std::size_t> counts;
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (std::size_t i = 0; i < welded.triangles.size(); ++i) {
    const std::size_t body =
        numbers.emplace(root_of(parents, welded.triangles[i][0]), numbers.size()).first->second;
    counts.resize(numbers.size(), 0);
    ++counts[body];
    order.emplace_back(body, i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::array<std::uint32_t, 3>> sorted;
  sorted.reserve(order.size());
  for (const auto& [body, i] : order) sorted.push_back(welded.triangles[i]);
  welded.triangles = std::move(sorted);
  return counts;
}

cad_import::BoundingBox box_of(const ShadowCasters& casters, std::size_t first, std::size_t count) {
  cad_import::BoundingBox box;
  for (std::size_t i = first; i < first + count; ++i)
    for (const std::uint32_t corner : casters.triangles[i].corners) {
      box.min = glm::min(box.min, glm::dvec3(casters.positions[corner]));
      box.max = glm::max(box.max, glm::dvec3(casters.positions[corner]));
    }
  return box;
}

/// Six times the signed volume, of the body's triangles about its first corner.
double signed_volume(const ShadowCasters& casters, const ShadowCasters::Body& body) {
  const auto at = [&](std::uint32_t corner) { return glm::dvec3(casters.positions[corner]); };
  const glm::dvec3 origin = at(casters.triangles[body.first].corners[0]);
  double volume = 0;
  for (std::size_t i = body.first; i < body.first + body.count; ++i) {
    const auto& corners = casters.triangles[i].corners;
    volume += glm::dot(at(corners[0]) - origin, glm::cross(at(corners[1]) - origin, at(corners[2]) - origin));
  }
  return volume;
}

/// See ShadowCasters::Body::outside.
int outside_of(const ShadowCasters& casters, const ShadowCasters::Body& body) {
  std::unordered_map<std::uint32_t, std::pair<int, int>> uses;  // of an edge: how often, and its net sense
  for (std::size_t i = body.first; i < body.first + body.count; ++i)
    for (const auto& side : casters.triangles[i].sides) {
      auto& [count, net] = uses[side.edge];
      ++count;
      net += side.sense;
    }
  for (const auto& [edge, use] : uses)
    if (use.first != 2 || use.second != 0) return 0;
  const double volume = signed_volume(casters, body);
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

bool contains(const cad_import::BoundingBox& box, const glm::dvec3& p) {
  return glm::all(glm::greaterThanEqual(p, box.min)) && glm::all(glm::lessThanEqual(p, box.max));
}

/// Some triangles of one body, whose volume is closed in itself. Where `sense` is not 0 only those count that
/// face the light when run through in that sense.
struct Range {
  std::size_t first, count;
  const cad_import::BoundingBox* box;
  int sense;
};

class Builder {
 public:
  Builder(const ShadowCasters& casters, const glm::dvec4& light)
      : casters_(casters), light_(light), net_(casters.edges.size(), 0) {}

  ShadowVolume build() {
    std::vector<Range> all;
    for (const auto& body : casters_.bodies) {
      const bool may_hold_light = light_.w != 0 && contains(body.box, glm::dvec3(light_));
      all.push_back({body.first, body.count, &body.box, may_hold_light ? 0 : body.outside});
    }
    add_batches(all);
    return std::move(volume_);
  }

 private:
  /// Halves them until no half overlaps more often than eight bits can count.
  void add_batches(std::span<const Range> ranges) {
    std::size_t triangles = 0;
    for (const Range& range : ranges) triangles += range.count;
    if (triangles == 0) return;
    std::vector<std::uint32_t> list;
    list.reserve(triangles);
    for (const Range& range : ranges)
      for (std::size_t i = range.first; i < range.first + range.count; ++i)
        if (casts(range, facing(casters_.triangles[i]))) list.push_back(std::uint32_t(i));
    const std::size_t most = most_overlaps(casters_, list, light_);
    if (most <= kMostOverlaps) {
      add_batch(ranges, most);
      return;
    }
    std::vector<Range> halves[2];
    std::size_t left = triangles / 2;
    for (const Range& range : ranges) {
      const std::size_t here = std::min(left, range.count);
      if (here > 0) halves[0].push_back({range.first, here, range.box, range.sense});
      if (here < range.count)
        halves[1].push_back({range.first + here, range.count - here, range.box, range.sense});
      left -= here;
    }
    add_batches(halves[0]);
    add_batches(halves[1]);
  }

  void add_batch(std::span<const Range> ranges, std::size_t most) {
    ShadowVolume::Batch batch{volume_.parts.size(), 0, most};
    for (const Range& range : ranges) add_part(range);
    batch.count = volume_.parts.size() - batch.first;
    if (batch.count > 0) volume_.batches.push_back(batch);
  }

  /// 1 where the triangle's own sense faces the light, -1 where the other one does, 0 edge-on.
  [[nodiscard]] int facing(const ShadowCasters::Triangle& triangle) const {
    const glm::dvec3 a(casters_.positions[triangle.corners[0]]), b(casters_.positions[triangle.corners[1]]),
        c(casters_.positions[triangle.corners[2]]);
    const double side = glm::dot(glm::cross(b - a, c - a), glm::dvec3(light_) - light_.w * a);
    return side > 0 ? 1 : side < 0 ? -1 : 0;
  }

  static bool casts(const Range& range, int faces) {
    return faces != 0 && (range.sense == 0 || range.sense == faces);
  }

  void add_part(const Range& range) {
    caps_.clear();
    touched_.clear();
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
      const ShadowCasters::Triangle& triangle = casters_.triangles[i];
      const int faces = facing(triangle);
      if (!casts(range, faces)) continue;
      const std::uint32_t a = triangle.corners[0], b = triangle.corners[faces > 0 ? 1 : 2],
                          c = triangle.corners[faces > 0 ? 2 : 1];
      for (const std::uint32_t corner : {a, b, c}) caps_.push_back(2 * corner);
      for (const ShadowCasters::Side& side : triangle.sides) {
        if (net_[side.edge] == 0) touched_.push_back(side.edge);
        net_[side.edge] += faces * side.sense;
      }
    }
    if (caps_.empty()) return;
    ShadowVolume::Part part{volume_.indices.size(), 0, caps_.size(), *range.box};
    for (const std::uint32_t edge : touched_) add_sides(edge);
    // Volumes away from a direction meet in one point at infinity.
    for (std::size_t i = 0; light_.w != 0 && i < caps_.size(); i += 3)
      for (const std::size_t k : {i, i + 2, i + 1}) volume_.indices.push_back(caps_[k] + 1);
    part.side_count = volume_.indices.size() - part.first;
    volume_.indices.insert(volume_.indices.end(), caps_.begin(), caps_.end());
    volume_.parts.push_back(part);
  }

  void add_sides(std::uint32_t edge) {
    std::int32_t net = std::exchange(net_[edge], 0);
    // In the sense in which the triangle that faces the light runs, its inside is on the left.
    std::uint32_t a = casters_.edges[edge].a, b = casters_.edges[edge].b;
    if (net < 0) std::swap(a, b);
    volume_.silhouette_edges += std::size_t(std::abs(net));
    for (net = std::abs(net); net > 0; --net) {
      for (const std::uint32_t i : {2 * b, 2 * a, 2 * a + 1}) volume_.indices.push_back(i);
      if (light_.w == 0) continue;
      for (const std::uint32_t i : {2 * b, 2 * a + 1, 2 * b + 1}) volume_.indices.push_back(i);
    }
  }

  const ShadowCasters& casters_;
  glm::dvec4 light_;
  std::vector<std::int32_t>
      net_;  ///< by edge: how often it runs from a to b, less the opposite; 0 between parts
  std::vector<std::uint32_t> touched_, caps_;
  ShadowVolume volume_;
};

}  // namespace

ShadowCasters make_shadow_casters(std::span<const glm::vec3> corners) {
  Welded welded = weld(corners);
  const std::vector<std::size_t> counts = sort_by_body(welded);
  ShadowCasters casters;
  casters.positions = std::move(welded.positions);
  casters.triangles.reserve(welded.triangles.size());
  std::unordered_map<std::uint64_t, std::uint32_t> known;
  known.reserve(2 * welded.triangles.size());
  for (const auto& t : welded.triangles) {
    ShadowCasters::Triangle triangle{{t[0], t[1], t[2]}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      const auto [at, fresh] = known.emplace(std::uint64_t(a) << 32 | b, std::uint32_t(casters.edges.size()));
      if (fresh) casters.edges.push_back({a, b});
      triangle.sides[k] = {at->second, t[k] == a ? 1 : -1};
    }
    casters.triangles.push_back(triangle);
  }
  std::size_t first = 0;
  for (const std::size_t count : counts) {
    casters.bodies.push_back({first, count, box_of(casters, first, count)});
    casters.bodies.back().outside = outside_of(casters, casters.bodies.back());
    first += count;
  }
  return casters;
}

ShadowVolume make_shadow_volume(const ShadowCasters& casters, const glm::dvec4& light) {
  return Builder(casters, light).build();
}

}  // namespace catoptra::render

#include "render/src/pvrr_refinement.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "render/src/lens_rays.h"
#include "render/src/patch_coordinates.h"
#include "render/src/patch_mesh.h"
#include "render/src/refinement_measure.h"

namespace catoptra::render {
namespace {

using optics::VertexHit;
using tessellate::EdgeMiddle;

// Inside a triangle, where the error is a quadratic function, it is at most 4/3 of the largest at the middles
// of its edges (at the centre: 8/18 of the sum of the three).
constexpr double kSplit = 0.75;
// Edges that are split stay so down to this share of that, so that a mesh does not flicker while an error
// passes the limit slowly. One split more divides errors by four: the band is narrower than a level.
constexpr double kKeep = 0.5;
// Each level divides a smooth error by four: this is a factor of 1e6.
constexpr int kMostLevels = 10;
// The part of the error that is odd about the middle of an edge vanishes there; it is found from the rays'
// differentials, so far from the ends, as a share of the edge.
constexpr double kBesideEnd = 1.0 / 64;
// It is largest a quarter of the way from either end or nearly so, where the even part is at 3/4: x (1 - x)
// (x - 1/2) at x = 1/4.
constexpr double kCubicShare = 3.0 / 64;
constexpr std::size_t kEdgesPerTask = 64;

}  // namespace

void PvrrRefinement::prepare(const RefinementRequest& request) {
  const auto side = request.optic.kind == optics::OpticKind::lens
                        ? optics::side_of(request.optic, request.entered)
                        : optics::LensSideView{request.optic.faces, &request.optic.mesh};
  if (!mesh_ || side_ != request.entered) {
    mesh_.emplace(side.faces, request.mesh);
    side_ = request.entered;
    known_.clear();
    borders_.clear();
    twin_.clear();
    was_split_.clear();
    nodes_.clear();
  } else {
    mesh_->restart();
  }
  if (!request.remember) was_split_.clear();
  if (!request.remember || eye_mm_ != request.eye_mm) {
    known_.clear();
    borders_.clear();
  }
  eye_mm_ = request.eye_mm;
  hits_.assign(request.hits.begin(), request.hits.end());
  coordinates_.assign(request.coordinates.begin(), request.coordinates.end());
  patch_.assign(request.patch.begin(), request.patch.end());
  patch_.resize(hits_.size(), 0);
  open_.assign(request.open.begin(), request.open.end());
  border_coordinates_.clear();
  traced_rays_ = scene_rays_ = 0;
  error_left_px_ = 0;
}

void PvrrRefinement::refine(const RefinementRequest& request) {
  prepare(request);
  std::vector<char> split_now;
  for (int level = 0; level < kMostLevels; ++level) {
    const std::vector<char> wanted = choose(request, edge_errors(request));
    if (std::find(wanted.begin(), wanted.end(), char(1)) == wanted.end()) break;
    split_now.resize(mesh_->node_count(), 0);
    const auto edges = mesh_->new_edges();
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (wanted[i]) split_now[edges[i].node] = 1;
    if (is_lens(request)) trace_middles(request, whole_groups(wanted));
    mesh_->split(wanted);
    add_vertices(request);
    if (is_lens(request)) continue_rays(request);
  }
  was_split_ = std::move(split_now);
  const auto nodes = mesh_->nodes();
  changed_ = !std::equal(nodes.begin(), nodes.end(), nodes_.begin(), nodes_.end());
  if (changed_) nodes_.assign(nodes.begin(), nodes.end());
}

void PvrrRefinement::find_twins() {
  const auto edges = mesh_->new_edges();
  for (auto node = static_cast<std::uint32_t>(twin_.size()); node < mesh_->node_count(); ++node)
    twin_.push_back(node);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].group != edges[i - 1].group) continue;
    const auto &a = mesh_->middle(edges[i - 1]), &b = mesh_->middle(edges[i]);
    if (a.position_mm == b.position_mm && a.normal == b.normal && a.face == b.face && a.uv == b.uv)
      twin_[edges[i].node] = twin_[edges[i - 1].node];
  }
}

void PvrrRefinement::trace_middles(const RefinementRequest& request, std::span<const char> asked) {
  const auto edges = mesh_->new_edges();
  rays_.resize(mesh_->node_count());
  known_.resize(mesh_->node_count(), 0);
  find_twins();
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (asked[i] && !std::exchange(known_[twin_[edges[i].node]], char(1))) missing.push_back(i);
  traced_rays_ += missing.size();
  const bool lens = is_lens(request);
  const auto indices = lens ? optics::lens_indices(request.optic, samples_of(request.optic)[0].wavelength_nm)
                            : optics::LensIndices();
  // Twins are traced once, so that no two tasks write the same entry.
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, missing.size(), kEdgesPerTask), [&](const auto& some) {
    for (std::size_t k = some.begin(); k < some.end(); ++k) {
      const EdgeMiddle& edge = edges[missing[k]];
      const auto& vertex = mesh_->middle(edge);
      const optics::Arrival arrival = request.arrival(vertex.position_mm);
      rays_[twin_[edge.node]] = lens ? optics::refract_vertex(vertex, request.optic, *request.tracer,
                                                              request.entered, indices, arrival)
                                     : optics::reflect_vertex(vertex, request.optic, arrival);
    }
  });
}

std::vector<double> PvrrRefinement::edge_errors(const RefinementRequest& request) {
  const auto edges = mesh_->new_edges();
  const auto& vertices = mesh_->mesh().vertices;
  std::vector<glm::dvec3> pixels(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) pixels[i] = request.camera.pixel(vertices[i].position_mm);
  const std::vector<EdgePlace> places = edge_places(request, pixels);
  std::vector<char> asked(edges.size(), 0);
  for (std::size_t i = 0; i < edges.size(); ++i)
    asked[i] = places[i] == EdgePlace::inside || places[i] == EdgePlace::beyond;
  trace_middles(request, asked);

  std::vector<double> errors(edges.size(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, edges.size(), kEdgesPerTask), [&](const auto& some) {
    for (std::size_t i = some.begin(); i < some.end(); ++i) {
      if (places[i] != EdgePlace::inside) continue;
      const auto [a, b] = edges[i].ends;
      const double length_px = glm::distance(glm::dvec2(pixels[a]), glm::dvec2(pixels[b])),
                   error = inside_error_px(request, edges[i]);
      // No error is larger than the edge: it is what an edge next to a caustic or the map's horizon gives.
      errors[i] = std::isfinite(error) ? std::min(error, length_px) : length_px;
    }
  });
  if (is_lens(request)) add_border_errors(request, places, pixels, errors);
  return errors;
}

double PvrrRefinement::inside_error_px(const RefinementRequest& request, const EdgeMiddle& edge) const {
  const VertexHit& middle = rays_[twin_[edge.node]];
  // Between two ends where light passes a lens: something stands in its way.
  if (!passes(middle)) return is_lens(request) ? std::numeric_limits<double>::infinity() : 0;
  const auto [a, b] = edge.ends;
  const auto& vertices = mesh_->mesh().vertices;
  const glm::dvec3 from = vertices[a].position_mm, step = vertices[b].position_mm - from,
                   point = from + 0.5 * step;
  // Farther beyond what the optic above lets pass than the edge is long, nobody sees what it shows.
  if (std::min({hits_[a].beyond_mm, hits_[b].beyond_mm, middle.beyond_mm}) > glm::length(step)) return 0;
  const optics::VirtualView& view = request.views[patch_[a]];
  const auto near_at = [&](double share) {
    return (1 - share) * nearness(hits_[a]) + share * nearness(hits_[b]);
  };
  const auto off = [&](double share, const VertexHit& known, const glm::dvec3& known_mm) {
    return map_off(view, (1 - share) * coordinates_[a] + share * coordinates_[b],
                   ray_through(known, from + share * step - known_mm, near_at(share)));
  };
  const glm::dvec2 in_middle = off(0.5, middle, mesh_->middle(edge).position_mm);
  // The error x (1 - x) (4 m + c (x - 1/2)) has c as the sum of its slopes at both ends, less its sign.
  const glm::dvec2 cubic =
      (off(1 - kBesideEnd, hits_[b], vertices[b].position_mm) - off(kBesideEnd, hits_[a], from)) / kBesideEnd;
  const double near = near_at(0.5);
  const VertexHit ray = ray_through(middle, point - mesh_->middle(edge).position_mm, near);
  const PicturePlace place = picture_place(request.camera, point);
  const auto in_px = [&](const glm::dvec2& off_map) {
    return map_error_px(place, view, ray, near, glm::distance(point, eye_mm_), off_map);
  };
  return std::max(in_px(in_middle), in_px(0.75 * in_middle) + in_px(kCubicShare * cubic));
}

std::vector<char> PvrrRefinement::choose(const RefinementRequest& request, std::span<const double> errors) {
  const auto edges = mesh_->new_edges();
  std::vector<char> wanted(edges.size(), 0);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::uint32_t node = edges[i].node;
    const bool was = node < was_split_.size() && was_split_[node];
    if (errors[i] > kSplit * request.max_error_px * (was ? kKeep : 1.0)) chosen.push_back(i);
  }
  keep_to_limit(chosen, errors);
  for (const std::size_t i : chosen) wanted[i] = 1;
  return wanted;
}

void PvrrRefinement::keep_to_limit(std::vector<std::size_t>& chosen, std::span<const double> errors) {
  const auto edges = mesh_->new_edges();
  const std::size_t vertices = mesh_->mesh().vertices.size();
  if (edges.empty() || vertices + edges.size() <= kMostRefinedVertices) return;
  std::vector<std::size_t> group_size(edges.back().group + 1, 0);
  for (const EdgeMiddle& edge : edges) ++group_size[edge.group];
  // The worst first; of equal ones those that come first.
  std::stable_sort(chosen.begin(), chosen.end(),
                   [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
  std::size_t count = vertices;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    std::size_t& size = group_size[edges[chosen[k]].group];
    if (count + size > kMostRefinedVertices) {
      error_left_px_ = std::max(error_left_px_, errors[chosen[k]]);
      chosen.resize(k);
      return;
    }
    count += size;
    size = 0;  // the others of its group come with it
  }
}

void PvrrRefinement::add_vertices(const RefinementRequest& request) {
  const auto parents = mesh_->parents();
  const auto nodes = mesh_->nodes();
  const std::size_t base = request.hits.size(), known = hits_.size(), count = nodes.size();
  std::vector<VertexHit> distinct;
  std::vector<std::uint32_t> place;
  std::vector<glm::dvec3> between;
  for (std::size_t i = known; i < count; ++i) {
    // What comes along because the face at the other side of a crease is split may show nothing.
    const std::uint32_t node = twin_[nodes[i]];
    // Twins come one after the other.
    if (i == known || node != twin_[nodes[i - 1]])
      distinct.push_back(known_[node] ? rays_[node] : VertexHit{});
    place.push_back(static_cast<std::uint32_t>(distinct.size() - 1));
    const auto [a, b] = parents[i - base];
    between.push_back(0.5 * (coordinates_[a] + coordinates_[b]));
    patch_.push_back(patch_[a]);
  }
  scene_rays_ += distinct.size();
  distinct = request.with_scene_hits(std::move(distinct));
  const std::vector<VertexHit> added = gathered(std::span<const VertexHit>(distinct), place);
  const auto coordinates =
      patch_coordinates_like(between, added, std::span(patch_).subspan(known), request.views);
  hits_.insert(hits_.end(), added.begin(), added.end());
  coordinates_.insert(coordinates_.end(), coordinates.begin(), coordinates.end());
}

}  // namespace catoptra::render

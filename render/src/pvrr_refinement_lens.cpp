// PvrrRefinement: the edges of a lens along the border of what light passes.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "optics/map_coordinates.h"
#include "render/src/patch_coordinates.h"
#include "render/src/patch_mesh.h"
#include "render/src/pvrr_refinement.h"
#include "render/src/refinement_measure.h"

namespace catoptra::render {
namespace {

using optics::VertexHit;

constexpr std::size_t kBordersPerTask = 16;

/// Per vertex, whether it is a corner of a triangle of which `holds` is true.
template <typename Holds>
std::vector<char> corners_of(const tessellate::OpticArrays& mesh, const Holds& holds) {
  std::vector<char> corner(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.triangles)
    if (holds(triangle.vertices))
      for (const std::uint32_t v : triangle.vertices) corner[v] = 1;
  return corner;
}

}  // namespace

std::vector<PvrrRefinement::EdgePlace> PvrrRefinement::edge_places(const RefinementRequest& request,
                                                                   std::span<const glm::dvec3> pixels) const {
  const auto edges = mesh_->new_edges();
  const auto& mesh = mesh_->mesh();
  // What an edge outside the picture shows reaches into it by the third corner.
  const std::vector<char> on_screen = corners_of(mesh, [&](const auto& v) {
    return !off_screen(request.camera, {pixels[v[0]], pixels[v[1]], pixels[v[2]]});
  });
  const std::vector<char> beside = corners_of(
      mesh, [&](const auto& v) { return passes(hits_[v[0]]) || passes(hits_[v[1]]) || passes(hits_[v[2]]); });
  std::vector<EdgePlace> places(edges.size(), EdgePlace::elsewhere);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [a, b] = edges[i].ends;
    if (!on_screen[a] || !on_screen[b]) continue;
    if (passes(hits_[a]) && passes(hits_[b]))
      places[i] = EdgePlace::inside;
    else if (is_lens(request) && passes(hits_[a]) != passes(hits_[b]))
      places[i] = EdgePlace::border;
    else if (is_lens(request) && beside[a] && beside[b])
      places[i] = EdgePlace::beyond;
  }
  return places;
}

void PvrrRefinement::find_borders(const RefinementRequest& request, std::span<const EdgePlace> places) {
  const auto edges = mesh_->new_edges();
  const auto& vertices = mesh_->mesh().vertices;
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (places[i] == EdgePlace::border && borders_.count(edges[i].node) == 0) missing.push_back(i);
  traced_rays_ += kBorderPaths * missing.size();
  const auto indices = optics::lens_indices(request.optic, samples_of(request.optic)[0].wavelength_nm);
  std::vector<LensBorder> found(missing.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, missing.size(), kBordersPerTask),
                    [&](const auto& some) {
                      for (std::size_t k = some.begin(); k < some.end(); ++k) {
                        auto [from, to] = edges[missing[k]].ends;
                        if (!passes(hits_[from])) std::swap(from, to);
                        found[k] = find_border(*request.tracer, request.entered, indices, request.arrival,
                                               vertices[from].position_mm, vertices[to].position_mm);
                      }
                    });
  for (std::size_t k = 0; k < missing.size(); ++k)
    borders_.emplace(edges[missing[k]].node, std::move(found[k]));
}

void PvrrRefinement::add_border_errors(const RefinementRequest& request, std::span<const EdgePlace> places,
                                       std::span<const glm::dvec3> pixels, std::vector<double>& errors) {
  find_borders(request, places);
  const auto edges = mesh_->new_edges();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [a, b] = edges[i].ends;
    const double length_px = glm::distance(glm::dvec2(pixels[a]), glm::dvec2(pixels[b]));
    if (places[i] == EdgePlace::border)
      errors[i] = border_error_px(request, edges[i], length_px);
    else if (places[i] == EdgePlace::beyond && passes(rays_[twin_[edges[i].node]]))
      errors[i] = length_px;
  }
}

double PvrrRefinement::border_error_px(const RefinementRequest& request, const tessellate::EdgeMiddle& edge,
                                       double length_px) {
  auto [from, to] = edge.ends;
  if (!passes(hits_[from])) std::swap(from, to);
  const LensBorder& border = borders_.at(edge.node);
  const VertexHit &known = hits_[from], &beyond = hits_[to];
  double error = 0;
  if (open_[to] <= 0) {  // the outline is where LensRays::open has its zero between the two
    const double shown = open_[from] / (double(open_[from]) - open_[to]);
    error = length_px * std::max({0.0, shown - border.blocked, border.passed - shown});
  }
  const double share = border.passed;
  // Nothing is measured where the border lies so close to the vertex that all may be off but that.
  if (share == 0) return std::max(error, kBorderShare * length_px);
  if (!beyond.faces_eye) return share * length_px;  // nothing is known there, or the map has no place for it
  const auto between = [&](const auto& a, const auto& b) { return (1 - share) * a + share * b; };
  const glm::dvec3 point =
      between(mesh_->mesh().vertices[from].position_mm, mesh_->mesh().vertices[to].position_mm);
  VertexHit exact = known;
  exact.surface_point_mm = border.path.exit.position_mm;
  exact.direction = border.path.outside;
  const double near = between(nearness(known), nearness(beyond));
  exact = ray_through(exact, glm::dvec3(0), near);
  const glm::dvec3 shown = between(coordinates_[from], coordinates_[to]);
  const optics::VirtualView& view = request.views[patch_[from]];
  border_coordinates_.push_back(
      {patch_[from], optics::map_coordinates_like(std::span(&shown, 1), std::span(&exact, 1), view)[0]});
  const PicturePlace place = picture_place(request.camera, point);
  const auto in_px = [&](const glm::dvec2& off) {
    return map_error_px(place, view, exact, near, glm::distance(point, eye_mm_), off);
  };
  const glm::dvec2 off = map_off(view, shown, exact);
  // Splits nearby give the end beyond a better ray, towards the one that it would have if the lens went on.
  // Then interpolation errs most inside [0, share] by c x (1 - x) / 2, where what the known end's
  // differentials tell errs by c share^2 / 2 at `share`.
  const glm::dvec3 step =
      share * (mesh_->mesh().vertices[to].position_mm - mesh_->mesh().vertices[from].position_mm);
  const double by_known = in_px(off - map_off(view, shown, ray_through(known, step, near))),
               later = by_known * (share < 0.5 ? (1 - share) / share : 0.25 / (share * share));
  const double in_map = std::max(in_px(off), later),
               at_exit = surface_error_px(
                   place, known,
                   between(known.surface_point_mm, beyond.surface_point_mm) - exact.surface_point_mm);
  error = std::max({error, in_map, at_exit});
  return std::isfinite(error) ? std::min(error, length_px) : length_px;
}

std::vector<char> PvrrRefinement::whole_groups(std::span<const char> wanted) const {
  const auto edges = mesh_->new_edges();
  std::vector<char> whole(edges.size(), 0);
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].group == edges[begin].group) ++end;
    const auto from = std::ptrdiff_t(begin), to = std::ptrdiff_t(end);
    if (std::find(wanted.begin() + from, wanted.begin() + to, char(1)) != wanted.begin() + to)
      std::fill(whole.begin() + from, whole.begin() + to, char(1));
  }
  return whole;
}

void PvrrRefinement::continue_rays(const RefinementRequest& request) {
  continue_beyond_border(mesh_->mesh(), hits_, kRingsOfRefined);
  open_ = ways_through(mesh_->mesh(), hits_);
  std::vector<std::uint32_t> beyond;
  for (std::uint32_t i = 0; i < hits_.size(); ++i)
    if (hits_[i].faces_eye && !passes(hits_[i])) beyond.push_back(i);
  const auto patch = gathered(std::span<const std::uint32_t>(patch_), beyond);
  auto rays = request.with_scene_hits(gathered(std::span<const VertexHit>(hits_), beyond));
  scene_rays_ += rays.size();
  close_off_maps(rays, patch, request.views);
  const auto coordinates = patch_coordinates_like(gathered(std::span<const glm::dvec3>(coordinates_), beyond),
                                                  rays, patch, request.views);
  for (std::size_t k = 0; k < beyond.size(); ++k) {
    hits_[beyond[k]] = rays[k];
    coordinates_[beyond[k]] = coordinates[k];
  }
}

}  // namespace catoptra::render

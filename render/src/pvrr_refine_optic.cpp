// PvrrOptic: from the mesh as tessellated to the refined one.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "render/src/pvrr_optic.h"

namespace catoptra::render {
namespace {

using optics::OpticKind;
using optics::VertexHit;

// The map of the mesh as tessellated is widened by at most this share of its width on each side for vertices
// between those that it was made for.
constexpr double kMostWider = 0.25;
constexpr double kMargin = 0.01;
constexpr std::size_t kVerticesPerTask = 64;

/// Makes room in `view` for what vertices from `first` on and rays at the `border` show that belong to
/// `patch`, and moves the `coordinates` of that patch along. `patch_of` empty: all belong to it.
void widen(optics::VirtualView& view, std::span<const VertexHit> hits, std::size_t first,
           std::span<const std::uint32_t> patch_of, std::uint32_t patch,
           std::span<const PvrrRefinement::BorderRay> border, std::vector<glm::dvec3>& coordinates) {
  const auto belongs = [&](std::size_t i) { return patch_of.empty() || patch_of[i] == patch; };
  glm::dvec2 low(0), high(1);
  const auto make_room = [&](const glm::dvec3& homogeneous) {
    const glm::dvec2 at = glm::dvec2(homogeneous) / homogeneous.z;
    low = glm::min(low, at - kMargin);
    high = glm::max(high, at + kMargin);
  };
  for (std::size_t i = first; i < hits.size(); ++i)
    if (belongs(i) && passes(hits[i])) make_room(coordinates[i]);
  for (const auto& ray : border)
    if (ray.patch == patch) make_room(ray.coordinates);
  if (view.fov_clamped || (low == glm::dvec2(0) && high == glm::dvec2(1))) return;
  low = glm::max(low, glm::dvec2(-kMostWider));
  high = glm::min(high, glm::dvec2(1 + kMostWider));
  const glm::dvec2 corner(view.left, view.bottom), size(view.right_side - view.left, view.top - view.bottom);
  view.left = corner.x + low.x * size.x;
  view.right_side = corner.x + high.x * size.x;
  view.bottom = corner.y + low.y * size.y;
  view.top = corner.y + high.y * size.y;
  if (view.projection == optics::MapProjection::perspective)
    view.fov_rad = {std::atan(view.right_side) - std::atan(view.left),
                    std::atan(view.top) - std::atan(view.bottom)};
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (!belongs(i)) continue;
    glm::dvec3& c = coordinates[i];
    const glm::dvec2 st = (glm::dvec2(c) - low * c.z) / (high - low);
    c = {st.x, st.y, c.z};
  }
}

}  // namespace

void PvrrOptic::refine(const RasterView& camera, bool remember) {
  const bool lens = optic_.kind == OpticKind::lens;
  const std::span<const VertexHit> hits = lens ? lens_rays_.hits[0] : mirror_hits_;
  refinement_.refine({optic_, cut_mesh(), lens_rays_.entered, tracer_.get(), hits,
                      lens ? std::span<const float>(lens_rays_.open[0]) : std::span<const float>(),
                      cut_coordinates_, views_, patches_.patch, *traced_from_,
                      [this](const glm::dvec3& point) { return arrival_at(point); }, camera,
                      scene_.settings.max_error_px * texels_before_, remember,
                      [this](std::vector<VertexHit> rays) { return with_hits(std::move(rays)); }});
  refinement_rays_ = refinement_.traced_rays();
  scene_rays_ += refinement_.scene_rays();
  refined_ = refinement_.is_refined();
  if (!refined_) {
    traced_rays_ += refinement_rays_;
    return;
  }
  coordinates_.assign(refinement_.coordinates().begin(), refinement_.coordinates().end());
  if (lens) refine_lens(remember);
  traced_rays_ += refinement_rays_;
  for (std::uint32_t patch = 0; patch < views_.size(); ++patch)
    widen(views_[patch], PvrrOptic::hits(), cut_coordinates_.size(), patches_of_seen(), patch,
          refinement_.border_rays(), coordinates_);
}

void PvrrOptic::refine_lens(bool remember) {
  const tessellate::OpticArrays& mesh = refinement_.mesh();
  if (!remember || refinement_.mesh_changed() || refined_from_ != traced_from_) {
    refined_paths_ = further_wavelengths(mesh, cut_coordinates_.size());
    refined_from_ = traced_from_;
  }
  refined_rays_ = {lens_rays_.entered, lens_rays_.samples, {}, {}, {}};
  refined_rays_.hits.emplace_back(refinement_.hits().begin(), refinement_.hits().end());
  refined_rays_.open.emplace_back(refinement_.open().begin(), refinement_.open().end());
  for (std::size_t k = 1; k < lens_rays_.hits.size(); ++k) {
    std::vector<VertexHit> hits = lens_rays_.hits[k];
    hits.insert(hits.end(), refined_paths_[k - 1].begin(), refined_paths_[k - 1].end());
    continue_beyond_border(mesh, hits, kRingsOfRefined);
    refined_rays_.open.push_back(ways_through(mesh, hits));
    // The others have theirs.
    std::vector<std::uint32_t> without;
    for (std::uint32_t i = 0; i < hits.size(); ++i)
      if (hits[i].faces_eye && (i >= cut_coordinates_.size() || !passes(hits[i]))) without.push_back(i);
    scene_rays_ += without.size();
    const auto found = with_hits(gathered(std::span<const VertexHit>(hits), without));
    for (std::size_t i = 0; i < found.size(); ++i) hits[without[i]] = found[i];
    close_off_maps(hits, patches_of_seen(), views_);
    refined_rays_.hits.push_back(std::move(hits));
  }
}

std::vector<std::vector<VertexHit>> PvrrOptic::further_wavelengths(const tessellate::OpticArrays& mesh,
                                                                   std::size_t first) {
  std::vector<std::vector<VertexHit>> of_samples;
  const std::size_t count = mesh.vertices.size() - first;
  for (std::size_t k = 1; k < lens_rays_.samples.size(); ++k) {
    const auto indices = optics::lens_indices(optic_, lens_rays_.samples[k].wavelength_nm);
    std::vector<VertexHit> hits(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kVerticesPerTask), [&](const auto& some) {
      for (std::size_t i = some.begin(); i < some.end(); ++i) {
        const auto& vertex = mesh.vertices[first + i];
        hits[i] = optics::refract_vertex(vertex, optic_, *tracer_, lens_rays_.entered, indices,
                                         arrival_at(vertex.position_mm));
      }
    });
    refinement_rays_ += count;
    of_samples.push_back(std::move(hits));
  }
  return of_samples;
}

}  // namespace catoptra::render

// PvrrOptic: from the mesh as tessellated to the refined one.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "render/src/patch_coordinates.h"
#include "render/src/pvrr_optic.h"

namespace catoptra::render {
namespace {

using optics::OpticKind;
using optics::VertexHit;

// The map of the mesh as tessellated is widened by at most this share of its width on each side for vertices
// between those that it was made for.
constexpr double kMostWider = 0.25;
constexpr double kMargin = 0.01;

/// Makes room in `view` for what vertices from `first` on show that belong to `patch`, and moves the
/// `coordinates` of that patch along. `patch_of` empty: all belong to it.
void widen(optics::VirtualView& view, std::span<const VertexHit> hits, std::size_t first,
           std::span<const std::uint32_t> patch_of, std::uint32_t patch,
           std::vector<glm::dvec3>& coordinates) {
  const auto belongs = [&](std::size_t i) { return patch_of.empty() || patch_of[i] == patch; };
  glm::dvec2 low(0), high(1);
  for (std::size_t i = first; i < hits.size(); ++i) {
    if (!belongs(i) || !passes(hits[i])) continue;
    const glm::dvec2 at = glm::dvec2(coordinates[i]) / coordinates[i].z;
    low = glm::min(low, at - kMargin);
    high = glm::max(high, at + kMargin);
  }
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
  refinement_.refine({optic_, cut_mesh(), lens_rays_.entered, tracer_.get(), hits, cut_coordinates_, views_,
                      patches_.patch, *traced_from_,
                      [this](const glm::dvec3& point) { return arrival_at(point); }, camera,
                      scene_.settings.max_error_px, remember,
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
    widen(views_[patch], PvrrOptic::hits(), cut_coordinates_.size(), patches_of_seen(), patch, coordinates_);
}

void PvrrOptic::refine_lens(bool remember) {
  if (!remember || refinement_.mesh_changed() || refined_from_ != traced_from_) {
    if (refined_lens_.faces.empty()) refined_lens_ = optic_;
    const bool front = lens_rays_.entered == optics::LensSide::front;
    (front ? refined_lens_.mesh : refined_lens_.back.mesh) = refinement_.mesh();
    refined_paths_ = refract_eye_rays(refined_lens_, *tracer_, *traced_from_, lens_rays_.entered,
                                      arrivals(refinement_.mesh()));
    refined_from_ = traced_from_;
    refinement_rays_ += refined_paths_.passed();
  }
  refined_rays_ = refined_paths_;
  for (auto& of_sample : refined_rays_.hits) {
    scene_rays_ += of_sample.size();
    of_sample = with_hits(std::move(of_sample));
    close_off_maps(of_sample, patches_of_seen(), views_);
  }
  // What the refinement has not followed shows what lies beside it: beyond the border of what passes.
  const auto q = coordinates_;
  coordinates_ = patch_coordinates_like(q, refined_rays_.hits[0], patches_of_seen(), views_);
}

}  // namespace catoptra::render

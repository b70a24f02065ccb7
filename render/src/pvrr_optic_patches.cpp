// PvrrOptic: from the vertex hits to patches, each with its view and map coordinates.
#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "optics/map_coordinates.h"
#include "render/src/pvrr_optic.h"
#include "render/src/pvrr_plane_view.h"

namespace catoptra::render {
namespace {

using optics::OpticKind;
using optics::VertexHit;

// Border of a lens map, as a share of its width: room for the wavelengths whose border is not sought, and for
// corners.
constexpr double kLensMargin = 0.02;

/// The rays of all wavelengths that a map has to hold, one list after the other. The borders of the others
/// are those of the reference wavelength within the view's margin.
std::vector<VertexHit> rays_in_map(const LensRays& rays) {
  std::vector<VertexHit> all = rays.border;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].scene_hit = rays.hits[0][i].scene_hit;
    all[i].hit_point_mm = rays.hits[0][i].hit_point_mm;
  }
  for (std::size_t k = 1; k < rays.hits.size(); ++k)
    for (const VertexHit& hit : rays.hits[k]) {
      all.push_back(hit);
      all.back().faces_eye = passes(hit);
    }
  return all;
}

/// The vertices `source` of `rays`.
LensRays part_of(const LensRays& rays, std::span<const std::uint32_t> source) {
  LensRays part{rays.entered, rays.samples, {}, {}, gathered(std::span(rays.border), source)};
  for (const auto& hits : rays.hits) part.hits.push_back(gathered(std::span(hits), source));
  for (const auto& open : rays.open) part.open.push_back(gathered(std::span(open), source));
  return part;
}

}  // namespace

bool PvrrOptic::choose_patches(const RasterView& camera, bool remember) {
  const bool lens = optic_.kind == OpticKind::lens;
  const bool other_side = std::exchange(cut_side_, lens_paths_.entered) != lens_paths_.entered;
  if (other_side) tree_.forget();
  PatchLabels labels;
  if (scene_.settings.max_patches > 1 && !place_.nested && (lens || !is_plane(optic_))) {
    std::vector<VertexHit> hits = lens ? whole_lens_rays_.hits[0] : whole_hits_;
    for (VertexHit& hit : hits) hit.faces_eye = passes(hit);
    // Of no parallax an exact ray is off by any pixels.
    const double px_per_rad = use_ == MapUse::picture ? 0.5 * camera.size.y * camera.projection[1][1] : 0.0;
    labels = tree_.choose({optic_, tessellated_mesh(), hits, optics::in_own_frame(bounds_, placement_),
                           scene_.settings.patch_fov_rad, px_per_rad,
                           std::size_t(scene_.settings.max_patches), remember});
  }
  if (labels.count == 1) labels = {};
  if (labels == labels_ && !other_side) return false;
  set_patches(std::move(labels));
  return true;
}

void PvrrOptic::set_patches(PatchLabels labels) {
  labels_ = std::move(labels);
  patches_ = labels_.count > 1 ? cut_into_patches(tessellated_mesh(), labels_.of_triangle, labels_.count)
                               : PatchMesh();
  refinement_.forget();
  refined_ = false;
  refined_from_.reset();
  own_surface_.reset();
}

void PvrrOptic::fit_patches() {
  const auto bounds = optics::in_own_frame(bounds_, placement_);
  const bool lens = optic_.kind == OpticKind::lens;
  fitted_.clear();
  if (!in_patches()) {
    mirror_hits_ = whole_hits_;
    lens_rays_ = whole_lens_rays_;
    fitted_.push_back(lens ? optics::make_virtual_view(optic_, lens_rays_.entered, rays_in_map(lens_rays_),
                                                       bounds, kLensMargin)
                           : optics::make_virtual_view(optic_, mirror_hits_, bounds));
  } else {
    if (lens)
      lens_rays_ = part_of(whole_lens_rays_, patches_.source);
    else
      mirror_hits_ = gathered(std::span<const VertexHit>(whole_hits_), patches_.source);
    for (std::size_t k = 0; k < patches_.ranges.size(); ++k) {
      const auto source = std::span<const std::uint32_t>(patches_.source)
                              .subspan(patches_.ranges[k].first_vertex, patches_.ranges[k].vertices);
      fitted_.push_back(
          lens
              ? optics::make_virtual_view(optic_, patches_.patches[k],
                                          rays_in_map(part_of(whole_lens_rays_, source)), bounds, kLensMargin)
              : optics::make_virtual_view(optic_, patches_.patches[k],
                                          gathered(std::span<const VertexHit>(whole_hits_), source), bounds));
    }
  }
  for (auto& of_sample : lens_rays_.hits) close_off_maps(of_sample, patches_.patch, fitted_);
}

void PvrrOptic::set_coordinates() {
  const std::span<const VertexHit> hits = optic_.kind == OpticKind::lens ? lens_rays_.hits[0] : mirror_hits_;
  if (!in_patches()) {
    cut_coordinates_ = optics::map_coordinates(optic_, tessellated_mesh(), hits, views_[0]);
    return;
  }
  cut_coordinates_.clear();
  for (std::size_t k = 0; k < views_.size(); ++k) {
    const PatchRange& range = patches_.ranges[k];
    const auto of_patch = optics::map_coordinates(
        optic_, patches_.patches[k], hits.subspan(range.first_vertex, range.vertices), views_[k]);
    cut_coordinates_.insert(cut_coordinates_.end(), of_patch.begin(), of_patch.end());
  }
}

void PvrrOptic::set_surface() {
  const auto& mesh = seen_mesh();
  vertex_count_ = mesh.vertices.size();
  // The scene's own has the map coordinates of what the picture shows.
  const bool shares_surface = !place_.nested || optic_.kind == OpticKind::lens;
  if (!in_patches() && !refined_ && shares_surface) {
    own_surface_.reset();
    return;
  }
  own_surface_ = std::make_unique<RasterOptic>(mesh, false);
  own_surface_->place(placement_);
  if (!in_patches()) return;
  // Refinement leaves the parts of a triangle in its place.
  std::vector<std::size_t> triangles(views_.size(), 0);
  for (const auto& triangle : mesh.triangles) ++triangles[patch_of(triangle.vertices[0])];
  own_surface_->set_parts(triangles);
  std::set<std::array<double, 6>> distinct;
  for (const auto& v : mesh.vertices)
    distinct.insert({v.position_mm.x, v.position_mm.y, v.position_mm.z, v.normal.x, v.normal.y, v.normal.z});
  vertex_count_ = distinct.size();
}

std::vector<OverlayLine> PvrrOptic::viewpoint_lines() const {
  std::vector<OverlayLine> lines;
  for (std::size_t k = 0; faces_eye_ && k < views_.size(); ++k) {
    const glm::dvec3 middle =
        placement_.point(area_centroid(in_patches() ? patches_.patches[k] : tessellated_mesh()));
    const bool parallel = views_[k].projection == optics::MapProjection::parallel;
    lines.push_back({middle, parallel ? middle : placement_.point(views_[k].viewpoint_mm)});
  }
  return lines;
}

const tessellate::OpticArrays& PvrrOptic::tessellated_mesh() const {
  return optic_.kind != OpticKind::lens ? optic_.mesh : *optics::side_of(optic_, lens_paths_.entered).mesh;
}

const tessellate::OpticArrays& PvrrOptic::cut_mesh() const {
  return in_patches() ? patches_.mesh : tessellated_mesh();
}

const tessellate::OpticArrays& PvrrOptic::seen_mesh() const {
  return refined_ ? refinement_.mesh() : cut_mesh();
}

const RasterOptic& PvrrOptic::seen_surface() const {
  if (own_surface_ && faces_eye_) return *own_surface_;
  return optic_.kind != OpticKind::lens ? raster_.optic(index_) : raster_.side(index_, lens_paths_.entered);
}

std::span<const std::uint32_t> PvrrOptic::patches_of_seen() const {
  if (!in_patches()) return {};
  return refined_ ? refinement_.patch() : std::span<const std::uint32_t>(patches_.patch);
}

std::uint32_t PvrrOptic::patch_of(std::size_t vertex) const {
  return in_patches() ? patches_of_seen()[vertex] : 0;
}

}  // namespace catoptra::render

#include "render/src/pvrr_optic.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <utility>

#include "render/src/patch_coordinates.h"
#include "render/src/pvrr_plane_view.h"

namespace catoptra::render {
namespace {

using optics::OpticKind;
using optics::VertexHit;

// Share of its distance from the optic by which the eye may be off before rays are traced anew: what is left
// of a common motion of eye and optic by rounding, in scenes up to 100 km. Rays then are off by 1e-8 rad, a
// sixth of the step of the floats in which map coordinates are drawn.
constexpr double kEyeRounding = 1e-8;

// As in pvrr_optic.frag.glsl and pvrr_lens.frag.glsl.
constexpr GLint kMapShift = 7, kMapRayOrigin = 8, kMapRayDirection = 9, kMapPlace = 10;
constexpr GLuint kMapColorUnit = 2, kMapPositionUnit = 3, kMapDetailUnit = 4;

void set_columns(GLint location, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::mat3 m{glm::vec3(a), glm::vec3(b), glm::vec3(c)};
  glUniformMatrix3fv(location, 1, GL_FALSE, &m[0].x);
}

/// VirtualView::map_ray as two functions affine in (s, t).
void set_map_rays(const optics::VirtualView& view) {
  const glm::dvec3 corner = view.left * view.right + view.bottom * view.up;
  const glm::dvec3 by_s = (view.right_side - view.left) * view.right,
                   by_t = (view.top - view.bottom) * view.up;
  const glm::dvec3 none(0);
  if (view.projection == optics::MapProjection::perspective) {
    set_columns(kMapRayOrigin, view.viewpoint_mm, none, none);
    set_columns(kMapRayDirection, view.direction + corner, by_s, by_t);
  } else {
    set_columns(kMapRayOrigin, view.viewpoint_mm + corner, by_s, by_t);
    set_columns(kMapRayDirection, view.direction, none, none);
  }
}

bool same_view(const RasterView& a, const RasterView& b) {
  return a.origin_mm == b.origin_mm && a.rotation == b.rotation && a.projection == b.projection &&
         a.size == b.size;
}

}  // namespace

PvrrOptic::PvrrOptic(const Scene& scene, std::size_t optic, RasterScene& raster, const optics::RayScene& rays,
                     const cad_import::BoundingBox& bounds, const OpticPlace& place)
    : scene_(scene),
      optic_(scene.optics[optic]),
      index_(optic),
      raster_(raster),
      rays_(rays),
      bounds_(bounds),
      place_(place) {}

void PvrrOptic::optic_changed() {
  tree_.forget();
  set_patches({});
  lens_ = {};
  tracer_.reset();
  traced_from_.reset();
}

void PvrrOptic::set_bounds(const cad_import::BoundingBox& bounds) {
  if (bounds.min == bounds_.min && bounds.max == bounds_.max) return;
  bounds_ = bounds;
  hits_hold_ = false;
}

void PvrrOptic::place(const optics::Placement& placement) {
  if (placement == placement_) return;
  placement_ = placement;
  if (own_surface_) own_surface_->place(placement);
  hits_hold_ = false;
}

void PvrrOptic::update(const RasterView& camera, const FrameOptions& options, double texels_before,
                       const LightWay* above, MapUse use) {
  if (above != above_) traced_from_.reset();
  above_ = above;
  traced_rays_ = scene_rays_ = refinement_rays_ = 0;
  multisample_ = options.multisample;
  const RasterView view = in_own_frame(camera, placement_);
  // Planar glass has no map yet: not there in pvrr, traced in the other modes.
  if (optics::is_planar_glass(optic_))
    faces_eye_ = false;
  else if (!options.reuse_static || !rays_hold(view.origin_mm))
    trace(view.origin_mm);
  if (!faces_eye_) {
    map_.set_empty(options.geometry);
    drawn_.reset();
    return;
  }
  const bool stays = hits_hold_;
  if (!stays) find_hits();
  const bool same_texels = std::exchange(texels_before_, texels_before) == texels_before;
  const bool same_use = std::exchange(use_, use) == use;
  if (!stays || !same_texels || !same_use || !fitted_for_ || !same_view(*fitted_for_, view))
    fit(view, !stays, options.reuse_static);
  map_.resize(layout_, options.geometry);
}

bool PvrrOptic::rays_hold(const glm::dvec3& eye_mm) const {
  if (above_ && above_->changes() != traced_above_) return false;
  return traced_from_ && glm::distance(*traced_from_, eye_mm) <=
                             kEyeRounding * glm::distance(eye_mm, raster_.optic(index_).center_mm());
}

void PvrrOptic::trace(const glm::dvec3& eye_mm) {
  traced_from_ = eye_mm;
  if (above_) traced_above_ = above_->changes();
  ++traces_;
  hits_hold_ = false;
  light_.reset();
  const auto arrival = [this](const glm::dvec3& point) { return arrival_at(point); };
  if (optic_.kind == OpticKind::mirror) {
    const std::vector<optics::Arrival> arriving = arrivals_at(optic_.mesh, arrival);
    mirror_rays_.clear();
    for (std::size_t i = 0; i < arriving.size(); ++i)
      mirror_rays_.push_back(optics::reflect_vertex(optic_.mesh.vertices[i], optic_, arriving[i]));
    ray_count_ = static_cast<std::size_t>(std::count_if(mirror_rays_.begin(), mirror_rays_.end(),
                                                        [](const VertexHit& h) { return h.faces_eye; }));
    light_.emplace(optic_, optics::LensSide::front, nullptr, optics::LensIndices(), mirror_rays_, arrival);
  } else {
    if (!tracer_) tracer_ = std::make_unique<optics::LensTracer>(optic_);
    const optics::LensSide entered = optics::side_towards(optic_, eye_mm);
    lens_paths_ = refract_eye_rays(optic_, *tracer_, entered, arrival);
    ray_count_ = lens_paths_.passed();
    light_.emplace(optic_, entered, tracer_.get(),
                   optics::lens_indices(optic_, lens_paths_.samples[0].wavelength_nm), lens_paths_.hits[0],
                   arrival);
  }
  traced_rays_ = ray_count_;
  faces_eye_ = ray_count_ > 0;
}

optics::Arrival PvrrOptic::arrival_at(const glm::dvec3& own_point_mm) const {
  if (above_)
    if (const auto light = above_->light_to(placement_.point(own_point_mm))) {
      const glm::dmat3 &to_world = placement_.rotation, to_own = glm::transpose(to_world);
      return {placement_.own_point(light->origin_mm), placement_.own_direction(light->direction),
              to_own * light->turn * to_world, light->beyond_mm};
    }
  return optics::arrival_from_eye(*traced_from_, own_point_mm);
}

std::optional<optics::Arrival> PvrrOptic::light_to(const glm::dvec3& point_mm) const {
  if (!light_) return std::nullopt;
  auto light = light_->to(placement_.own_point(point_mm));
  if (!light) return std::nullopt;
  const glm::dmat3 &to_world = placement_.rotation, to_own = glm::transpose(to_world);
  return optics::Arrival{placement_.point(light->origin_mm), placement_.direction(light->direction),
                         to_world * light->turn * to_own, light->beyond_mm};
}

void PvrrOptic::find_hits() {
  hits_hold_ = true;
  scene_rays_ = ray_count_;
  if (optic_.kind == OpticKind::mirror) {
    whole_hits_ = with_hits(mirror_rays_);
    return;
  }
  whole_lens_rays_ = lens_paths_;
  auto& hits = whole_lens_rays_.hits;
  tbb::parallel_for(std::size_t(0), hits.size(),
                    [&](std::size_t k) { hits[k] = with_hits(std::move(hits[k])); });
}

std::vector<VertexHit> PvrrOptic::with_hits(std::vector<VertexHit> rays) const {
  const auto find = [&](std::vector<VertexHit> in_world) {
    in_world = optics::find_scene_hits(std::move(in_world), rays_);
    if (place_.bodies) place_.bodies->add_hits(in_world, index_, place_.shows_lenses, rays_);
    return in_world;
  };
  if (placement_ == optics::Placement()) return find(std::move(rays));
  std::vector<VertexHit> in_world = rays;
  for (VertexHit& ray : in_world) {
    ray.surface_point_mm = placement_.point(ray.surface_point_mm);
    ray.direction = placement_.direction(ray.direction);
  }
  in_world = find(std::move(in_world));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].scene_hit = in_world[i].scene_hit;
    rays[i].hit_point_mm = placement_.own_point(in_world[i].hit_point_mm);
  }
  return rays;
}

void PvrrOptic::fit(const RasterView& camera, bool hits_anew, bool remember) {
  fitted_for_ = camera;
  const bool was_on_grid = on_pixel_grid_;
  const bool cut_anew = choose_patches(camera, remember) || hits_anew;
  if (cut_anew) fit_patches();
  const auto plane = optic_.kind == OpticKind::mirror && !in_patches()
                         ? plane_view(optic_, camera, fitted_[0], optics::in_own_frame(bounds_, placement_))
                         : std::optional<PlaneView>();
  on_pixel_grid_ = plane.has_value();
  const bool refines = scene_.settings.max_error_px > 0 && !plane && use_ == MapUse::picture;
  if (cut_anew || plane || was_on_grid || refines) {
    views_ = plane ? std::vector{plane->view} : fitted_;
    if (cut_anew || plane || was_on_grid) set_coordinates();
    coordinates_ = cut_coordinates_;
    const bool was_refined = std::exchange(refined_, false);
    if (refines) refine(camera, remember);
    const bool mesh_changed = cut_anew || was_refined != refined_ || (refined_ && refinement_.mesh_changed());
    if (mesh_changed) set_surface();
    // Another picture of the same mesh from the same place needs the same maps.
    if (mesh_changed || plane || was_on_grid) {
      show();
      drawn_.reset();
    }
  }
  if (plane)
    set_layout({{plane->texels, texels_before_}});
  else
    set_map_sizes(camera);
}

void PvrrOptic::set_map_sizes(const RasterView& camera) {
  std::vector<glm::dvec3> pixels;
  pixels.reserve(coordinates_.size());
  for (std::size_t i = 0; i < coordinates_.size(); ++i)
    pixels.push_back(hits()[i].faces_eye ? camera.pixel(seen_mesh().vertices[i].position_mm) : glm::dvec3(0));
  const auto size_of = [&](const tessellate::OpticArrays& mesh, const optics::VirtualView& view) {
    PvrrMapSize size = choose_map_size(mesh, pixels, coordinates_, view, camera.size,
                                       scene_.settings.texels_per_pixel / texels_before_);
    size.texels_per_pixel *= texels_before_;
    return size;
  };
  if (!in_patches()) {
    set_layout({size_of(seen_mesh(), views_[0])});
    return;
  }
  std::vector<tessellate::OpticArrays> parts(views_.size());
  for (const auto& triangle : seen_mesh().triangles)
    parts[patch_of(triangle.vertices[0])].triangles.push_back(triangle);
  std::vector<PvrrMapSize> sizes;
  for (std::size_t k = 0; k < parts.size(); ++k) sizes.push_back(size_of(parts[k], views_[k]));
  set_layout(std::move(sizes));
}

void PvrrOptic::set_layout(std::vector<PvrrMapSize> sizes) {
  const bool same = std::equal(sizes.begin(), sizes.end(), map_sizes_.begin(), map_sizes_.end(),
                               [](const PvrrMapSize& a, const PvrrMapSize& b) {
                                 return a.texels == b.texels && a.texels_per_pixel == b.texels_per_pixel;
                               });
  if (same) return;
  drawn_.reset();
  map_sizes_ = std::move(sizes);
  std::vector<glm::ivec2> texels;
  for (const PvrrMapSize& size : map_sizes_) texels.push_back(size.texels);
  layout_ = lay_out(texels);
}

void PvrrOptic::show() {
  if (optic_.kind == OpticKind::mirror) {
    RasterOptic& surface = own_surface_ ? *own_surface_ : raster_.optic(index_);
    surface.set_map_coordinates(coordinates_);
    return;
  }
  lens_.set_shown(seen_surface(), raster_.exit_mask(index_, optics::other_side(lens_rays_.entered)),
                  shown_rays(), lens_coordinates());
}

std::vector<std::vector<glm::dvec3>> PvrrOptic::lens_coordinates() const {
  const LensRays& rays = shown_rays();
  std::vector<std::vector<glm::dvec3>> of_samples{coordinates_};
  for (std::size_t k = 1; k < rays.hits.size(); ++k)
    of_samples.push_back(patch_coordinates_like(coordinates_, rays.hits[k], patches_of_seen(), views_));
  return of_samples;
}

bool PvrrOptic::draw_map(glm::dvec2 offset_px, bool geometry, Overlay* overlay,
                         std::span<const NestedOptics> nested) {
  if (!faces_eye_) return false;
  const glm::dvec2 offset = map_offset(offset_px);
  const Drawn wanted{offset, geometry, overlay ? 1 : multisample_, use_};
  if (!overlay && drawn_ == wanted) return false;
  const RasterOptic& last = optic_.kind == OpticKind::mirror
                                ? raster_.optic(index_)
                                : raster_.side(index_, optics::other_side(lens_rays_.entered));
  map_.set_multisample(wanted.multisample);  // overlays are drawn over the map as it is
  for (std::size_t patch = 0; patch < views_.size(); ++patch)
    map_.draw(raster_, index_, last, patch, placed(views_[patch], placement_),
              map_sizes_[patch].texels_per_pixel, offset, geometry, overlay,
              patch < nested.size() ? &nested[patch] : nullptr, unseen_in(patch));
  drawn_ = wanted;
  if (overlay) drawn_.reset();
  return true;
}

std::vector<TexelRect> PvrrOptic::unseen_in(std::size_t patch) const {
  if (use_ == MapUse::picture) return {};
  return unseen_parts(seen_mesh(), coordinates_, patches_of_seen(), std::uint32_t(patch),
                      layout_.places[patch]);
}

RasterView PvrrOptic::map_camera(std::size_t patch) const {
  const AtlasPlace& place = layout_.places[patch];
  return map_view(with_guard(placed(views_[patch], placement_), place.texels, place.guard),
                  place.texels + 2 * place.guard);
}

void PvrrOptic::set_map(std::size_t patch, glm::dvec2 offset_px, bool geometry) const {
  const RasterTarget& target = map_.target();
  const glm::dvec2 shift = -map_offset(offset_px) / glm::dvec2(target.size());
  glUniform2f(kMapShift, static_cast<float>(shift.x), static_cast<float>(shift.y));
  const glm::vec4 place = map_.layout().place(faces_eye_ ? patch : 0);
  glUniform4f(kMapPlace, place.x, place.y, place.z, place.w);
  glBindTextureUnit(kMapColorUnit, target.color().id());
  if (!geometry) return;
  if (patch < views_.size()) set_map_rays(placed(views_[patch], placement_));
  glBindTextureUnit(kMapPositionUnit, target.position().id());
  glBindTextureUnit(kMapDetailUnit, target.detail().id());
}

std::span<const VertexHit> PvrrOptic::hits() const {
  if (optic_.kind == OpticKind::lens) return shown_rays().hits[0];
  return refined_ ? refinement_.hits() : mirror_hits_;
}

const LensRays& PvrrOptic::shown_rays() const {
  return refined_ ? refined_rays_ : lens_rays_;
}

glm::dvec2 PvrrOptic::map_offset(glm::dvec2 offset_px) const {
  // In general the map's samples move within its texels as the picture's do within pixels, but not in step
  // with them.
  return on_pixel_grid_ ? plane_view_offset(offset_px) : glm::dvec2(offset_px.y, offset_px.x);
}

OpticStats PvrrOptic::statistics() const {
  OpticStats stats{optic_.name,
                   optics::kind_name(optic_.kind),
                   faces_eye_ ? vertex_count_ : tessellated_mesh().vertices.size(),
                   traced_rays_,
                   scene_rays_,
                   {},
                   refinement_rays_};
  if (!faces_eye_) return stats;
  for (std::size_t k = 0; k < views_.size(); ++k)
    stats.patches.push_back({placement_.point(views_[k].viewpoint_mm),
                             views_[k].residual_mm,
                             {views_[k].fov_rad.x, views_[k].fov_rad.y},
                             {map_sizes_[k].texels.x, map_sizes_[k].texels.y}});
  return stats;
}

optics::ViewRegions PvrrOptic::regions() const {
  optics::ViewRegions regions;
  if (!faces_eye_) return regions;
  std::vector<std::vector<optics::VertexHit>> of_patch(views_.size());
  for (std::size_t i = 0; i < hits().size(); ++i) of_patch[patch_of(i)].push_back(hits()[i]);
  for (std::size_t patch = 0; patch < views_.size(); ++patch)
    regions += optics::view_regions(of_patch[patch], views_[patch]);
  return regions;
}

std::optional<std::string> PvrrOptic::warning() const {
  if (!faces_eye_ || !refined_ || !(refinement_.error_left_px() > 0)) return std::nullopt;
  std::array<char, 16> error{};
  std::snprintf(error.data(), error.size(), "%.2g", refinement_.error_left_px());
  return optic_.name + ": its mesh stays at " + std::to_string(vertex_count_) + " vertices (at most " +
         std::to_string(kMostRefinedVertices) + "), where edges are off by up to " + error.data() + " px";
}

}  // namespace catoptra::render

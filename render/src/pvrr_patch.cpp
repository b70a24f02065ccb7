#include "render/src/pvrr_patch.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "optics/map_coordinates.h"
#include "render/src/pvrr_plane_view.h"

namespace catoptra::render {
namespace {

using optics::OpticKind;
using optics::VertexHit;

// Border of a lens map, as a share of its width: room for the wavelengths whose border is not sought, and for
// corners.
constexpr double kLensMargin = 0.02;

// Share of its distance from the optic by which the eye may be off before rays are traced anew: what is left
// of a common motion of eye and optic by rounding, in scenes up to 100 km. Rays then are off by 1e-8 rad, a
// sixth of the step of the floats in which map coordinates are drawn.
constexpr double kEyeRounding = 1e-8;

constexpr std::size_t kVerticesPerTask = 64;

// As in pvrr_optic.frag.glsl and pvrr_lens.frag.glsl.
constexpr GLint kMapShift = 7, kMapRayOrigin = 8, kMapRayDirection = 9;
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

}  // namespace

PvrrPatch::PvrrPatch(const Scene& scene, std::size_t optic, RasterScene& raster, const optics::RayScene& rays,
                     const cad_import::BoundingBox& bounds, const PatchPlace& place)
    : scene_(scene),
      optic_(scene.optics[optic]),
      index_(optic),
      raster_(raster),
      rays_(rays),
      bounds_(bounds),
      place_(place) {}

void PvrrPatch::optic_changed() {
  refinement_.forget();
  refined_surface_.reset();
  refined_lens_ = {};
  refined_from_.reset();
  tracer_.reset();
  traced_from_.reset();
  own_surface_.reset();
}

void PvrrPatch::set_bounds(const cad_import::BoundingBox& bounds) {
  if (bounds.min == bounds_.min && bounds.max == bounds_.max) return;
  bounds_ = bounds;
  hits_hold_ = false;
}

void PvrrPatch::place(const optics::Placement& placement) {
  if (placement == placement_) return;
  placement_ = placement;
  if (refined_surface_) refined_surface_->place(placement);
  if (own_surface_) own_surface_->place(placement);
  hits_hold_ = false;
}

void PvrrPatch::update(const RasterView& camera, const FrameOptions& options, double texels_before,
                       const PvrrPatch* above) {
  above_ = above;
  traced_rays_ = scene_rays_ = refinement_rays_ = 0;
  const RasterView view = in_own_frame(camera, placement_);
  if (!options.reuse_static || !rays_hold(view.origin_mm)) trace(view.origin_mm);
  if (!faces_eye_) {
    map_.set_empty(options.geometry);
    drawn_.reset();
    return;
  }
  bool stays = hits_hold_;
  if (!stays) find_hits();
  stays = stays && texels_before == texels_before_;
  texels_before_ = texels_before;
  if (!stays || !fitted_for_ || !same_view(*fitted_for_, view)) fit(view, !stays, options.reuse_static);
  map_.resize(map_size_, options.geometry);
}

bool PvrrPatch::rays_hold(const glm::dvec3& eye_mm) const {
  if (above_ && above_->traces_ != traced_above_) return false;
  return traced_from_ && glm::distance(*traced_from_, eye_mm) <=
                             kEyeRounding * glm::distance(eye_mm, raster_.optic(index_).center_mm());
}

void PvrrPatch::trace(const glm::dvec3& eye_mm) {
  traced_from_ = eye_mm;
  if (above_) traced_above_ = above_->traces_;
  ++traces_;
  hits_hold_ = false;
  light_.reset();
  const auto arrival = [this](const glm::dvec3& point) { return arrival_at(point); };
  if (optic_.kind == OpticKind::mirror) {
    const std::vector<optics::Arrival> arriving = arrivals(optic_.mesh);
    mirror_rays_.clear();
    for (std::size_t i = 0; i < arriving.size(); ++i)
      mirror_rays_.push_back(optics::reflect_vertex(optic_.mesh.vertices[i], optic_, arriving[i]));
    ray_count_ = static_cast<std::size_t>(std::count_if(mirror_rays_.begin(), mirror_rays_.end(),
                                                        [](const VertexHit& h) { return h.faces_eye; }));
    light_.emplace(optic_, optics::LensSide::front, nullptr, optics::LensIndices(), mirror_rays_, arrival);
  } else {
    if (!tracer_) tracer_ = std::make_unique<optics::LensTracer>(optic_);
    const optics::LensSide entered = optics::side_towards(optic_, eye_mm);
    lens_paths_ =
        refract_eye_rays(optic_, *tracer_, eye_mm, entered, arrivals(*optics::side_of(optic_, entered).mesh));
    ray_count_ = lens_paths_.passed();
    light_.emplace(optic_, entered, tracer_.get(),
                   optics::lens_indices(optic_, lens_paths_.samples[0].wavelength_nm), lens_paths_.hits[0],
                   arrival);
  }
  traced_rays_ = ray_count_;
  faces_eye_ = ray_count_ > 0;
}

optics::Arrival PvrrPatch::arrival_at(const glm::dvec3& own_point_mm) const {
  if (above_)
    if (const auto light = above_->light_to(placement_.point(own_point_mm))) {
      const glm::dmat3 &to_world = placement_.rotation, to_own = glm::transpose(to_world);
      return {placement_.own_point(light->origin_mm), placement_.own_direction(light->direction),
              to_own * light->turn * to_world};
    }
  return optics::arrival_from_eye(*traced_from_, own_point_mm);
}

std::vector<optics::Arrival> PvrrPatch::arrivals(const tessellate::OpticArrays& mesh) const {
  std::vector<optics::Arrival> arrivals(mesh.vertices.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, arrivals.size(), kVerticesPerTask),
                    [&](const auto& some) {
                      for (std::size_t i = some.begin(); i < some.end(); ++i)
                        arrivals[i] = arrival_at(mesh.vertices[i].position_mm);
                    });
  return arrivals;
}

std::optional<optics::Arrival> PvrrPatch::light_to(const glm::dvec3& point_mm) const {
  if (!light_) return std::nullopt;
  auto light = light_->to(placement_.own_point(point_mm));
  if (!light) return std::nullopt;
  const glm::dmat3 &to_world = placement_.rotation, to_own = glm::transpose(to_world);
  return optics::Arrival{placement_.point(light->origin_mm), placement_.direction(light->direction),
                         to_world * light->turn * to_own};
}

void PvrrPatch::find_hits() {
  hits_hold_ = true;
  scene_rays_ = ray_count_;
  const auto bounds = optics::in_own_frame(bounds_, placement_);
  if (optic_.kind == OpticKind::mirror) {
    mirror_hits_ = with_hits(mirror_rays_);
    fitted_ = optics::make_virtual_view(optic_, mirror_hits_, bounds);
    return;
  }
  lens_rays_ = lens_paths_;
  tbb::parallel_for(std::size_t(0), lens_rays_.hits.size(),
                    [&](std::size_t k) { lens_rays_.hits[k] = with_hits(std::move(lens_rays_.hits[k])); });
  fitted_ =
      optics::make_virtual_view(optic_, lens_rays_.entered, rays_in_map(lens_rays_), bounds, kLensMargin);
  for (auto& of_sample : lens_rays_.hits) close_off_map(of_sample, fitted_);
}

std::vector<VertexHit> PvrrPatch::with_hits(std::vector<VertexHit> rays) const {
  const auto find = [&](std::vector<VertexHit> in_world) {
    in_world = optics::find_scene_hits(std::move(in_world), rays_);
    if (place_.bodies) place_.bodies->add_hits(in_world, index_, place_.shows_lenses);
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

void PvrrPatch::fit(const RasterView& camera, bool hits_anew, bool remember) {
  fitted_for_ = camera;
  const bool was_on_grid = on_pixel_grid_;
  const auto plane = optic_.kind == OpticKind::mirror
                         ? plane_view(optic_, camera, fitted_, optics::in_own_frame(bounds_, placement_))
                         : std::optional<PlaneView>();
  on_pixel_grid_ = plane.has_value();
  const bool refines = scene_.settings.max_error_px > 0 && !plane;
  if (hits_anew || plane || was_on_grid || refines) {
    view_ = plane ? plane->view : fitted_;
    if (hits_anew || plane || was_on_grid) set_coordinates();
    coordinates_ = tessellated_coordinates_;
    if (refines)
      refine(camera, remember);
    else
      refined_surface_.reset();
    // Another picture of the same mesh from the same place needs the same map.
    if (hits_anew || plane || was_on_grid || refinement_.mesh_changed()) {
      show();
      drawn_.reset();
    }
  }
  if (plane) {
    set_map_size({plane->texels, texels_before_});
    return;
  }
  std::vector<glm::dvec3> pixels;
  pixels.reserve(coordinates_.size());
  for (std::size_t i = 0; i < coordinates_.size(); ++i)
    pixels.push_back(hits()[i].faces_eye ? camera.pixel(seen_mesh().vertices[i].position_mm) : glm::dvec3(0));
  PvrrMapSize size = choose_map_size(seen_mesh(), pixels, coordinates_, view_, camera.size,
                                     scene_.settings.texels_per_pixel / texels_before_);
  size.texels_per_pixel *= texels_before_;
  set_map_size(size);
}

void PvrrPatch::set_map_size(const PvrrMapSize& size) {
  if (size.texels != map_size_.texels || size.texels_per_pixel != map_size_.texels_per_pixel) drawn_.reset();
  map_size_ = size;
}

void PvrrPatch::set_coordinates() {
  tessellated_coordinates_ =
      optic_.kind == OpticKind::mirror
          ? optics::map_coordinates(optic_, mirror_hits_, view_)
          : optics::map_coordinates(optic_, lens_rays_.entered, lens_rays_.hits[0], view_);
}

void PvrrPatch::show() {
  if (optic_.kind == OpticKind::mirror) {
    if (place_.nested && !own_surface_) {
      own_surface_ = std::make_unique<RasterOptic>(optic_.mesh, false);
      own_surface_->place(placement_);
    }
    mirror_surface().set_map_coordinates(coordinates_);
    return;
  }
  lens_.set_shown(seen_surface(), raster_.exit_mask(index_, optics::other_side(lens_rays_.entered)),
                  shown_rays(), lens_coordinates());
}

std::vector<std::vector<glm::dvec3>> PvrrPatch::lens_coordinates() const {
  const LensRays& rays = shown_rays();
  std::vector<std::vector<glm::dvec3>> of_samples{coordinates_};
  for (std::size_t k = 1; k < rays.hits.size(); ++k)
    of_samples.push_back(optics::map_coordinates_like(coordinates_, rays.hits[k], view_));
  return of_samples;
}

bool PvrrPatch::draw_map(glm::dvec2 offset_px, bool geometry, Overlay* overlay, const NestedOptics* nested) {
  if (!faces_eye_) return false;
  const glm::dvec2 offset = map_offset(offset_px);
  if (!overlay && drawn_ && drawn_->offset_px == offset && drawn_->geometry == geometry) return false;
  const RasterOptic& last = optic_.kind == OpticKind::mirror
                                ? raster_.optic(index_)
                                : raster_.side(index_, optics::other_side(lens_rays_.entered));
  map_.draw(raster_, index_, last, placed(view_, placement_), offset, geometry, nested);
  drawn_ = {offset, geometry};
  if (!overlay) return true;
  map_.target().bind(false);
  overlay->draw_in_scene(map_.view(), map_.clip_depth());
  drawn_.reset();
  return true;
}

void PvrrPatch::set_map(glm::dvec2 offset_px, bool geometry) const {
  const RasterTarget& target = map_.target();
  const glm::dvec2 shift = -map_offset(offset_px) / glm::dvec2(target.size());
  glUniform2f(kMapShift, static_cast<float>(shift.x), static_cast<float>(shift.y));
  glBindTextureUnit(kMapColorUnit, target.color().id());
  if (!geometry) return;
  set_map_rays(placed(view_, placement_));
  glBindTextureUnit(kMapPositionUnit, target.position().id());
  glBindTextureUnit(kMapDetailUnit, target.detail().id());
}

std::span<const VertexHit> PvrrPatch::hits() const {
  if (optic_.kind == OpticKind::lens) return shown_rays().hits[0];
  return refined_surface_ ? refinement_.hits() : mirror_hits_;
}

const LensRays& PvrrPatch::shown_rays() const {
  return refined_surface_ ? refined_rays_ : lens_rays_;
}

const RasterOptic& PvrrPatch::seen_surface() const {
  if (optic_.kind == OpticKind::mirror) return mirror_surface();
  return refined_surface_ ? *refined_surface_ : raster_.side(index_, lens_rays_.entered);
}

RasterOptic& PvrrPatch::mirror_surface() const {
  if (refined_surface_) return *refined_surface_;
  return own_surface_ ? *own_surface_ : raster_.optic(index_);
}

RasterView PvrrPatch::map_camera() const {
  return map_view(placed(view_, placement_), map_.size().texels);
}

const tessellate::OpticArrays& PvrrPatch::seen_mesh() const {
  if (refined_surface_) return refinement_.mesh();
  return optic_.kind == OpticKind::mirror ? optic_.mesh : *optics::side_of(optic_, lens_rays_.entered).mesh;
}

glm::dvec2 PvrrPatch::map_offset(glm::dvec2 offset_px) const {
  // In general the map's samples move within its texels as the picture's do within pixels, but not in step
  // with them.
  return on_pixel_grid_ ? plane_view_offset(offset_px) : glm::dvec2(offset_px.y, offset_px.x);
}

OpticStats PvrrPatch::statistics() const {
  OpticStats stats{optic_.name,
                   optic_.kind == OpticKind::mirror ? "mirror" : "lens",
                   seen_mesh().vertices.size(),
                   traced_rays_,
                   scene_rays_,
                   {},
                   refinement_rays_};
  if (faces_eye_)
    stats.patches.push_back(
        {placement_.point(view_.viewpoint_mm), view_.residual_mm, {view_.fov_rad.x, view_.fov_rad.y}});
  return stats;
}

std::optional<std::string> PvrrPatch::warning() const {
  if (!faces_eye_ || !refined_surface_ || !(refinement_.error_left_px() > 0)) return std::nullopt;
  std::array<char, 16> error{};
  std::snprintf(error.data(), error.size(), "%.2g", refinement_.error_left_px());
  return optic_.name + ": its mesh stays at " + std::to_string(seen_mesh().vertices.size()) +
         " vertices (at most " + std::to_string(kMostRefinedVertices) + "), where edges are off by up to " +
         error.data() + " px";
}

}  // namespace catoptra::render

#include "render/src/pvrr_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "render/src/lens_rays.h"
#include "render/src/sampling.h"
#include "render/src/view_warnings.h"

namespace catoptra::render {
namespace {

// How large a ball is to appear in the mirror, and how long the line of a ray that meets nothing is drawn.
constexpr double kBallRadiusPx = 4.0;
constexpr double kMissedRayLength = 2000;

/// A length at `point_mm` that appears `pixels` long in a picture for which the map was made.
double length_in_map(const optics::VirtualView& view, const PvrrMapSize& size, const glm::dvec3& point_mm,
                     double pixels) {
  const double per_texel = (view.top - view.bottom) / size.texels.y;
  const double distance = view.projection == optics::MapProjection::perspective
                              ? std::abs(glm::dot(point_mm - view.viewpoint_mm, view.direction))
                              : 1.0;
  return pixels * size.texels_per_pixel * per_texel * distance;
}

}  // namespace

PvrrFrame::PvrrFrame(const Scene& scene, RasterScene& raster, const optics::RayScene& rays,
                     const cad_import::BoundingBox& bounds)
    : scene_(scene), raster_(raster), stack_(scene, raster, rays, bounds) {
  outside_counter_ =
      make_dynamic_buffer(sizeof(std::uint32_t) * std::max<std::size_t>(1, scene.optics.size()));
}

void PvrrFrame::optic_changed(std::size_t index, const cad_import::BoundingBox& bounds) {
  stack_.optic_changed(index, bounds);
}

void PvrrFrame::place_optic(std::size_t index, const optics::Placement& placement,
                            const cad_import::BoundingBox& bounds) {
  stack_.place_optic(index, placement, bounds);
}

void PvrrFrame::update(const Camera& camera, const FrameOptions& options, int levels, MapUse use) {
  stack_.update(camera_view(camera, {options.width, options.height}), camera.sample, options, levels, use);
}

void PvrrFrame::draw_maps(glm::dvec2 offset_px, bool geometry, Overlay* overlay) {
  stack_.draw_maps(offset_px, geometry, overlay);
}

void PvrrFrame::copy_maps(MapColors& maps) const {
  maps.clear(stack_.size());
  for (std::size_t i = 0; i < stack_.size(); ++i) {
    if (!stack_.optic(i).faces_eye()) continue;
    if (const PvrrOptic* const curved = stack_.curved(i))
      maps.add(i, curved->map().views(), curved->map().target());
    else
      stack_.planar(i)->copy_maps(maps);
  }
}

RenderResult PvrrFrame::render(const Camera& camera, const FrameOptions& options, RasterPicture& picture) {
  RenderResult result;
  double trace_ms = 0, pass1_ms = 0, pass2_ms = 0, readback_ms = 0;
  const glm::ivec2 size(options.width, options.height);
  Overlay* const overlay = options.overlay_vertices || options.overlay_rays ? &overlay_ : nullptr;
  const double total_ms = gl_time_ms([&] {
    trace_ms = gl_time_ms([&] {
      picture.begin(options);
      update(camera, options, scene_.settings.depth, MapUse::picture);
      set_overlay(options);
    });
    const glm::dvec2 offset = camera.offset_px;
    pass1_ms = gl_time_ms([&] { draw_maps(offset, options.geometry, overlay); });
    pass2_ms = gl_time_ms([&] {
      for (const auto& pass : picture.passes(options.geometry)) {
        if (picture.summed() == 0) count_anew();
        draw_picture(*pass.target, camera_view(camera, size, offset), offset, pass.geometry, options);
      }
      picture.add_sample();
    });
    if (options.read_back) readback_ms = gl_time_ms([&] { result.frame = picture.read_back(); });
  });

  result.stats = statistics();
  result.stats.time_ms = {{"trace", trace_ms}, {"pass1", pass1_ms}, {"pass2", pass2_ms}, {"total", total_ms}};
  if (options.read_back) result.stats.time_ms["readback"] = readback_ms;
  add_shadows(raster_.take_shadow_statistics(), result.stats);
  result.warnings = map_warnings();
  for (std::size_t i = 0; i < stack_.size(); ++i) {
    const PvrrOptic* const optic = stack_.curved(i);
    if (!optic) continue;
    if (auto warning = optic->warning()) result.warnings.push_back(std::move(*warning));
    if (auto warning = region_warning(scene_.optics[i].name, optic->regions()))
      result.warnings.push_back(std::move(*warning));
  }
  for (std::string& warning : stack_.warnings()) result.warnings.push_back(std::move(warning));
  return result;
}

void PvrrFrame::count_anew() const {
  const std::vector<std::uint32_t> zeros(std::max<std::size_t>(1, stack_.size()), 0);
  update_buffer(outside_counter_, std::as_bytes(std::span(zeros)));
}

std::vector<std::string> PvrrFrame::map_warnings() const {
  std::vector<std::string> warnings;
  std::vector<std::uint32_t> outside(stack_.size(), 0);
  if (!outside.empty())
    glGetNamedBufferSubData(outside_counter_.id(), 0,
                            static_cast<GLsizeiptr>(outside.size() * sizeof(std::uint32_t)), outside.data());
  for (std::size_t i = 0; i < outside.size(); ++i)
    if (outside[i] > 0)
      warnings.push_back(scene_.optics[i].name + ": its map does not reach " + std::to_string(outside[i]) +
                         (scene_.optics[i].kind == optics::OpticKind::lens
                              ? " samples, which show the map's border instead"
                              : " samples, which show the sky instead"));
  return warnings;
}

void PvrrFrame::set_overlay(const FrameOptions& options) {
  std::vector<OverlayBall> balls;
  std::vector<OverlayLine> lines;
  for (std::size_t k = 0; k < stack_.size(); ++k) {
    if (!stack_.curved(k) || !stack_.optic(k).faces_eye()) continue;
    const PvrrOptic& optic = *stack_.curved(k);
    for (std::size_t i = 0; i < optic.hits().size(); ++i) {
      const optics::VertexHit& hit = optic.hits()[i];
      if (!passes(hit)) continue;
      const optics::Placement& at = optic.placement();
      if (options.overlay_vertices && hit.scene_hit)
        balls.push_back({at.point(hit.hit_point_mm),
                         length_in_map(optic.view(i), optic.map_size(i), hit.hit_point_mm, kBallRadiusPx)});
      if (options.overlay_rays)
        lines.push_back({at.point(hit.surface_point_mm),
                         at.point(hit.scene_hit ? hit.hit_point_mm
                                                : hit.surface_point_mm + kMissedRayLength * hit.direction)});
    }
  }
  overlay_.set_balls(balls);
  overlay_.set_lines(lines);
}

void PvrrFrame::draw_picture(const RasterTarget& target, const RasterView& camera, glm::dvec2 offset_px,
                             bool geometry, const FrameOptions& options) {
  RasterPass pass;
  pass.geometry = geometry;
  pass.multisample = target.multisample();
  target.bind(geometry);
  raster_.clear(camera, pass);
  // First the optics, which hide much and cost little.
  for (std::size_t i = 0; i < stack_.size(); ++i) draw_optic(i, target, camera, offset_px, geometry);
  raster_.draw_all(camera, pass);
  if (!options.overlay_vertices && !options.overlay_rays && !options.overlay_patches) return;
  // Overlays have no geometry of their own: what they cover keeps its.
  target.bind(false);
  overlay_.draw_in_scene(camera, nullptr);
  for (std::size_t i = 0; options.overlay_patches && i < stack_.size(); ++i) {
    const PvrrOptic* const optic = stack_.curved(i);
    if (optic && optic->faces_eye())
      overlay_.draw_patches(camera, optic->seen_surface(), optic->viewpoint_lines());
  }
  if (!options.overlay_vertices) return;
  for (std::size_t i = 0; i < stack_.size(); ++i) 
    overlay_.draw_mesh(camera, stack_.curved(i) ? stack_.curved(i)->seen_surface() : raster_.optic(i));
}

void PvrrFrame::draw_optic(std::size_t index, const RasterTarget& target, const RasterView& camera,
                           glm::dvec2 offset_px, bool geometry) {
  glBindBufferRange(GL_ATOMIC_COUNTER_BUFFER, 0, outside_counter_.id(),
                    static_cast<GLintptr>(index * sizeof(std::uint32_t)), sizeof(std::uint32_t));
  stack_.draw(index, target, camera, offset_px, geometry);
}

FrameStats PvrrFrame::statistics() const {
  FrameStats stats;
  for (std::size_t i = 0; i < stack_.size(); ++i) stats.optics.push_back(stack_.optic(i).statistics());
  stats.maps = stack_.statistics();
  stats.maps_pruned = stack_.pruned();
  for (const MapStats& map : stats.maps) stats.rays += map.scene_rays;
  return stats;
}

}  // namespace catoptra::render

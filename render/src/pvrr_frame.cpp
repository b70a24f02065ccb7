#include "render/src/pvrr_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

#include "render/src/pvrr_plane_view.h"
#include "render/src/raster_optic_uniforms.h"
#include "render/src/sampling.h"

namespace catoptra::render {
namespace {

// As in pvrr_optic.frag.glsl.
constexpr GLint kMapShift = 7, kMapRayOrigin = 8, kMapRayDirection = 9;
constexpr GLuint kMapColorUnit = 2, kMapPositionUnit = 3, kMapDetailUnit = 4;

// How large a ball is to appear in the mirror, and how long the line of a ray that meets nothing is drawn.
constexpr double kBallRadiusPx = 4.0;
constexpr double kMissedRayLength = 2000;

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
                     cad_import::BoundingBox bounds)
    : scene_(scene), raster_(raster), rays_(rays), bounds_(bounds), patches_(scene.optics.size()) {
  outside_counter_ =
      make_dynamic_buffer(sizeof(std::uint32_t) * std::max<std::size_t>(1, scene.optics.size()));
}

RenderResult PvrrFrame::render(const Camera& camera, const FrameOptions& options, RasterPicture& picture) {
  RenderResult result;
  double trace_ms = 0, pass1_ms = 0, pass2_ms = 0, readback_ms = 0;
  const glm::ivec2 size(options.width, options.height);
  const double total_ms = gl_time_ms([&] {
    trace_ms = gl_time_ms([&] {
      picture.begin(options);
      const RasterView view = camera_view(camera, size);
      for (std::size_t i = 0; i < patches_.size(); ++i) trace(i, view, options);
      set_overlay(options);
      const std::vector<std::uint32_t> zeros(std::max<std::size_t>(1, patches_.size()), 0);
      update_buffer(outside_counter_, std::as_bytes(std::span(zeros)));
    });
    for (int sample = 0; sample < options.samples; ++sample) {
      const glm::dvec2 offset = sample_offset(sample, options.samples);
      const bool geometry = options.geometry && sample == 0;
      // The map's samples move within its texels as the picture's do within pixels, but not in step with
      // them.
      const glm::dvec2 map_offset(offset.y, offset.x);
      pass1_ms += gl_time_ms([&] { draw_maps(offset, geometry, options); });
      pass2_ms += gl_time_ms([&] {
        draw_picture(picture.target(), camera_view(camera, size, offset), offset, geometry, options);
        picture.add_sample();
      });
    }
    if (options.read_back) readback_ms = gl_time_ms([&] { result.frame = picture.read_back(); });
  });

  result.stats = statistics();
  result.stats.time_ms = {{"trace", trace_ms}, {"pass1", pass1_ms}, {"pass2", pass2_ms}, {"total", total_ms}};
  if (options.read_back) result.stats.time_ms["readback"] = readback_ms;
  std::vector<std::uint32_t> outside(patches_.size(), 0);
  if (!outside.empty())
    glGetNamedBufferSubData(outside_counter_.id(), 0,
                            static_cast<GLsizeiptr>(outside.size() * sizeof(std::uint32_t)), outside.data());
  for (std::size_t i = 0; i < outside.size(); ++i)
    if (outside[i] > 0)
      result.warnings.push_back(scene_.optics[i].name + ": its map does not reach " +
                                std::to_string(outside[i]) + " samples, which show the sky instead");
  return result;
}

void PvrrFrame::trace(std::size_t index, const RasterView& camera, const FrameOptions& options) {
  const optics::Optic& optic = scene_.optics[index];
  Patch& patch = patches_[index];
  patch.hits = optics::trace_vertices(optic, camera.origin_mm, rays_);
  patch.rays = static_cast<std::size_t>(std::count_if(
      patch.hits.begin(), patch.hits.end(), [](const optics::VertexHit& hit) { return hit.faces_eye; }));
  patch.faces_eye = patch.rays > 0;
  if (!patch.faces_eye) {
    patch.map.set_empty(options.geometry);
    return;
  }
  patch.view = optics::make_virtual_view(optic, patch.hits, bounds_);
  const auto plane = plane_view(optic, camera, patch.view, bounds_);
  patch.on_pixel_grid = plane.has_value();
  if (plane) patch.view = plane->view;
  patch.coordinates = optics::map_coordinates(optic, patch.hits, patch.view);
  raster_.optic(index).set_map_coordinates(patch.coordinates);
  if (plane) {
    patch.map.resize({plane->texels, 1.0}, options.geometry);
    return;
  }
  std::vector<glm::dvec3> pixels;
  pixels.reserve(optic.mesh.vertices.size());
  for (const auto& vertex : optic.mesh.vertices) pixels.push_back(camera.pixel(vertex.position_mm));
  patch.map.resize(choose_map_size(optic, pixels, patch.coordinates, patch.view, camera.size,
                                   scene_.settings.texels_per_pixel),
                   options.geometry);
}

void PvrrFrame::set_overlay(const FrameOptions& options) {
  std::vector<OverlayBall> balls;
  std::vector<OverlayLine> lines;
  for (const Patch& patch : patches_) {
    if (!patch.faces_eye) continue;
    for (const optics::VertexHit& hit : patch.hits) {
      if (!hit.faces_eye) continue;
      if (options.overlay_vertices && hit.scene_hit)
        balls.push_back(
            {hit.hit_point_mm, length_in_map(patch.view, patch.map.size(), hit.hit_point_mm, kBallRadiusPx)});
      if (options.overlay_rays)
        lines.push_back(
            {hit.surface_point_mm,
             hit.scene_hit ? hit.hit_point_mm : hit.surface_point_mm + kMissedRayLength * hit.direction});
    }
  }
  overlay_.set_balls(balls);
  overlay_.set_lines(lines);
}

glm::dvec2 PvrrFrame::map_offset(const Patch& patch, glm::dvec2 offset_px) {
  // In general the map's samples move within its texels as the picture's do within pixels, but not in step
  // with them.
  return patch.on_pixel_grid ? plane_view_offset(offset_px) : glm::dvec2(offset_px.y, offset_px.x);
}

void PvrrFrame::draw_maps(glm::dvec2 offset_px, bool geometry, const FrameOptions& options) {
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    Patch& patch = patches_[i];
    if (!patch.faces_eye) continue;
    patch.map.draw(raster_, i, patch.view, map_offset(patch, offset_px), geometry);
    if (!options.overlay_vertices && !options.overlay_rays) continue;
    patch.map.target().bind(false);
    overlay_.draw_in_scene(patch.map.view(), patch.map.clip_depth());
  }
}

void PvrrFrame::draw_picture(const RasterTarget& picture_target, const RasterView& camera,
                             glm::dvec2 offset_px, bool geometry, const FrameOptions& options) {
  RasterPass pass;
  pass.geometry = geometry;
  picture_target.bind(geometry);
  raster_.draw(camera, pass);
  for (std::size_t i = 0; i < patches_.size(); ++i) draw_optic(i, camera, offset_px, geometry);
  if (!options.overlay_vertices && !options.overlay_rays) return;
  // Overlays have no geometry of their own: what they cover keeps its.
  picture_target.bind(false);
  overlay_.draw_in_scene(camera, nullptr);
  if (!options.overlay_vertices) return;
  for (std::size_t i = 0; i < patches_.size(); ++i) overlay_.draw_mesh(camera, raster_.optic(i));
}

void PvrrFrame::draw_optic(std::size_t index, const RasterView& camera, glm::dvec2 offset_px, bool geometry) {
  const Patch& patch = patches_[index];
  const RasterTarget& map = patch.map.target();
  glUseProgram(optic_program(geometry).id());
  RasterScene::set_mesh_origin(camera, raster_.optic(index).center_mm());
  set_optic_uniforms(scene_.optics[index], index);
  const glm::dvec2 shift = -map_offset(patch, offset_px) / glm::dvec2(map.size());
  glUniform2f(kMapShift, static_cast<float>(shift.x), static_cast<float>(shift.y));
  glBindTextureUnit(kMapColorUnit, map.color().id());
  if (geometry) {
    set_map_rays(patch.view);
    glBindTextureUnit(kMapPositionUnit, map.position().id());
    glBindTextureUnit(kMapDetailUnit, map.detail().id());
  }
  glBindBufferRange(GL_ATOMIC_COUNTER_BUFFER, 0, outside_counter_.id(),
                    static_cast<GLintptr>(index * sizeof(std::uint32_t)), sizeof(std::uint32_t));
  raster_.optic(index).draw_surface();
}

FrameStats PvrrFrame::statistics() const {
  FrameStats stats;
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const Patch& patch = patches_[i];
    const optics::Optic& optic = scene_.optics[i];
    OpticStats entry{optic.name,
                     optic.kind == optics::OpticKind::mirror ? "mirror" : "lens",
                     optic.mesh.vertices.size(),
                     patch.rays,
                     {}};
    if (patch.faces_eye)
      entry.patches.push_back(
          {patch.view.viewpoint_mm, patch.view.residual_mm, {patch.view.fov_rad.x, patch.view.fov_rad.y}});
    stats.rays += patch.rays;
    stats.optics.push_back(std::move(entry));
  }
  return stats;
}

const GlProgram& PvrrFrame::optic_program(bool geometry) {
  const auto found = optic_programs_.find(geometry);
  if (found != optic_programs_.end()) return found->second;
  const std::vector<std::string> defines(geometry ? 1 : 0, "GEOMETRY");
  return optic_programs_
      .emplace(geometry, make_program({"raster_view.glsl", "raster_surface.vert.glsl"},
                                      {"raster_view.glsl", "raster_shading.glsl", "raster_optic.glsl",
                                       "pvrr_optic.frag.glsl"},
                                      defines))
      .first->second;
}

}  // namespace catoptra::render

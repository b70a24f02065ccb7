#include "render/src/cubemap_frame.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/vertex_hits.h"
#include "render/src/raster_optic_uniforms.h"
#include "render/src/sampling.h"

namespace catoptra::render {
namespace {

constexpr GLint kCubeCenter = 8;  // as in cubemap_optic.frag.glsl
constexpr GLuint kMapColorUnit = 2, kMapPositionUnit = 3, kMapDetailUnit = 4;
constexpr int kSmallest = 64, kLargest = 1024;
constexpr double kClearOfGlass_mm = 1;

/// Texels per unit of tangent are the same at the middle of a face and of the picture, times
/// texels_per_pixel.
int face_size(const Camera& camera, const FrameOptions& options, double texels_per_pixel) {
  const double pixels_per_tangent = options.height / (2 * std::tan(camera.fov_rad / 2));
  const int size = static_cast<int>(std::ceil(2 * pixels_per_tangent * texels_per_pixel));
  return std::clamp(size, kSmallest, kLargest);
}

/// The area centroid of a convex mirror lies inside its glass, from where the map would show the glass's
/// back: the point before it, along the mean reflecting normal, that is just clear of the highest vertex.
glm::dvec3 before_mirror(const optics::Optic& mirror, const glm::dvec3& centroid_mm) {
  glm::dvec3 sum{0};
  for (const auto& vertex : mirror.mesh.vertices) sum += optics::reflecting_normal(mirror, vertex.normal);
  const double length = glm::length(sum);
  if (!(length > 0)) return centroid_mm;
  const glm::dvec3 axis = sum / length;
  double highest_mm = 0;
  for (const auto& vertex : mirror.mesh.vertices)
    highest_mm = std::max(highest_mm, glm::dot(vertex.position_mm - centroid_mm, axis));
  return centroid_mm + (highest_mm + kClearOfGlass_mm) * axis;
}

}  // namespace

CubemapFrame::CubemapFrame(const Scene& scene, RasterScene& raster)
    : scene_(scene), raster_(raster), cubes_(scene.optics.size()), lenses_(scene.optics.size()) {
  glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

RenderResult CubemapFrame::render(const Camera& camera, const FrameOptions& options, RasterPicture& picture) {
  RenderResult result;
  double pass1_ms = 0, pass2_ms = 0, readback_ms = 0;
  const glm::ivec2 size(options.width, options.height);
  const int face = face_size(camera, options, scene_.settings.texels_per_pixel);
  const double pixels_per_tangent = options.height / (2 * std::tan(camera.fov_rad / 2));
  const double total_ms = gl_time_ms([&] {
    picture.begin(options);
    for (std::size_t i = 0; i < lenses_.size(); ++i)
      if (scene_.optics[i].kind == optics::OpticKind::lens)
        trace_lens(i, camera.eye_mm, options.reuse_static);
    // The cube map does not change while the samples move within their pixels.
    pass1_ms = gl_time_ms([&] {
      for (std::size_t i = 0; i < cubes_.size(); ++i)
        draw_cube(i, face, face / (2 * pixels_per_tangent), options.geometry);
    });
    pass2_ms = gl_time_ms([&] {
      const RasterView view = camera_view(camera, size, camera.offset_px);
      for (const auto& [target, geometry] : picture.passes(options.geometry)) {
        RasterPass pass;
        pass.geometry = geometry;
        pass.multisample = target->multisample();
        target->bind(geometry);
        raster_.draw(view, pass);
        for (std::size_t i = 0; i < cubes_.size(); ++i) draw_optic(i, *target, view, geometry);
      }
      picture.add_sample();
    });
    if (options.read_back) readback_ms = gl_time_ms([&] { result.frame = picture.read_back(); });
  });
  result.stats.time_ms = {{"pass1", pass1_ms}, {"pass2", pass2_ms}, {"total", total_ms}};
  if (options.read_back) result.stats.time_ms["readback"] = readback_ms;
  add_shadows(raster_.take_shadow_statistics(), result.stats);
  for (const optics::Optic& optic : scene_.optics)
    result.stats.optics.push_back(
        {optic.name, optics::kind_name(optic.kind), optic.mesh.vertices.size(), 0, 0, {}});
  return result;
}

void CubemapFrame::draw_cube(std::size_t optic, int size, double texels_per_pixel, bool geometry) {
  Cube& cube = cubes_[optic];
  if (cube.size != size || cube.geometry != geometry) {
    cube = Cube();
    cube.size = size;
    cube.geometry = geometry;
    cube.color = make_texture_cube(GL_RGBA16F, size, true);
    cube.depth = make_texture_2d(GL_DEPTH_COMPONENT32F, size, size, 1, false);
    if (geometry) {
      cube.position = make_texture_cube(GL_RGBA32F, size, false);
      cube.detail = make_texture_cube(GL_RGBA32F, size, false);
    }
  }
  const GlFramebuffer framebuffer = [&] {
    return geometry ? make_framebuffer({&cube.color, &cube.position, &cube.detail}, nullptr)
                    : make_framebuffer({&cube.color}, nullptr);
  }();
  glNamedFramebufferTexture(framebuffer.id(), GL_DEPTH_ATTACHMENT, cube.depth.id(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  RasterPass pass;
  pass.geometry = geometry;
  pass.level_bias = static_cast<float>(std::log2(texels_per_pixel));
  pass.draw_optics = true;
  pass.except = optic;
  for (int face = 0; face < 6; ++face) {
    glNamedFramebufferTextureLayer(framebuffer.id(), GL_COLOR_ATTACHMENT0, cube.color.id(), 0, face);
    if (geometry) {
      glNamedFramebufferTextureLayer(framebuffer.id(), GL_COLOR_ATTACHMENT1, cube.position.id(), 0, face);
      glNamedFramebufferTextureLayer(framebuffer.id(), GL_COLOR_ATTACHMENT2, cube.detail.id(), 0, face);
    }
    raster_.draw(cube_face_view(center_mm(optic), face, size), pass);
  }
}

void CubemapFrame::set_cube_geometry(const Cube& cube, const glm::dvec3& center_mm) {
  const glm::vec3 center(center_mm);
  glUniform3f(kCubeCenter, center.x, center.y, center.z);
  glBindTextureUnit(kMapPositionUnit, cube.position.id());
  glBindTextureUnit(kMapDetailUnit, cube.detail.id());
}

void CubemapFrame::trace_lens(std::size_t optic, const glm::dvec3& eye_mm, bool reuse) {
  Lens& lens = lenses_[optic];
  const optics::Placement& placement = raster_.optic(optic).placement();
  if (reuse && lens.eye_mm == eye_mm && lens.placement == placement) return;
  if (!lens.tracer) lens.tracer = std::make_unique<optics::LensTracer>(scene_.optics[optic]);
  lens.eye_mm = eye_mm;
  lens.placement = placement;
  const LensRays rays = refract_eye_rays(scene_.optics[optic], *lens.tracer, placement.own_point(eye_mm));
  std::vector<std::vector<glm::dvec3>> directions;
  for (const auto& of_sample : rays.hits) {
    auto& some = directions.emplace_back();
    for (const optics::VertexHit& hit : of_sample) some.push_back(placement.direction(hit.direction));
  }
  lens.raster.set_shown(raster_.side(optic, rays.entered),
                        raster_.exit_mask(optic, optics::other_side(rays.entered)), rays, directions);
}

glm::dvec3 CubemapFrame::center_mm(std::size_t optic) const {
  const glm::dvec3& front = raster_.optic(optic).center_mm();
  const optics::Placement& placement = raster_.optic(optic).placement();
  if (scene_.optics[optic].kind != optics::OpticKind::lens)
    return placement.point(before_mirror(scene_.optics[optic], front));
  return placement.point(0.5 * (front + raster_.side(optic, optics::LensSide::back).center_mm()));
}

void CubemapFrame::draw_lens(std::size_t optic, const RasterTarget& target, const RasterView& camera,
                             bool geometry) {
  const Cube& cube = cubes_[optic];
  lenses_[optic].raster.draw(camera, target, geometry, LensLook::cube, lens_programs_, scene_.optics[optic],
                             optic, scene_.environment.ambient, [&](std::size_t, bool with_geometry) {
                               glBindTextureUnit(kMapColorUnit, cube.color.id());
                               if (with_geometry) set_cube_geometry(cube, center_mm(optic));
                             });
}

void CubemapFrame::draw_optic(std::size_t optic, const RasterTarget& target, const RasterView& camera,
                              bool geometry) {
  if (optics::is_planar_glass(scene_.optics[optic])) return;
  if (scene_.optics[optic].kind == optics::OpticKind::lens) {
    draw_lens(optic, target, camera, geometry);
    return;
  }
  // A cube map from one point says nothing about glass before it: that is not there.
  if (optics::is_planar_glass(scene_.optics[optic])) return;
  const Cube& cube = cubes_[optic];
  glUseProgram(optic_program(geometry).id());
  RasterScene::set_mesh_origin(camera, raster_.optic(optic));
  set_optic_uniforms(scene_.optics[optic], optic);
  glBindTextureUnit(kMapColorUnit, cube.color.id());
  if (geometry) set_cube_geometry(cube, center_mm(optic));
  raster_.optic(optic).draw_surface();
}

const GlProgram& CubemapFrame::optic_program(bool geometry) {
  const auto found = optic_programs_.find({geometry, raster_.shading_samples()});
  if (found != optic_programs_.end()) return found->second;
  std::vector<std::string> defines = raster_.shading_defines();
  if (geometry) defines.emplace_back("GEOMETRY");
  return optic_programs_
      .emplace(std::pair(geometry, raster_.shading_samples()),
               make_program({"raster_view.glsl", "raster_surface.vert.glsl"},
                            {"raster_view.glsl", "raster_lights.glsl", "raster_shading.glsl",
                             "raster_shown.glsl", "raster_optic.glsl", "cubemap_optic.frag.glsl"},
                            defines))
      .first->second;
}

}  // namespace catoptra::render

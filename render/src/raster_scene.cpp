#include "render/src/raster_scene.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <tuple>

#include "cad_import/error.h"
#include "render/src/shading.h"

namespace catoptra::render {
namespace {

// As in raster_view.glsl and raster_surface.*.glsl.
constexpr std::size_t kMaxLights = 64;
constexpr GLint kOriginHigh = 0, kOriginLow = 1, kAlbedo = 2, kEmissive = 3, kAlpha = 4, kMeshAxes = 16;
constexpr GLuint kAlbedoUnit = 0, kOpticDepthUnit = 1, kSkyUnit = 7;

// Triangles are drawn in pieces: small ones leave out and hide more, but each costs a draw.
constexpr std::size_t kSmallestChunk = 64, kMostChunks = 256;
// Chunks of so many triangles are looked at one by one where their box reaches an optic.
constexpr std::size_t kFewTriangles = 128;

struct GpuLight {
  glm::vec4 position, radiance;
};

struct GpuView {
  glm::mat4 clip_from_relative;
  glm::vec4 origin, sky_center, sky_x, sky_y, sky_color, parameters, keep;
  GpuLight lights[kMaxLights];
};

struct Vertex {
  glm::vec3 position, normal;
  glm::vec2 texture;
};

GpuLight gpu_light(const Light& light, const glm::dvec3& origin_mm) {
  const glm::vec4 radiance(light.color * light.intensity, 0);
  if (light.kind == LightKind::directional)
    return {glm::vec4(glm::vec3(-glm::normalize(light.direction)), 0), radiance};
  return {glm::vec4(glm::vec3(light.position_mm - origin_mm), 1), radiance};
}

std::optional<RasterOptic> back_of(const optics::Optic& optic) {
  if (optic.kind != optics::OpticKind::lens) return std::nullopt;
  return RasterOptic(optic.back.mesh);
}

void set_vec3(GLint location, const glm::vec3& v) {
  glUniform3f(location, v.x, v.y, v.z);
}

}  // namespace

RasterScene::RasterScene(const Scene& scene, const SceneTextures& textures) : scene_(scene) {
  if (scene.lights.size() > kMaxLights)
    throw Error(scene.file, "light", "there are more than " + std::to_string(kMaxLights) + " lights",
                "use mode raytrace, or fewer lights");
  lights_ = scene.lights;
  std::stable_partition(lights_.begin(), lights_.end(),
                        [](const Light& light) { return light.kind == LightKind::directional; });
  view_uniforms_ = make_dynamic_buffer(sizeof(GpuView));
  nothing_ = make_vertex_array({});
  upload_surroundings();
  upload_textures(textures);
  optics_.reserve(scene.optics.size());
  for (const optics::Optic& optic : scene.optics) {
    optics_.emplace_back(optic.mesh);
    backs_.push_back(back_of(optic));
  }
  depth_program_ = make_program({"raster_view.glsl", "raster_surface.vert.glsl"}, {"raster_depth.frag.glsl"});
  if (has_shadows(scene)) shadows_ = std::make_unique<RasterShadows>(scene);
}

void RasterScene::upload_surroundings() {
  std::vector<Vertex> vertices;
  std::vector<glm::vec3>& positions = positions_;
  std::vector<std::uint32_t>& indices = triangles_;
  std::size_t triangles = 0;
  for (const cad_import::TriangleMesh& mesh : scene_.surroundings) triangles += mesh.triangles.size();
  const std::size_t largest = std::max(kSmallestChunk, triangles / kMostChunks);
  GLint first_texture = 0;
  for (const cad_import::TriangleMesh& mesh : scene_.surroundings) {
    const auto base = static_cast<std::uint32_t>(vertices.size());
    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      vertices.push_back({mesh.positions[i], mesh.normals[i],
                          i < mesh.texture_coordinates.size() ? mesh.texture_coordinates[i] : glm::vec2(0)});
    std::vector<std::vector<std::uint32_t>> by_material(mesh.materials.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        by_material[mesh.triangle_material[t]].push_back(base + mesh.triangles[t][k]);
    for (std::size_t m = 0; m < by_material.size(); ++m) {
      if (by_material[m].empty()) continue;
      const cad_import::Material& material = mesh.materials[m];
      for (TriangleChunk chunk : chunk_triangles(positions, by_material[m], largest)) {
        chunk.first += indices.size();
        chunks_.push_back({batches_.size(), chunk});
      }
      batches_.push_back({material.texture < 0 ? -1 : first_texture + material.texture,
                          material.alpha_cutoff > 0, material.base_color, material.emissive, material.alpha,
                          material.alpha_cutoff, material.wrap});
      indices.insert(indices.end(), by_material[m].begin(), by_material[m].end());
    }
    first_texture += static_cast<GLint>(mesh.textures.size());
  }
  vertices_ = make_static_buffer(std::as_bytes(std::span(vertices)));
  indices_ = make_static_buffer(std::as_bytes(std::span(indices)));
  surroundings_ = make_vertex_array(indices_);
  bind_attributes(surroundings_, 0, vertices_, sizeof(Vertex), {{0, 3, 0}, {1, 3, 12}, {2, 2, 24}});
}

void RasterScene::upload_textures(const SceneTextures& textures) {
  for (const auto& of_mesh : textures.textures)
    for (const MipTexture& texture : of_mesh) {
      const auto& levels = texture.levels;
      GlTexture gpu = make_texture_2d(GL_SRGB8_ALPHA8, levels[0].width, levels[0].height,
                                      static_cast<int>(levels.size()), true);
      for (std::size_t l = 0; l < levels.size(); ++l)
        glTextureSubImage2D(gpu.id(), static_cast<GLint>(l), 0, 0, levels[l].width, levels[l].height, GL_RGBA,
                            GL_UNSIGNED_BYTE, levels[l].rgba.data());
      textures_.push_back(std::move(gpu));
    }
  for (const auto wrap :
       {cad_import::TextureWrap::repeat, cad_import::TextureWrap::clamp, cad_import::TextureWrap::mirror}) {
    GLuint id = 0;
    glCreateSamplers(1, &id);
    const GLint mode = wrap == cad_import::TextureWrap::repeat  ? GL_REPEAT
                       : wrap == cad_import::TextureWrap::clamp ? GL_CLAMP_TO_EDGE
                                                                : GL_MIRRORED_REPEAT;
    glSamplerParameteri(id, GL_TEXTURE_WRAP_S, mode);
    glSamplerParameteri(id, GL_TEXTURE_WRAP_T, mode);
    glSamplerParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    samplers_[static_cast<std::size_t>(wrap)] = GlSampler(id);
  }
  const SkyImage& sky = textures.sky;
  if (sky.width == 0) return;
  sky_ = make_texture_2d(GL_RGB32F, sky.width, sky.height, 1, true);
  glTextureParameteri(sky_.id(), GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureSubImage2D(sky_.id(), 0, 0, 0, sky.width, sky.height, GL_RGB, GL_FLOAT, sky.rgb.data());
}

void RasterScene::optic_changed(std::size_t index) {
  const optics::Placement placement = optics_[index].placement();
  optics_[index] = RasterOptic(scene_.optics[index].mesh);
  backs_[index] = back_of(scene_.optics[index]);
  if (shadows_) shadows_->optic_changed(index);
  place_optic(index, placement);
  masks_.erase({index, optics::LensSide::front});
  masks_.erase({index, optics::LensSide::back});
}

void RasterScene::place_optic(std::size_t index, const optics::Placement& placement) {
  optics_[index].place(placement);
  if (backs_[index]) backs_[index]->place(placement);
  if (shadows_) shadows_->place_optic(index, placement);
}

const LensMask& RasterScene::exit_mask(std::size_t lens, optics::LensSide exit) {
  const auto found = masks_.find({lens, exit});
  if (found != masks_.end()) return found->second;
  const auto& mesh = *optics::side_of(scene_.optics[lens], exit).mesh;
  return masks_.emplace(std::pair{lens, exit}, LensMask(*this, side(lens, exit), mesh)).first->second;
}

void RasterScene::begin_view(const RasterView& view, float level_bias) const {
  const RasterView::Directions directions = view.directions();
  GpuView gpu{};
  gpu.clip_from_relative = glm::mat4(view.clip_from_relative());
  gpu.origin = glm::vec4(glm::vec3(view.origin_mm), 1);
  gpu.sky_center = glm::vec4(glm::vec3(directions.center), 0);
  gpu.sky_x = glm::vec4(glm::vec3(directions.dx), 0);
  gpu.sky_y = glm::vec4(glm::vec3(directions.dy), 0);
  gpu.sky_color = glm::vec4(scene_.environment.color, 0);
  gpu.parameters = glm::vec4(level_bias, scene_.environment.ambient, way_base(), way_limit());
  gpu.keep = glm::vec4(view.keep);
  for (std::size_t i = 0; i < lights_.size(); ++i) gpu.lights[i] = gpu_light(lights_[i], view.origin_mm);
  update_buffer(view_uniforms_, std::as_bytes(std::span(&gpu, 1)));
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, view_uniforms_.id());
  if (sky_) glBindTextureUnit(kSkyUnit, sky_.id());

  glClipControl(view.bottom_row_first ? GL_LOWER_LEFT : GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  glViewport(view.corner.x, view.corner.y, view.size.x, view.size.y);
  glDepthRange(view.depth_of_far, view.depth_of_near);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  if (view.keeps_all())
    glDisable(GL_CLIP_DISTANCE0);
  else
    glEnable(GL_CLIP_DISTANCE0);
}

float RasterScene::way_base() const {
  return float(scene_.optics.size() + 1);
}

float RasterScene::way_limit() const {
  // A float holds whole numbers up to 2^24.
  float limit = 1;
  if (scene_.optics.empty()) return limit;
  while (limit * way_base() * way_base() <= float(1 << 24)) limit *= way_base();
  return limit;
}

void RasterScene::set_mesh_origin(const RasterView& view, const glm::dvec3& mesh_origin_mm) {
  set_mesh_origin(view, mesh_origin_mm, {});
}

void RasterScene::set_mesh_origin(const RasterView& view, const RasterOptic& optic) {
  set_mesh_origin(view, optic.center_mm(), optic.placement());
}

void RasterScene::set_mesh_origin(const RasterView& view, const glm::dvec3& mesh_origin_mm,
                                  const optics::Placement& placement) {
  const glm::dvec3 origin = placement.own_point(view.origin_mm) - mesh_origin_mm;
  const glm::vec3 high(origin), low(origin - glm::dvec3(high));
  set_vec3(kOriginHigh, high);
  set_vec3(kOriginLow, low);
  const glm::mat3 axes(placement.rotation);
  glUniformMatrix3fv(kMeshAxes, 1, GL_FALSE, &axes[0].x);
}

std::vector<std::string> RasterScene::shading_defines() const {
  const auto directional = std::count_if(lights_.begin(), lights_.end(), [](const Light& light) {
    return light.kind == LightKind::directional;
  });
  std::vector<std::string> defines{"LIGHTS " + std::to_string(lights_.size()),
                                   "DIRECTIONAL_LIGHTS " + std::to_string(directional)};
  if (sky_) defines.emplace_back("SKY_TEXTURE");
  if (shadows_)
    for (std::string& define : shadows_->defines(shading_samples_)) defines.push_back(std::move(define));
  return defines;
}

ShadowStats RasterScene::take_shadow_statistics() {
  return shadows_ ? shadows_->take_statistics() : ShadowStats();
}

void RasterScene::draw(const RasterView& view, const RasterPass& pass) {
  clear(view, pass);
  draw_all(view, pass);
}

void RasterScene::clear(const RasterView& view, const RasterPass& pass) {
  draw_shadows(view, pass);
  begin_view(view, pass.level_bias);
  if (pass.clip_depth) glBindTextureUnit(kOpticDepthUnit, pass.clip_depth->id());
  const glm::vec4 background(scene_.environment.color, 1);
  glClearBufferfv(GL_COLOR, 0, &background.x);
  const float farthest = 0;
  glClearBufferfv(GL_DEPTH, 0, &farthest);
}

void RasterScene::draw_all(const RasterView& view, const RasterPass& pass) {
  draw_bodies_in_view(view, pass);
  // A sky of one colour without geometry is the cleared background itself.
  if (sky_ || pass.geometry) draw_sky(pass);
}

void RasterScene::draw_shadows(const RasterView& view, const RasterPass& pass) {
  if (!shadows_) return;
  shading_samples_ = pass.multisample;
  begin_view(view, pass.level_bias);
  shadows_->draw(view, pass.multisample, [&] { draw_depth_of_bodies(view, pass); });
  shadows_->bind_lights(view);
}

/// Of all that is lit, with whatever the optics among it show.
void RasterScene::draw_depth_of_bodies(const RasterView& view, RasterPass pass) {
  pass.geometry = false;
  pass.draw_optics = true;
  pass.nested = {};
  depth_only_ = true;
  draw_bodies_in_view(view, pass);
  depth_only_ = false;
}

void RasterScene::draw_bodies(const RasterView& view, const RasterPass& pass) {
  draw_shadows(view, pass);
  begin_view(view, pass.level_bias);
  draw_bodies_in_view(view, pass);
}

void RasterScene::draw_bodies_in_view(const RasterView& view, const RasterPass& pass) {
  if (pass.clip_depth) glBindTextureUnit(kOpticDepthUnit, pass.clip_depth->id());
  draw_surroundings(view, pass);
  if (pass.draw_optics) draw_optics(view, pass);
}

bool RasterScene::sees_anything(const RasterView& view, const RasterPass& pass) const {
  for (std::size_t i = 0; i < optics_.size() && pass.draw_optics; ++i)
    if (pass.except != i && scene_.optics[i].kind == optics::OpticKind::mirror) return true;
  return std::any_of(chunks_.begin(), chunks_.end(),
                     [&](const Chunk& chunk) { return box_in_view(view, chunk.triangles.box).seen; });
}

std::vector<RasterScene::Draw> RasterScene::draws_of(const RasterView& view, const RasterPass& pass) const {
  std::vector<Draw> draws;
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    const BoxInView box = box_in_view(view, chunks_[i].triangles.box);
    if (!box.seen) continue;
    Draw draw{i, box.nearest_mm, pass.clip_depth && box.nearest_mm <= pass.clip_reach_mm};
    const TriangleChunk& chunk = chunks_[i].triangles;
    // Few triangles in a large box, as of walls along a street, are seldom near where their box is.
    if (draw.clip && chunk.count <= 3 * kFewTriangles) {
      draw.nearest_mm =
          nearest_triangle_mm(view, positions_, std::span(triangles_).subspan(chunk.first, chunk.count));
      draw.clip = draw.nearest_mm <= pass.clip_reach_mm;
    }
    draws.push_back(draw);
  }
  // From front to back, so that what is hidden is not shaded; alpha-tested surfaces last, since they cost
  // more and hide less. Where chunks are equally near their order in the file decides.
  const double sense = view.depth_of_near > view.depth_of_far ? 1 : -1;
  std::stable_sort(draws.begin(), draws.end(), [&](const Draw& a, const Draw& b) {
    return std::tuple(batches_[chunks_[a.chunk].batch].alpha_test, sense * a.nearest_mm) <
           std::tuple(batches_[chunks_[b.chunk].batch].alpha_test, sense * b.nearest_mm);
  });
  return draws;
}

void RasterScene::set_material(const Batch& batch) const {
  if (batch.texture >= 0) {
    glBindTextureUnit(kAlbedoUnit, textures_[static_cast<std::size_t>(batch.texture)].id());
    glBindSampler(kAlbedoUnit, samplers_[static_cast<std::size_t>(batch.wrap)].id());
  }
  set_vec3(kAlbedo, batch.albedo);
  set_vec3(kEmissive, batch.emissive);
  if (batch.alpha_test) glUniform2f(kAlpha, batch.alpha, batch.cutoff);
}

void RasterScene::draw_surroundings(const RasterView& view, const RasterPass& pass) {
  glBindVertexArray(surroundings_.id());
  GLuint program = 0;
  const Batch* material = nullptr;
  for (const Draw& draw : draws_of(view, pass)) {
    const Chunk& chunk = chunks_[draw.chunk];
    const Batch& batch = batches_[chunk.batch];
    const GLuint wanted =
        surface_program({batch.texture >= 0, batch.alpha_test, draw.clip, pass.geometry, depth_only_}).id();
    if (wanted != program) {
      glUseProgram(program = wanted);
      set_mesh_origin(view, glm::dvec3(0));
      material = nullptr;
    }
    if (material != &batch) set_material(*(material = &batch));
    ++draws_;
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(chunk.triangles.count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(chunk.triangles.first * sizeof(std::uint32_t)));
  }
  glBindSampler(kAlbedoUnit, 0);
}

void RasterScene::draw_optics(const RasterView& view, const RasterPass& pass) {
  glUseProgram(surface_program({false, false, pass.clip_depth != nullptr, pass.geometry, depth_only_}).id());
  glEnable(GL_CULL_FACE);
  for (std::size_t i = 0; i < optics_.size(); ++i) {
    if (pass.except == i || scene_.optics[i].kind != optics::OpticKind::mirror) continue;
    if (std::find(pass.nested.begin(), pass.nested.end(), i) != pass.nested.end()) continue;
    set_mesh_origin(view, optics_[i]);
    set_vec3(kEmissive, glm::vec3(0));
    for (const bool reflecting : {true, false}) {
      const bool bright = reflecting || scene_.optics[i].two_sided;
      set_vec3(kAlbedo, bright ? scene_.optics[i].reflectance : glm::vec3(kOpticBackAlbedo));
      glCullFace(reflecting == scene_.optics[i].flip ? GL_FRONT : GL_BACK);
      optics_[i].draw_surface();
      ++draws_;
    }
  }
  glDisable(GL_CULL_FACE);
}

void RasterScene::draw_sky(const RasterPass& pass) {
  glUseProgram(sky_program(pass.geometry).id());
  glDepthFunc(GL_GEQUAL);
  glBindVertexArray(nothing_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthFunc(GL_GREATER);
}

void RasterScene::draw_optic_depth(const RasterView& view, const RasterOptic& surface) {
  draw_depth(view, surface, 1, GL_LESS, true);
}

void RasterScene::draw_zooming_optic_depth(const RasterView& view, const RasterOptic& surface,
                                           double beside_mm) {
  const glm::dvec4 clip = view.projection * glm::dvec4(0, 0, -beside_mm, 1);
  const double depth = std::clamp(clip.z / clip.w, 0.0, 1.0);
  draw_depth(view, surface, float(view.depth_of_far + (view.depth_of_near - view.depth_of_far) * depth),
             GL_GREATER, false);
}

void RasterScene::draw_depth(const RasterView& view, const RasterOptic& surface, float none, GLenum keep,
                             bool skirt) {
  begin_view(view, 0);
  glClearBufferfv(GL_DEPTH, 0, &none);
  glDepthFunc(keep);
  // The near plane may lie beyond the optic; its depth is then 1, and nothing is cut there but by that plane.
  glEnable(GL_DEPTH_CLAMP);
  glUseProgram(depth_program_.id());
  set_mesh_origin(view, surface);
  if (skirt)
    surface.draw_surface_with_skirt();
  else
    surface.draw_surface();
  glDisable(GL_DEPTH_CLAMP);
  glDepthFunc(GL_GREATER);
}

const GlProgram& RasterScene::surface_program(const Surface& surface) {
  const unsigned key = unsigned(surface.textured) | unsigned(surface.alpha_test) << 1 |
                       unsigned(surface.clip) << 2 | unsigned(surface.geometry) << 3 |
                       unsigned(surface.depth_only) << 4 | unsigned(shading_samples_) << 5;
  const auto found = surface_programs_.find(key);
  if (found != surface_programs_.end()) return found->second;
  std::vector<std::string> defines;
  if (surface.depth_only)
    defines.emplace_back("DEPTH_ONLY");
  else
    defines = shading_defines();
  if (surface.textured) defines.emplace_back("TEXTURED");
  if (surface.alpha_test) defines.emplace_back("ALPHA_TEST");
  if (surface.clip) defines.emplace_back("CLIP_AGAINST_OPTIC");
  if (surface.geometry) defines.emplace_back("GEOMETRY");
  return surface_programs_
      .emplace(key, make_program({"raster_view.glsl", "raster_surface.vert.glsl"},
                                 {"raster_view.glsl", "raster_lights.glsl", "raster_shading.glsl",
                                  "raster_surface.frag.glsl"},
                                 defines))
      .first->second;
}

const GlProgram& RasterScene::sky_program(bool geometry) {
  const auto found = sky_programs_.find({geometry, shading_samples_});
  if (found != sky_programs_.end()) return found->second;
  std::vector<std::string> defines = shading_defines();
  if (geometry) defines.emplace_back("GEOMETRY");
  return sky_programs_
      .emplace(std::pair(geometry, shading_samples_),
               make_program(
                   {"raster_view.glsl", "raster_sky.vert.glsl"},
                   {"raster_view.glsl", "raster_lights.glsl", "raster_shading.glsl", "raster_sky.frag.glsl"},
                   defines))
      .first->second;
}

}  // namespace catoptra::render

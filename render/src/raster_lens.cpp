#include "render/src/raster_lens.h"

#include <algorithm>
#include <glm/vec4.hpp>
#include <string>

#include "render/src/raster_scene.h"

namespace catoptra::render {
namespace {

// As in raster_lens.vert.glsl and raster_lens.glsl.
constexpr GLuint kExitAttribute = 2, kMaskAttribute = 3, kShownAttribute = 4;
constexpr GLuint kMaskUnit = 5;
constexpr GLint kBlockedColor = 3, kOpticId = 6, kCounts = 11, kWeight = 12;

// Wavelengths per draw: attributes and interpolants for this many are there in any OpenGL 4.5.
constexpr std::size_t kSamplesPerDraw = 4;

struct Exit {
  glm::vec3 position;
  float transmittance;
  glm::vec2 mask;
};

}  // namespace

const GlProgram& LensPrograms::program(LensLook look, std::size_t samples, bool geometry) {
  const std::tuple key{look, samples, geometry};
  const auto found = programs_.find(key);
  if (found != programs_.end()) return found->second;
  std::vector<std::string> defines{"SAMPLES " + std::to_string(samples)};
  if (geometry) defines.emplace_back("GEOMETRY");
  if (look == LensLook::nested || look == LensLook::nested_clipped) defines.emplace_back("IN_MAP");
  if (look == LensLook::nested_clipped) defines.emplace_back("CLIP_AGAINST_OPTIC");
  return programs_
      .emplace(key, make_program(
                        {"raster_view.glsl", "raster_lens.vert.glsl"},
                        {"raster_view.glsl", "raster_shading.glsl", "raster_shown.glsl", "raster_lens.glsl",
                         look == LensLook::cube ? "cubemap_lens.frag.glsl" : "pvrr_lens.frag.glsl"},
                        defines))
      .first->second;
}

void RasterLens::set_shown(const RasterOptic& side, const LensMask& mask, const LensRays& rays,
                           const std::vector<std::vector<glm::dvec3>>& shown) {
  side_ = &side;
  mask_ = &mask;
  batches_.clear();
  const std::size_t vertices = rays.hits[0].size(), samples = rays.samples.size();
  std::vector<Exit> exits;
  exits.reserve(vertices);
  for (const optics::VertexHit& hit : rays.hits[0])
    exits.push_back({glm::vec3(hit.surface_point_mm - side.center_mm()), float(hit.transmittance),
                     glm::vec2(mask.place(hit.surface_point_mm))});
  exits_ = make_static_buffer(std::as_bytes(std::span(exits)));
  for (std::size_t first = 0; first < samples; first += kSamplesPerDraw) {
    const std::size_t count = std::min(kSamplesPerDraw, samples - first);
    Batch batch;
    std::vector<glm::vec4> values;
    values.reserve(vertices * count);
    for (std::size_t i = 0; i < vertices; ++i)
      for (std::size_t k = first; k < first + count; ++k)
        values.emplace_back(glm::vec3(shown[k][i]), rays.open[k][i]);
    batch.shown = make_static_buffer(std::as_bytes(std::span(values)));
    batch.array = side.make_array();
    bind_attributes(batch.array, 1, exits_, sizeof(Exit),
                    {{kExitAttribute, 4, 0}, {kMaskAttribute, 2, sizeof(glm::vec4)}});
    for (std::size_t k = 0; k < count; ++k) {
      bind_attributes(batch.array, 2, batch.shown, static_cast<GLsizei>(count * sizeof(glm::vec4)),
                      {{kShownAttribute + GLuint(k), 4, GLuint(k * sizeof(glm::vec4))}});
      batch.weights.emplace_back(rays.samples[first + k].weight);
    }
    batches_.push_back(std::move(batch));
  }
}

void RasterLens::draw(const RasterView& camera, const RasterTarget& target, bool geometry, LensLook look,
                      LensPrograms& programs, const optics::Optic& lens, std::size_t index, float ambient,
                      const SetLook& set_look) const {
  const glm::vec3 blocked_color = ambient * lens.rim_color;
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    const Batch& batch = batches_[b];
    if (b == 1) {  // the first draw has left its depth where the lens shows; the others add to its colour
      target.bind(false);
      glDepthFunc(GL_EQUAL);
      glEnable(GL_BLEND);
      glBlendFunc(GL_ONE, GL_ONE);
    }
    glUseProgram(programs.program(look, batch.weights.size(), geometry && b == 0).id());
    RasterScene::set_mesh_origin(camera, *side_);
    glUniform3f(kBlockedColor, blocked_color.x, blocked_color.y, blocked_color.z);
    glUniform1f(kOpticId, float(index));
    if (look == LensLook::map) glUniform1i(kCounts, b == 0);
    glUniformMatrix3fv(kWeight, GLsizei(batch.weights.size()), GL_FALSE, &batch.weights[0][0].x);
    glBindTextureUnit(kMaskUnit, mask_->texture().id());
    for (std::size_t part = 0; part < side_->part_count(); ++part) {
      set_look(part, geometry && b == 0);
      side_->draw_part(part, batch.array);
    }
  }
  if (batches_.size() < 2) return;
  glDepthFunc(GL_GREATER);
  glDisable(GL_BLEND);
  target.bind(geometry);
}

}  // namespace catoptra::render

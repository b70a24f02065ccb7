#include "render/src/raster_shadows.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "render/src/raster_picture.h"
#include "render/src/raster_scene.h"
#include "render/src/scissor_within.h"

namespace catoptra::render {
namespace {

// As in raster_lights.glsl, shadow_volume.vert.glsl and shadow_fold.frag.glsl.
constexpr GLuint kVisibilityUnit = 8, kLightsBinding = 1;
constexpr GLint kLight = 2, kReach = 3, kBits = 0;

// The near cap lies where the lit surface does: by so much (slopes and roundings of depth) it is drawn behind
// what faces the light, and before what turns from it, which is not in its own shadow.
constexpr float kCapSlope = 0.5f, kCapRoundings = 8;

// In parallel views nothing can be drawn at infinity: volumes of point lights end at 10 km.
constexpr float kParallelReach_mm = 1e7f;

std::size_t bits_of(std::span<const ShadowPoint> points) {
  std::size_t bits = 0;
  for (const ShadowPoint& point : points) bits = std::max(bits, std::size_t(point.bit + 1));
  return bits;
}

bool casts(const optics::Optic& optic) {
  return optic.kind != optics::OpticKind::lens;
}

/// Surroundings that are not tested for alpha.
TriangleSoup surroundings_soup(const Scene& scene) {
  TriangleSoup soup;
  for (const auto& mesh : scene.surroundings)
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.materials[mesh.triangle_material[t]].alpha_cutoff > 0) continue;
      for (int k = 0; k < 3; ++k) soup.push_back(mesh.positions[mesh.triangles[t][k]]);
    }
  return soup;
}

/// Relative to `center_mm`, in the optic's own frame.
TriangleSoup optic_soup(const optics::Optic& optic, const glm::dvec3& center_mm) {
  TriangleSoup soup;
  for (const auto& t : optic.mesh.triangles)
    for (const std::uint32_t vertex : t.vertices)
      soup.emplace_back(optic.mesh.vertices[vertex].position_mm - center_mm);
  return soup;
}

/// Whether anything of the box, or of what it shadows, may lie in the view.
bool reaches_view(const glm::dmat4& clip_from_own, const cad_import::BoundingBox& box,
                  const glm::dvec4& light) {
  std::array<glm::dvec4, 16> corners;
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 p(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                       k & 4 ? box.max.z : box.min.z);
    corners[std::size_t(k)] = clip_from_own * glm::dvec4(p, 1);
    corners[std::size_t(8 + k)] = clip_from_own * glm::dvec4(light.w * p - glm::dvec3(light), 0);
  }
  const auto all_beyond = [&](const auto& value) {
    return std::ranges::all_of(corners, [&](const glm::dvec4& c) {
      return value(c) < -1e-6 * (std::abs(c.w) + glm::length(glm::dvec3(c)));
    });
  };
  return !(all_beyond([](const glm::dvec4& c) { return c.w + c.x; }) ||
           all_beyond([](const glm::dvec4& c) { return c.w - c.x; }) ||
           all_beyond([](const glm::dvec4& c) { return c.w + c.y; }) ||
           all_beyond([](const glm::dvec4& c) { return c.w - c.y; }) ||
           all_beyond([](const glm::dvec4& c) { return c.w - c.z; }));
}

/// Clip space from the casters' own, in double precision.
glm::dmat4 clip_from_own(const RasterView& view, const glm::dvec3& center_mm,
                         const optics::Placement& placement) {
  glm::dmat4 relative(placement.rotation);
  relative[3] = glm::dvec4(placement.point(center_mm) - view.origin_mm, 1);
  return view.clip_from_relative() * relative;
}

struct DrawRanges {
  std::vector<GLsizei> counts;
  std::vector<const void*> offsets;
  void add(std::size_t first, std::size_t count) {
    if (count == 0) return;
    counts.push_back(GLsizei(count));
    offsets.push_back(reinterpret_cast<const void*>(first * sizeof(std::uint32_t)));
  }
  void draw() const {
    if (counts.empty()) return;
    glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, offsets.data(), GLsizei(counts.size()));
  }
};

}  // namespace

bool has_shadows(const Scene& scene) {
  return std::ranges::any_of(scene.lights, &Light::shadows);
}

void add_shadows(const ShadowStats& shadows, FrameStats& stats) {
  stats.shadows = shadows;
  if (shadows.views > 0) stats.time_ms["shadow"] = shadows.time_ms;
}

/// One view in work.
struct RasterShadows::Counting {
  const RasterView& view;
  bool turned;           ///< what is farther from the view's origin hides what is nearer: zooming_view()
  std::size_t most = 0;  ///< the count may be as high as that
};

RasterShadows::RasterShadows(const Scene& scene)
    : scene_(scene),
      levels_(scene.settings.soft_shadows == SoftShadows::levels),
      gpu_points_(make_dynamic_buffer(sizeof(GpuShadowPoint))),
      volume_program_(
          make_program({"raster_view.glsl", "shadow_volume.vert.glsl"}, {"raster_depth.frag.glsl"})),
      fold_program_(make_program({"raster_accumulate.vert.glsl"}, {"shadow_fold.frag.glsl"})),
      nothing_(make_vertex_array({})) {
  sets_.resize(1 + scene.optics.size());
  stale_.resize(sets_.size(), false);
  sets_[0].mesh = make_shadow_casters(surroundings_soup(scene));
  upload(sets_[0]);
  for (std::size_t i = 0; i < scene.optics.size(); ++i) optic_changed(i);
  update_lights();
}

void RasterShadows::upload(Casters& casters) const {
  std::vector<glm::vec4> vertices;
  vertices.reserve(2 * casters.mesh.positions.size());
  for (const glm::vec3& p : casters.mesh.positions) {
    vertices.emplace_back(p, 1);
    vertices.emplace_back(p, 0);
  }
  casters.vertices = make_static_buffer(std::as_bytes(std::span(vertices)));
  casters.array = make_vertex_array({});
  bind_attributes(casters.array, 0, casters.vertices, sizeof(glm::vec4), {{0, 4, 0}});
}

void RasterShadows::optic_changed(std::size_t index) {
  Casters& casters = sets_[1 + index];
  if (!casts(scene_.optics[index])) return;
  casters.center_mm = area_centroid(scene_.optics[index].mesh);
  casters.mesh = make_shadow_casters(optic_soup(scene_.optics[index], casters.center_mm));
  upload(casters);
  stale_[1 + index] = true;
  lights_hold_ = false;
}

void RasterShadows::place_optic(std::size_t index, const optics::Placement& placement) {
  Casters& casters = sets_[1 + index];
  if (placement == casters.placement) return;
  casters.placement = placement;
  stale_[1 + index] = true;
  lights_hold_ = false;
}

/// Virtual lights for where the planar optics are now.
void RasterShadows::update_lights() {
  Scene now;
  now.file = scene_.file;
  now.lights = scene_.lights;
  now.settings = scene_.settings;
  for (std::size_t i = 0; i < scene_.optics.size(); ++i)
    now.optics.push_back(optics::placed(scene_.optics[i], sets_[1 + i].placement));
  lights_ = scene_lights(now);
  points_ = shadow_points(now, lights_, levels_);
  direct_.resize(lights_.points.size());
  for (auto& of_point : direct_) of_point.resize(sets_.size());
  beams_.clear();
  lights_hold_ = true;
}

TriangleSoup RasterShadows::world_soup(std::size_t set) const {
  const Casters& casters = sets_[set];
  TriangleSoup soup;
  soup.reserve(3 * casters.mesh.triangles.size());
  for (const auto& triangle : casters.mesh.triangles)
    for (const std::uint32_t corner : triangle.corners)
      soup.emplace_back(
          casters.placement.point(glm::dvec3(casters.mesh.positions[corner]) + casters.center_mm));
  return soup;
}

RasterShadows::Volume RasterShadows::make_volume(const Casters& casters,
                                                 const optics::LightPlace& light) const {
  Volume made;
  made.casters = &casters;
  made.light = light.w == 0
                   ? glm::dvec4(casters.placement.own_direction(glm::dvec3(light)), 0)
                   : glm::dvec4(casters.placement.own_point(glm::dvec3(light)) - casters.center_mm, 1);
  made.volume = make_shadow_volume(casters.mesh, made.light);
  return made;
}

void RasterShadows::upload(Volume& volume) {
  volume.indices = make_static_buffer(std::as_bytes(std::span(volume.volume.indices)));
}

void RasterShadows::update_direct() {
  for (std::size_t set = 0; set < sets_.size(); ++set) {
    if (!stale_[set]) continue;
    for (auto& of_point : direct_) of_point[set].reset();
    stale_[set] = false;
  }
  std::vector<std::pair<std::size_t, std::size_t>> missing;
  for (std::size_t i = 0; i < direct_.size(); ++i)
    for (std::size_t set = 0; lights_.points[i].shadows && set < sets_.size(); ++set)
      if (!direct_[i][set] && !sets_[set].mesh.triangles.empty()) missing.emplace_back(i, set);
  tbb::parallel_for(std::size_t(0), missing.size(), [&](std::size_t k) {
    const auto [i, set] = missing[k];
    direct_[i][set] = make_volume(sets_[set], lights_.points[i].place);
  });
  for (const auto& [i, set] : missing) upload(*direct_[i][set]);
}

void RasterShadows::update_beams() {
  const std::size_t first = lights_.points.size();
  if (beams_.size() == points_.size() - first) return;
  std::vector<TriangleSoup> soups;
  for (std::size_t set = 0; set < sets_.size(); ++set) soups.push_back(world_soup(set));
  beams_.resize(points_.size() - first);
  tbb::parallel_for(std::size_t(0), beams_.size(), [&](std::size_t k) {
    const LightPoint& point = lights_.points[points_[first + k].point];
    const auto index = std::size_t(points_[first + k].virtual_light);
    const optics::LightPlace& place = point.virtual_lights[index].place;
    Beam& beam = beams_[k];
    beam.aperture.mesh = make_shadow_casters(aperture_triangles(point.virtual_lights[index]));
    beam.casters.mesh =
        make_shadow_casters(virtual_light_casters(soups, point.place, point.virtual_lights, index));
    beam.light_volume = make_volume(beam.aperture, place);
    beam.shadows = make_volume(beam.casters, place);
  });
  for (Beam& beam : beams_) {
    upload(beam.aperture);
    upload(beam.casters);
    upload(beam.light_volume);
    upload(beam.shadows);
  }
}

void RasterShadows::update() {
  if (!lights_hold_) update_lights();
  update_direct();
  update_beams();
}

std::vector<std::string> RasterShadows::defines(int multisample) const {
  std::vector<std::string> defines{"LIGHT_POINTS " + std::to_string(lights_.points.size())};
  if (!lights_.faces.empty()) defines.emplace_back("VIRTUAL_LIGHTS");
  if (multisample > 1) defines.emplace_back("SHADOW_SAMPLES " + std::to_string(multisample));
  return defines;
}

void RasterShadows::bind_lights(const RasterView& view) {
  if (!lights_hold_) update_lights();
  const auto gpu = gpu_shadow_points(points_, lights_, view.origin_mm);
  update_buffer(gpu_points_, std::as_bytes(std::span(gpu)));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kLightsBinding, gpu_points_.id());
}

void RasterShadows::draw(const RasterView& view, int multisample, const std::function<void()>& draw_depth) {
  GLint bound = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
  statistics_.time_ms += gl_time_ms([&] {
    update();
    target_.fit(view.corner + view.size, multisample, int(bits_of(points_)));
    // Virtual lights are nowhere but in their light volumes.
    target_.clear(int(bits_of(std::span(points_).first(lights_.points.size()))));
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw_depth();
    glDisable(GL_CLIP_DISTANCE0);  // of the view; not every program below writes it
    Counting counting{view, view.depth_of_near < view.depth_of_far};
    glEnable(GL_STENCIL_TEST);
    glDepthMask(GL_FALSE);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const int bit = points_[i].bit;
      if (bit < 0) continue;
      target_.bind(bit / 32);
      if (points_[i].virtual_light < 0)
        count_direct(counting, points_[i].point, bit);
      else
        count_beam(counting, beams_[i - lights_.points.size()], bit);
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_STENCIL_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  });
  ++statistics_.views;
  glBindFramebuffer(GL_FRAMEBUFFER, GLuint(bound));
  glBindTextureUnit(kVisibilityUnit, target_.bits().id());
}

void RasterShadows::count_direct(Counting& counting, std::size_t point, int bit) {
  for (const auto& volume : direct_[point])
    if (volume) count(counting, *volume, bit, Fold::shade);
  if (counting.most > 0) fold(counting, bit, Fold::shade);
}

void RasterShadows::count_beam(Counting& counting, const Beam& beam, int bit) {
  const ScissorWithin scissor(counting.view, beam.aperture.mesh.positions, beam.light_volume.light);
  if (scissor.empty()) return;
  count(counting, beam.light_volume, bit, Fold::light);
  if (counting.most == 0) return;
  fold(counting, bit, Fold::light);
  count(counting, beam.shadows, bit, Fold::shade);
  if (counting.most > 0) fold(counting, bit, Fold::shade);
}

void RasterShadows::count(Counting& counting, const Volume& volume, int bit, Fold by) {
  for (const ShadowVolume::Batch& batch : volume.volume.batches) {
    if (counting.most + batch.most > kMostOverlaps) fold(counting, bit, by);
    draw_volume(counting, volume, batch);
  }
}

void RasterShadows::draw_volume(Counting& counting, const Volume& volume, const ShadowVolume::Batch& batch) {
  const Casters& casters = *volume.casters;
  const glm::dmat4 to_clip = clip_from_own(counting.view, casters.center_mm, casters.placement);
  DrawRanges sides, caps;
  for (std::size_t i = batch.first; i < batch.first + batch.count; ++i) {
    const ShadowVolume::Part& part = volume.volume.parts[i];
    if (!reaches_view(to_clip, part.box, volume.light)) continue;
    sides.add(part.first, part.side_count);
    caps.add(part.first + part.side_count, part.cap_count);
    ++statistics_.volumes;
  }
  if (caps.counts.empty()) return;
  statistics_.stencil_draws += 3;
  statistics_.silhouette_edges += volume.volume.silhouette_edges;
  counting.most += batch.most;

  glUseProgram(volume_program_.id());
  RasterScene::set_mesh_origin(counting.view, casters.center_mm, casters.placement);
  glUniform4f(kLight, float(volume.light.x), float(volume.light.y), float(volume.light.z),
              float(volume.light.w));
  const bool parallel = counting.view.projection[2][3] == 0;
  glUniform1f(kReach, parallel && volume.light.w != 0 ? kParallelReach_mm : 0);
  glBindVertexArray(casters.array.id());
  glVertexArrayElementBuffer(casters.array.id(), volume.indices.id());
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_CLIP_DISTANCE0);
  glDepthFunc(GL_GREATER);
  // Faces beyond the surface as seen from the view's origin, that is, where they are hidden; in a zooming
  // view where they are not.
  glStencilFunc(GL_ALWAYS, 0, 0xff);
  for (const auto& [face, step] :
       {std::pair{GLenum(GL_FRONT), GLenum(GL_DECR_WRAP)}, std::pair{GLenum(GL_BACK), GLenum(GL_INCR_WRAP)}})
    glStencilOpSeparate(face, GL_KEEP, counting.turned ? GL_KEEP : step, counting.turned ? step : GL_KEEP);
  sides.draw();
  glEnable(GL_CULL_FACE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  for (const auto& [culled, sense] : {std::pair{GLenum(GL_BACK), -1.0f}, std::pair{GLenum(GL_FRONT), 1.0f}}) {
    glCullFace(culled);
    glPolygonOffset(sense * kCapSlope, sense * kCapRoundings);
    caps.draw();
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CULL_FACE);
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_DEPTH_CLAMP);
}

/// Also sets the count to 0.
void RasterShadows::fold(Counting& counting, int bit, Fold by) {
  glUseProgram(fold_program_.id());
  glUniform1ui(kBits, 1u << (bit % 32));
  glBindVertexArray(nothing_.id());
  glDisable(GL_DEPTH_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_COLOR_LOGIC_OP);
  glLogicOp(by == Fold::light ? GL_OR : GL_AND_INVERTED);
  glStencilFunc(GL_NOTEQUAL, 0, 0xff);
  glStencilOp(GL_ZERO, GL_ZERO, GL_ZERO);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_COLOR_LOGIC_OP);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glEnable(GL_DEPTH_TEST);
  counting.most = 0;
  ++statistics_.folds;
}

ShadowStats RasterShadows::take_statistics() {
  return std::exchange(statistics_, {});
}

}  // namespace catoptra::render

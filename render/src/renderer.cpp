#include "render/renderer.h"

#include <algorithm>
#include <string>

#include "cad_import/error.h"
#include "optics/ray_scene.h"
#include "render/src/cubemap_frame.h"
#include "render/src/gl_context.h"
#include "render/src/hybrid_frame.h"
#include "render/src/pvrr_frame.h"
#include "render/src/raster_scene.h"
#include "render/src/ray_tracer.h"
#include "render/src/shading.h"
#include "render/src/textures.h"

namespace catoptra::render {
namespace {

void widen(cad_import::BoundingBox& box, const glm::dvec3& point) {
  box.min = glm::min(box.min, point);
  box.max = glm::max(box.max, point);
}

cad_import::BoundingBox bounds_of(const Scene& scene) {
  cad_import::BoundingBox box;
  for (const auto& mesh : scene.surroundings)
    for (const glm::vec3& p : mesh.positions) widen(box, glm::dvec3(p));
  for (const auto& optic : scene.optics)
    for (const auto* mesh : {&optic.mesh, &optic.back.mesh})
      for (const auto& vertex : mesh->vertices) widen(box, vertex.position_mm);
  return box;
}

/// Everything that lives on the GPU. Members go in reverse order, with the context current (see ~Impl).
struct Gpu {
  Gpu(const Scene& scene, const SceneTextures& textures, const optics::RayScene& rays,
      const RayTracer& tracer)
      : raster(scene, textures),
        pvrr(scene, raster, rays, bounds_of(scene)),
        cubemap(scene, raster),
        hybrid(scene, raster, tracer) {}
  RasterScene raster;
  RasterPicture picture;
  PvrrFrame pvrr;
  CubemapFrame cubemap;
  HybridFrame hybrid;
};

}  // namespace

struct Renderer::Impl {
  explicit Impl(const Scene& s) : scene(s), textures(load_textures(s)) {
    for (std::size_t m = 0; m < scene.surroundings.size(); ++m)
      rays.add_surroundings(scene.surroundings[m],
                            make_alpha_test(scene.surroundings[m], textures.textures[m]));
    for (const optics::Optic& optic : scene.optics)
      optic_objects.push_back(rays.add_optic(mesh_for_rays(optic)));
    rays.commit();
    tracer = std::make_unique<RayTracer>(scene, textures, rays);
  }

  ~Impl() {
    if (!gpu) return;
    try {
      const GlScope scope(*context);
      gpu.reset();
    } catch (const Error&) {
      // Another thread still draws with the context: its objects go with it.
    }
  }

  RenderResult render_on_gpu(Mode mode, const Camera& camera, const FrameOptions& options) {
    if (!context) context = GlContext::create();
    const GlScope scope(*context);
    if (!gpu) gpu = std::make_unique<Gpu>(scene, textures, rays, *tracer);
    RenderResult result = mode == Mode::pvrr      ? gpu->pvrr.render(camera, options, gpu->picture)
                          : mode == Mode::cubemap ? gpu->cubemap.render(camera, options, gpu->picture)
                                                  : gpu->hybrid.render(camera, options, gpu->picture);
    context->throw_if_errors();
    return result;
  }

  const Scene& scene;
  SceneTextures textures;
  optics::RayScene rays;
  std::vector<std::uint32_t> optic_objects;  ///< numbers in `rays`
  std::unique_ptr<RayTracer> tracer;
  std::unique_ptr<GlContext> context;
  std::unique_ptr<Gpu> gpu;
};

Renderer::Renderer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Renderer::~Renderer() = default;

RenderResult Renderer::render(Mode mode, const Camera& camera, const FrameOptions& options) {
  if (options.width < 1 || options.height < 1 || options.samples < 1)
    throw Error(impl_->scene.file, "resolution",
                "cannot make a picture of " + std::to_string(options.width) + " x " +
                    std::to_string(options.height) + " pixels with " + std::to_string(options.samples) +
                    " samples");
  if (mode == Mode::raytrace) return impl_->tracer->render(camera, options);
  return impl_->render_on_gpu(mode, camera, options);
}

void Renderer::optic_changed(std::size_t index) {
  const optics::Optic& optic = impl_->scene.optics.at(index);
  impl_->rays.update_optic(impl_->optic_objects[index], mesh_for_rays(optic));
  impl_->rays.commit();
  impl_->tracer->optic_changed(index);
  if (!impl_->gpu) return;
  const GlScope scope(*impl_->context);
  impl_->gpu->raster.optic_changed(index);
  impl_->gpu->pvrr.optic_changed(index);
  impl_->gpu->cubemap.optic_changed(index);
}

double Renderer::bare_packet_ms(const Camera& camera, const FrameOptions& options) const {
  return impl_->tracer->bare_packet_ms(camera, options);
}

}  // namespace catoptra::render

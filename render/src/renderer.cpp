#include "render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cad_import/error.h"
#include "optics/placement.h"
#include "optics/ray_scene.h"
#include "render/src/cubemap_frame.h"
#include "render/src/exact_frame.h"
#include "render/src/gl_context.h"
#include "render/src/hybrid_frame.h"
#include "render/src/mode_chooser.h"
#include "render/src/pvrr_frame.h"
#include "render/src/raster_scene.h"
#include "render/src/ray_tracer.h"
#include "render/src/sample_mean.h"
#include "render/src/sampling.h"
#include "render/src/scene_lights.h"
#include "render/src/shading.h"
#include "render/src/textures.h"
#include "render/src/wrong_share.h"

namespace catoptra::render {
namespace {

void widen(cad_import::BoundingBox& box, const glm::dvec3& point) {
  box.min = glm::min(box.min, point);
  box.max = glm::max(box.max, point);
}

cad_import::BoundingBox bounds_of(const std::vector<cad_import::TriangleMesh>& surroundings) {
  cad_import::BoundingBox box;
  for (const auto& mesh : surroundings)
    for (const glm::vec3& p : mesh.positions) widen(box, glm::dvec3(p));
  return box;
}

cad_import::BoundingBox bounds_of(const optics::Optic& optic) {
  cad_import::BoundingBox box;
  for (const auto* mesh : {&optic.mesh, &optic.back.mesh})
    for (const auto& vertex : mesh->vertices) widen(box, vertex.position_mm);
  return box;
}

void drop_geometry(Frame& frame) {
  frame.position.clear();
  frame.surface.clear();
  frame.direction.clear();
  frame.optic_id.clear();
}

void check_options(const Scene& scene, const Camera& camera, const FrameOptions& options) {
  if (options.width < 1 || options.height < 1 || options.samples < 1)
    throw Error(scene.file, "resolution",
                "cannot make a picture of " + std::to_string(options.width) + " x " +
                    std::to_string(options.height) + " pixels with " + std::to_string(options.samples) +
                    " samples");
  if (!(camera.pupil_mm >= 0) || !(camera.focus_mm >= 0) || !std::isfinite(camera.pupil_mm + camera.focus_mm))
    throw Error(scene.file, "camera", "pupil and focus cannot be negative",
                "0 stands for a point, and for the target");
  const int m = options.multisample;
  if (m != 1 && m != 2 && m != 4 && m != 8)
    throw Error(scene.file, "multisample", std::to_string(m) + " is not 1, 2, 4 or 8");
}

/// Everything that lives on the GPU. Members go in reverse order, with the context current (see ~Impl).
struct Gpu {
  Gpu(const Scene& scene, const SceneTextures& textures, const optics::RayScene& rays,
      const cad_import::BoundingBox& bounds)
      : raster(scene, textures),
        picture(scene.optics.size()),
        pvrr(scene, raster, rays, bounds),
        cubemap(scene, raster),
        hybrid(scene, raster),
        exact(scene, raster, pvrr) {}
  RasterScene raster;
  RasterPicture picture;
  PvrrFrame pvrr;
  CubemapFrame cubemap;
  HybridFrame hybrid;
  ExactFrame exact;
};

}  // namespace

struct Renderer::Impl {
  explicit Impl(const Scene& s)
      : scene(s),
        textures(load_textures(s)),
        placements(s.optics.size()),
        surroundings_box(bounds_of(s.surroundings)),
        untraced(s.optics.size(), false) {
    for (std::size_t m = 0; m < scene.surroundings.size(); ++m)
      rays.add_surroundings(scene.surroundings[m],
                            make_alpha_test(scene.surroundings[m], textures.textures[m]));
    for (const optics::Optic& optic : scene.optics) {
      optic_objects.push_back(rays.add_optic(mesh_for_rays(optic), mask_for_rays(optic)));
      optic_boxes.push_back(bounds_of(optic));
    }
    rays.commit();
    tracer = std::make_unique<RayTracer>(scene, textures, rays);
    light_limit = light_warning(scene, scene_lights(scene));
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

  /// Samples until there are `until` of them, and their mean.
  RenderResult render_until(Mode mode, const Camera& camera, const FrameOptions& options, int until) {
    RenderResult result = mode == Mode::raytrace ? draw_samples(mode, camera, options, until)
                                                 : raster_until(mode, camera, options, until);
    if (light_limit) result.warnings.push_back(*light_limit);
    return result;
  }

  RenderResult raster_until(Mode mode, const Camera& camera, const FrameOptions& options, int until) {
    if (!context) context = GlContext::create();
    const GlScope scope(*context);
    if (!gpu) {
      gpu = std::make_unique<Gpu>(scene, textures, rays, bounds());
      for (std::size_t i = 0; i < placements.size(); ++i) place_on_gpu(i);
    }
    RenderResult result = draw_samples(mode, camera, options, until);
    context->throw_if_errors();
    return result;
  }

  /// Whether a picture has nothing new against the last one, and may use it.
  bool stays(const Camera& camera, const FrameOptions& options) {
    const bool same = last_camera && last_camera->eye_mm == camera.eye_mm &&
                      last_camera->target_mm == camera.target_mm && last_camera->up == camera.up &&
                      last_camera->fov_rad == camera.fov_rad;
    last_camera = camera;
    return same && options.reuse_static;
  }

  bool can_raster() {
    try {
      if (!context) context = GlContext::create();
      return true;
    } catch (const Error&) {
      return false;
    }
  }

  RenderResult render(Mode mode, const Camera& camera, const FrameOptions& options) {
    if (mode == Mode::automatic) return render_automatically(camera, options);
    samples.restart();
    return render_until(mode, camera, options, options.samples);
  }

  /// A picture by the mode that the chooser takes, and before it the small ones from which that predicts.
  RenderResult render_automatically(const Camera& camera, const FrameOptions& options) {
    if (!chooser) chooser.emplace(scene.settings.max_error_px, !scene.optics.empty(), can_raster());
    const FrameKind kind{{options.width, options.height}, options.samples, stays(camera, options)};
    double trial_ms = 0;
    while (const auto trial = chooser->next_trial(kind)) {
      FrameOptions small = options;
      small.width = trial->size.x;
      small.height = trial->size.y;
      small.samples = 1;
      small.reuse_static = small.geometry = false;
      const FrameCost cost = timed(trial->mode, camera, small).second;
      chooser->trial_drawn(*trial, cost);
      trial_ms += cost.total_ms;
    }
    ModeChoice choice = chooser->choose(kind);
    choice.trial_ms = trial_ms;
    // Now and then what pvrr shows is judged by the exact picture.
    const bool verify = choice.mode == Mode::exact && chooser->asks_for_verification();
    FrameOptions drawn = options;
    drawn.geometry = options.geometry || verify;
    drawn.read_back = options.read_back || verify;
    auto [result, cost] = timed(choice.mode, camera, drawn);
    if (verify) {
      cost.wrong_share = wrong_share(result.frame, render(Mode::pvrr, camera, drawn).frame);
      if (!options.geometry) drop_geometry(result.frame);
    }
    chooser->frame_drawn(choice.mode, kind, cost);
    result.stats.time_ms["total"] += trial_ms;
    if (trial_ms > 0) result.stats.time_ms["trials"] = trial_ms;
    result.choice = std::move(choice);
    return std::move(result);
  }

  std::pair<RenderResult, FrameCost> timed(Mode mode, const Camera& camera, const FrameOptions& options) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    RenderResult result = render(mode, camera, options);
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    return {std::move(result), FrameCost{ms}};
  }

  RenderResult draw_samples(Mode mode, const Camera& camera, const FrameOptions& options, int until) {
    RasterPicture* const picture = gpu ? &gpu->picture : nullptr;
    if (picture && samples.count() == 0) picture->stop_sum();
    if (options.samples == 1) {
      RenderResult result = draw(mode, sample_camera(camera, 0, 1), options);
      if (mode != Mode::raytrace && gpu->picture.multisample() < options.multisample)
        result.warnings.push_back("the driver has " + std::to_string(gpu->picture.multisample()) +
                                  " of the " + std::to_string(options.multisample) +
                                  " multisamples asked for");
      if (camera.pupil_mm > 0)
        result.warnings.emplace_back(
            "the camera's pupil blurs nothing in a picture of one sample per pixel; use more samples");
      return result;
    }
    // The other modes put their pictures together on the CPU.
    RasterPicture* const on_gpu = mode == Mode::pvrr || mode == Mode::cubemap ? picture : nullptr;
    samples.add(camera, options, until, on_gpu, [&](const Camera& seen, const FrameOptions& of_sample) {
      return draw(mode, seen, of_sample);
    });
    return samples.mean(options, on_gpu);
  }

  /// One sample, or with hardware multisampling one picture.
  RenderResult draw(Mode mode, const Camera& camera, const FrameOptions& options) {
    switch (mode) {
      case Mode::raytrace:
        return placed_tracer().render(camera, options);
      case Mode::hybrid:
        return gpu->hybrid.render(camera, options, gpu->picture, placed_tracer());
      case Mode::exact:
        return gpu->exact.render(camera, options, gpu->picture, placed_tracer());
      case Mode::cubemap:
        return gpu->cubemap.render(camera, options, gpu->picture);
      default:
        return gpu->pvrr.render(camera, options, gpu->picture);
    }
  }

  void place_on_gpu(std::size_t index) {
    gpu->raster.place_optic(index, placements[index]);
    gpu->pvrr.place_optic(index, placements[index], bounds());
  }

  /// Of everything, in the world.
  cad_import::BoundingBox bounds() const {
    cad_import::BoundingBox box = surroundings_box;
    for (std::size_t i = 0; i < optic_boxes.size(); ++i) {
      const auto optic = optics::placed(optic_boxes[i], placements[i]);
      box.min = glm::min(box.min, optic.min);
      box.max = glm::max(box.max, optic.max);
    }
    return box;
  }

  /// The ray tracer with every optic where it is now. It works in the world, on optics that have been moved
  /// there.
  const RayTracer& placed_tracer() {
    if (std::find(untraced.begin(), untraced.end(), true) == untraced.end()) return *tracer;
    const bool first = !placed_scene;
    if (first) placed_scene = std::make_unique<Scene>(scene);
    for (std::size_t i = 0; i < untraced.size(); ++i) {
      if (!untraced[i]) continue;
      placed_scene->optics[i] = optics::placed(scene.optics[i], placements[i]);
      rays.update_optic(optic_objects[i], mesh_for_rays(placed_scene->optics[i]));
      untraced[i] = false;
      if (!first) tracer->optic_changed(i);
    }
    rays.commit();
    if (first) tracer = std::make_unique<RayTracer>(*placed_scene, textures, rays);
    return *tracer;
  }

  const Scene& scene;
  SceneTextures textures;
  optics::RayScene rays;
  std::vector<std::uint32_t> optic_objects;  ///< numbers in `rays`

  std::vector<optics::Placement> placements;
  cad_import::BoundingBox surroundings_box;
  std::vector<cad_import::BoundingBox> optic_boxes;  ///< of each optic in its own frame

  std::unique_ptr<Scene> placed_scene;  ///< as the tracer knows it; null while no optic has left its place
  std::vector<bool> untraced;           ///< optics that the tracer still has where or as they were
  std::unique_ptr<RayTracer> tracer;

  std::optional<std::string> light_limit;  ///< what is left out of the light by way of planar optics
  std::unique_ptr<GlContext> context;
  std::unique_ptr<Gpu> gpu;

  std::optional<ModeChooser> chooser;  ///< of mode automatic, from its first picture on
  std::optional<Camera> last_camera;   ///< mode automatic: of the last picture, where nothing has moved since

  /// Of the picture that accumulate() goes on with, as long as the same one is asked for.
  SampleMean samples;
  struct Accumulated {
    Mode mode;
    Camera camera;
    FrameOptions options;
    bool operator==(const Accumulated&) const = default;
  };
  std::optional<Accumulated> accumulated;
  Mode accumulated_mode = Mode::pvrr;            ///< which draws it
  std::optional<ModeChoice> accumulated_choice;  ///< mode automatic: why

  /// What mode automatic takes for a picture of one sample: the samples of a picture all have the same mode.
  ModeChoice choice_for_samples(const Camera& camera, FrameOptions options) {
    options.samples = 1;
    options.geometry = options.read_back = false;
    return *render_automatically(camera, options).choice;
  }

  void stop_accumulating() {
    accumulated.reset();
    samples.restart();
  }
};

Renderer::Renderer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Renderer::~Renderer() = default;

RenderResult Renderer::render(Mode mode, const Camera& camera, const FrameOptions& options) {
  check_options(impl_->scene, camera, options);
  impl_->stop_accumulating();
  return impl_->render(mode, camera, options);
}

RenderResult Renderer::accumulate(Mode mode, const Camera& camera, const FrameOptions& options, int more) {
  check_options(impl_->scene, camera, options);
  const Impl::Accumulated asked{mode, camera, options};
  if (impl_->accumulated != asked) {
    impl_->stop_accumulating();
    impl_->accumulated_choice.reset();
    if (mode == Mode::automatic) impl_->accumulated_choice = impl_->choice_for_samples(camera, options);
    impl_->accumulated_mode = impl_->accumulated_choice ? impl_->accumulated_choice->mode : mode;
    impl_->samples.restart();
    impl_->accumulated = asked;
  }
  const int until = std::min(impl_->samples.count() + std::max(more, 1), options.samples);
  try {
    RenderResult result = impl_->render_until(impl_->accumulated_mode, camera, options, until);
    result.choice = impl_->accumulated_choice;
    return result;
  } catch (...) {
    impl_->stop_accumulating();
    throw;
  }
}

void Renderer::optic_changed(std::size_t index) {
  impl_->stop_accumulating();
  const optics::Optic& optic = impl_->scene.optics.at(index);
  impl_->optic_boxes[index] = bounds_of(optic);
  impl_->last_camera.reset();
  if (impl_->chooser) impl_->chooser->forget();
  if (impl_->placed_scene) {
    impl_->untraced[index] = true;
  } else {
    impl_->rays.update_optic(impl_->optic_objects[index], mesh_for_rays(optic));
    impl_->rays.commit();
    impl_->tracer->optic_changed(index);
  }
  if (!impl_->gpu) return;
  const GlScope scope(*impl_->context);
  impl_->gpu->raster.optic_changed(index);
  impl_->gpu->pvrr.optic_changed(index, impl_->bounds());
  impl_->gpu->cubemap.optic_changed(index);
}

void Renderer::place_optic(std::size_t index, const glm::dmat4& placement) {
  const auto placed = optics::placement_from_matrix(placement, impl_->scene.optics.at(index).name);
  if (placed == impl_->placements[index]) return;
  impl_->stop_accumulating();
  impl_->placements[index] = placed;
  impl_->last_camera.reset();
  impl_->untraced[index] = true;
  if (impl_->gpu) impl_->place_on_gpu(index);
}

double Renderer::bare_packet_ms(const Camera& camera, const FrameOptions& options) const {
  return impl_->placed_tracer().bare_packet_ms(camera, options);
}

}  // namespace catoptra::render

// One picture of a scene by one of the modes.
#pragma once

#include <glm/mat4x4.hpp>
#include <memory>
#include <vector>

#include "render/frame.h"
#include "render/mode.h"
#include "render/scene.h"

namespace catoptra::render {

/// Everything the modes share for one scene, built once and used for many frames: decoded textures, the ray
/// scene, and, on first use, the GL context with the uploaded surroundings.
class Renderer {
 public:
  /// Copies nothing of `scene` (but see place_optic), which must outlive the renderer. Throws catoptra::Error
  /// (missing or broken texture).
  explicit Renderer(const Scene& scene);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Throws catoptra::Error where a mode needs OpenGL and no context can be made (it lists what was tried);
  /// Mode::automatic traces then.
  [[nodiscard]] RenderResult render(Mode mode, const Camera& camera, const FrameOptions& options);

  /// Time in ms of the bare packet queries of a raytrace frame: the yardstick of the reference's speed.
  [[nodiscard]] double bare_packet_ms(const Camera& camera, const FrameOptions& options) const;

  /// Tells the renderer that optic `index` in the scene has changed.
  void optic_changed(std::size_t index);

  /// Moves optic `index` rigidly: `placement` takes it from where the scene has it (not from where it was put
  /// last) to where it is from now on; nothing of it is built anew, and the scene stays as it is. Where the
  /// camera comes along, as with spectacles on a nose, mode pvrr keeps the rays of its vertices
  /// (FrameOptions::reuse_static); modes hybrid, exact and raytrace set up the exact surface again, and keep
  /// a copy of the scene from the first such picture on. Throws catoptra::Error where `placement` scales,
  /// shears or mirrors.
  void place_optic(std::size_t index, const glm::dmat4& placement);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptra::render

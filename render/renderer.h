// One picture of a scene by one of the modes.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "render/frame.h"
#include "render/scene.h"

namespace catoptra::render {

enum class Mode { pvrr, hybrid, raytrace, cubemap };

[[nodiscard]] std::string_view mode_name(Mode mode);
[[nodiscard]] std::optional<Mode> mode_from_name(std::string_view name);

/// Everything the modes share for one scene, built once and used for many frames: decoded textures, the ray scene, and,
/// on first use, the GL context with the uploaded surroundings.
class Renderer {
 public:
  /// Copies nothing of `scene`, which must outlive the renderer. Throws catoptra::Error (missing or broken texture).
  explicit Renderer(const Scene& scene);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Throws catoptra::Error where a mode needs OpenGL and no context can be made (it lists what was tried).
  [[nodiscard]] RenderResult render(Mode mode, const Camera& camera, const FrameOptions& options);

  /// Time in ms of the bare packet queries of a raytrace frame: the yardstick of the reference's speed.
  [[nodiscard]] double bare_packet_ms(const Camera& camera, const FrameOptions& options) const;

  /// Tells the renderer that the mesh of optic `index` in the scene has changed or moved.
  void optic_changed(std::size_t index);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptra::render

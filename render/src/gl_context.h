// An OpenGL 4.5 core context without a window, made through EGL.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace catoptra::render {

/// A context with no default framebuffer: everything is drawn into textures. One thread at a time may hold it
/// (see GlScope). The EGL display stays initialised when a context goes, since other contexts of the process
/// may share it.
class GlContext {
 public:
  /// Mesa's surfaceless platform: needs neither display server nor render node.
  [[nodiscard]] static std::unique_ptr<GlContext> surfaceless();
  /// The first EGL device (a GPU, with or without a display) on which a context can be made.
  [[nodiscard]] static std::unique_ptr<GlContext> device();
  /// The default display with a pbuffer of one pixel.
  [[nodiscard]] static std::unique_ptr<GlContext> pbuffer();

  /// A way to make a context, with the name it has in messages. Throws catoptra::Error where it fails.
  struct Factory {
    std::string name;
    std::function<std::unique_ptr<GlContext>()> make;
  };
  /// The first of `factories` that works. Throws catoptra::Error listing every attempt and why it failed.
  [[nodiscard]] static std::unique_ptr<GlContext> first_of(std::span<const Factory> factories);
  /// surfaceless, then device, then pbuffer.
  [[nodiscard]] static std::unique_ptr<GlContext> create();

  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// What draws, as the driver calls itself.
  [[nodiscard]] const std::string& renderer_name() const;

  /// Throws catoptra::Error with the first error that the driver's debug output has reported since the last
  /// call.
  void throw_if_errors();

 private:
  friend class GlScope;
  struct Impl;
  explicit GlContext(std::unique_ptr<Impl> impl);
  static std::unique_ptr<GlContext> from_display(void* display, bool with_surface);
  std::unique_ptr<Impl> impl_;
};

/// Makes a context current in this thread for its lifetime. Throws catoptra::Error where another thread holds
/// it.
class GlScope {
 public:
  explicit GlScope(GlContext& context);
  ~GlScope();
  GlScope(const GlScope&) = delete;
  GlScope& operator=(const GlScope&) = delete;

 private:
  GlContext& context_;
};

}  // namespace catoptra::render

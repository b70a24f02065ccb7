#include "render/src/gl_context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <string_view>

#include "cad_import/error.h"

namespace catoptra::render {
namespace {

[[noreturn]] void fail(const std::string& reason) {
  throw Error({}, "OpenGL", reason);
}

std::string egl_error() {
  switch (eglGetError()) {
    case EGL_SUCCESS:
      return "no EGL error";
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS:
      return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    default:
      return "another EGL error";
  }
}

/// True where the space-separated list `extensions` holds `name` (EGL lists are null where nothing is
/// supported).
bool has_extension(const char* extensions, std::string_view name) {
  if (!extensions) return false;
  const std::string_view list(extensions);
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(' ', begin), list.size());
    if (list.substr(begin, end - begin) == name) return true;
    begin = end + 1;
  }
  return false;
}

void require_client_extension(std::string_view name) {
  if (!has_extension(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), name))
    fail("EGL has no " + std::string(name));
}

}  // namespace

struct GlContext::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE;
  std::string renderer;
  std::vector<std::string> errors;

  ~Impl() {
    if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
  }

  static void GLAPIENTRY on_message(GLenum, GLenum type, GLuint, GLenum, GLsizei length,
                                    const GLchar* message, const void* self) {
    if (type != GL_DEBUG_TYPE_ERROR) return;
    // The pointer was handed to glDebugMessageCallback as const void* from a non-const Impl.
    auto& errors = const_cast<Impl*>(static_cast<const Impl*>(self))->errors;
    if (errors.size() < 16) errors.emplace_back(message, static_cast<std::size_t>(length < 0 ? 0 : length));
  }

  /// To be called with the context current.
  void set_up() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(&Impl::on_message, this);
    const GLubyte* name = glGetString(GL_RENDERER);
    renderer = name ? reinterpret_cast<const char*>(name) : "unknown";
  }
};

GlContext::GlContext(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GlContext::~GlContext() = default;

const std::string& GlContext::renderer_name() const {
  return impl_->renderer;
}

std::unique_ptr<GlContext> GlContext::from_display(void* display, bool with_surface) {
  auto impl = std::make_unique<Impl>();
  impl->display = display;
  if (display == EGL_NO_DISPLAY) fail("no display (" + egl_error() + ")");
  if (!eglInitialize(display, nullptr, nullptr))
    fail("the display cannot be initialised (" + egl_error() + ")");
  if (!eglBindAPI(EGL_OPENGL_API)) fail("the driver offers no desktop OpenGL (" + egl_error() + ")");
  if (!with_surface && !has_extension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
    fail("the display has no EGL_KHR_surfaceless_context");

  const std::array<EGLint, 5> config_wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                                            with_surface ? EGL_PBUFFER_BIT : 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, config_wanted.data(), &config, 1, &count) || count < 1)
    fail("no configuration for OpenGL (" + egl_error() + ")");

  const std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION,
                                      4,
                                      EGL_CONTEXT_MINOR_VERSION,
                                      5,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                      EGL_NONE};
  impl->context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
  if (impl->context == EGL_NO_CONTEXT) fail("no OpenGL 4.5 core context (" + egl_error() + ")");
  if (with_surface) {
    const std::array<EGLint, 5> one_pixel{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    impl->surface = eglCreatePbufferSurface(display, config, one_pixel.data());
    if (impl->surface == EGL_NO_SURFACE) fail("no pbuffer (" + egl_error() + ")");
  }
  std::unique_ptr<GlContext> context(new GlContext(std::move(impl)));
  const GlScope scope(*context);
  context->impl_->set_up();
  return context;
}

std::unique_ptr<GlContext> GlContext::surfaceless() {
  require_client_extension("EGL_EXT_platform_base");
  require_client_extension("EGL_MESA_platform_surfaceless");
  return from_display(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                      false);
}

std::unique_ptr<GlContext> GlContext::device() {
  require_client_extension("EGL_EXT_platform_base");
  require_client_extension("EGL_EXT_platform_device");
  require_client_extension("EGL_EXT_device_enumeration");
  EGLint count = 0;
  std::array<EGLDeviceEXT, 32> devices{};
  if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) || count < 1)
    fail("no EGL device (" + egl_error() + ")");
  std::string reasons;
  for (EGLint i = 0; i < count; ++i) {
    try {
      return from_display(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr), false);
    } catch (const Error& error) {
      reasons += (i ? ", " : "") + ("device " + std::to_string(i)) + ": " + error.reason();
    }
  }
  fail(reasons);
}

std::unique_ptr<GlContext> GlContext::pbuffer() {
  return from_display(eglGetDisplay(EGL_DEFAULT_DISPLAY), true);
}

std::unique_ptr<GlContext> GlContext::first_of(std::span<const Factory> factories) {
  std::string tried;
  for (const Factory& factory : factories) {
    try {
      return factory.make();
    } catch (const Error& error) {
      tried += (tried.empty() ? "" : "; ") + factory.name + ": " + error.reason();
    }
  }
  throw Error({}, "OpenGL", "no OpenGL 4.5 context can be made; tried " + tried,
              "install Mesa's software renderer: apt-get install libegl1 libgl1-mesa-dri");
}

std::unique_ptr<GlContext> GlContext::create() {
  const std::array<Factory, 3> factories{Factory{"EGL surfaceless", &GlContext::surfaceless},
                                         Factory{"EGL device", &GlContext::device},
                                         Factory{"EGL pbuffer", &GlContext::pbuffer}};
  return first_of(factories);
}

void GlContext::throw_if_errors() {
  if (impl_->errors.empty()) return;
  const std::string first = impl_->errors.front();
  impl_->errors.clear();
  fail(first);
}

GlScope::GlScope(GlContext& context) : context_(context) {
  const auto& impl = *context.impl_;
  if (!eglMakeCurrent(impl.display, impl.surface, impl.surface, impl.context))
    fail("the context cannot be made current; another thread may hold it (" + egl_error() + ")");
}

GlScope::~GlScope() {
  eglMakeCurrent(context_.impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace catoptra::render

// OpenGL objects that free themselves. All need a current context, also when they go.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace catoptra::render {

/// The name of an OpenGL object, freed by `Destroy`. Movable; 0 is none.
template <void (*Destroy)(GLuint)>
class GlHandle {
 public:
  GlHandle() = default;
  explicit GlHandle(GLuint id) : id_(id) {}
  GlHandle(GlHandle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlHandle& operator=(GlHandle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlHandle() {
    if (id_) Destroy(id_);
  }
  [[nodiscard]] GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  GLuint id_ = 0;
};

void destroy_gl_buffer(GLuint id);
void destroy_gl_vertex_array(GLuint id);
void destroy_gl_texture(GLuint id);
void destroy_gl_sampler(GLuint id);
void destroy_gl_framebuffer(GLuint id);
void destroy_gl_program(GLuint id);

using GlBuffer = GlHandle<destroy_gl_buffer>;
using GlVertexArray = GlHandle<destroy_gl_vertex_array>;
using GlTexture = GlHandle<destroy_gl_texture>;
using GlSampler = GlHandle<destroy_gl_sampler>;
using GlFramebuffer = GlHandle<destroy_gl_framebuffer>;
using GlProgram = GlHandle<destroy_gl_program>;

/// A buffer with the given content that never changes.
[[nodiscard]] GlBuffer make_static_buffer(std::span<const std::byte> content);
/// A buffer of `bytes` whose content changes from frame to frame (see update_buffer).
[[nodiscard]] GlBuffer make_dynamic_buffer(std::size_t bytes);
/// Replaces the whole content, in new storage where the GPU still reads the old one.
void update_buffer(const GlBuffer& buffer, std::span<const std::byte> content);

/// One attribute of a vertex: `components` floats from `offset` on, for shader location `location`.
struct GlAttribute {
  GLuint location;
  GLint components;
  GLuint offset;
};
[[nodiscard]] GlVertexArray make_vertex_array(const GlBuffer& indices);
/// Lets a vertex array read `attributes` from `buffer` at binding point `binding`.
void bind_attributes(const GlVertexArray& array, GLuint binding, const GlBuffer& buffer, GLsizei stride,
                     std::initializer_list<GlAttribute> attributes);

/// 2D texture with immutable storage; nearest or linear, clamped to its edge.
[[nodiscard]] GlTexture make_texture_2d(GLenum format, int width, int height, int levels, bool linear);
/// The same with `samples` places in each texel, to be drawn into and resolved.
[[nodiscard]] GlTexture make_texture_multisample(GLenum format, int width, int height, int samples);
/// The most samples up to `wanted`, 1 or more, that colour and depth can have here: a power of two.
[[nodiscard]] int available_multisamples(int wanted);
/// Cube map of `size` x `size` faces, one level, seamless where linear.
[[nodiscard]] GlTexture make_texture_cube(GLenum format, int size, bool linear);

/// Draw buffers are the colour attachments in order. Throws catoptra::Error where the driver calls it
/// incomplete.
[[nodiscard]] GlFramebuffer make_framebuffer(std::initializer_list<const GlTexture*> colors,
                                             const GlTexture* depth);

/// A linked program. Each stage is the concatenation of the named shader files (see gl_shaders.h) behind the
/// version line and one "#define NAME" per entry of `defines`. Throws catoptra::Error with the compiler's
/// message.
[[nodiscard]] GlProgram make_program(std::initializer_list<std::string_view> vertex_files,
                                     std::initializer_list<std::string_view> fragment_files,
                                     std::span<const std::string> defines = {});

}  // namespace catoptra::render

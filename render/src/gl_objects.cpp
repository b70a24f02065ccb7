#include "render/src/gl_objects.h"

#include <algorithm>
#include <array>
#include <vector>

#include "cad_import/error.h"
#include "render/src/gl_shaders.h"

namespace catoptra::render {
namespace {

using GlShader = GlHandle<[](GLuint id) { glDeleteShader(id); }>;

GlShader compile(GLenum stage, std::initializer_list<std::string_view> files,
                 std::span<const std::string> defines) {
  std::string text = "#version 450 core\n";
  for (const std::string& define : defines) text += "#define " + define + "\n";
  for (const std::string_view file : files) text += shader_source(file);

  GlShader shader(glCreateShader(stage));
  const char* source = text.c_str();
  glShaderSource(shader.id(), 1, &source, nullptr);
  glCompileShader(shader.id());
  GLint compiled = 0;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (!compiled) {
    std::array<char, 4096> log{};
    glGetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw Error({}, "shader " + std::string(*(files.end() - 1)), log.data());
  }
  return shader;
}

void set_filter(GLuint texture, bool linear, bool mipmapped) {
  const GLenum within = linear ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(within));
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER,
                      static_cast<GLint>(mipmapped ? GL_LINEAR_MIPMAP_LINEAR : within));
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTextureParameteri(texture, axis, GL_CLAMP_TO_EDGE);
}

}  // namespace

void destroy_gl_buffer(GLuint id) {
  glDeleteBuffers(1, &id);
}
void destroy_gl_vertex_array(GLuint id) {
  glDeleteVertexArrays(1, &id);
}
void destroy_gl_texture(GLuint id) {
  glDeleteTextures(1, &id);
}
void destroy_gl_sampler(GLuint id) {
  glDeleteSamplers(1, &id);
}
void destroy_gl_framebuffer(GLuint id) {
  glDeleteFramebuffers(1, &id);
}
void destroy_gl_program(GLuint id) {
  glDeleteProgram(id);
}

GlBuffer make_static_buffer(std::span<const std::byte> content) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  GlBuffer buffer(id);
  // OpenGL knows no empty storage; an empty mesh gets one unused byte.
  if (content.empty())
    glNamedBufferStorage(id, 1, nullptr, 0);
  else
    glNamedBufferStorage(id, static_cast<GLsizeiptr>(content.size()), content.data(), 0);
  return buffer;
}

GlBuffer make_dynamic_buffer(std::size_t bytes) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  GlBuffer buffer(id);
  glNamedBufferData(id, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_DRAW);
  return buffer;
}

void update_buffer(const GlBuffer& buffer, std::span<const std::byte> content) {
  glNamedBufferData(buffer.id(), static_cast<GLsizeiptr>(content.size()), content.data(), GL_STREAM_DRAW);
}

GlVertexArray make_vertex_array(const GlBuffer& indices) {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  GlVertexArray array(id);
  if (indices) glVertexArrayElementBuffer(id, indices.id());
  return array;
}

void bind_attributes(const GlVertexArray& array, GLuint binding, const GlBuffer& buffer, GLsizei stride,
                     std::initializer_list<GlAttribute> attributes) {
  glVertexArrayVertexBuffer(array.id(), binding, buffer.id(), 0, stride);
  for (const GlAttribute& attribute : attributes) {
    glEnableVertexArrayAttrib(array.id(), attribute.location);
    glVertexArrayAttribFormat(array.id(), attribute.location, attribute.components, GL_FLOAT, GL_FALSE,
                              attribute.offset);
    glVertexArrayAttribBinding(array.id(), attribute.location, binding);
  }
}

GlTexture make_texture_2d(GLenum format, int width, int height, int levels, bool linear) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  GlTexture texture(id);
  glTextureStorage2D(id, levels, format, width, height);
  set_filter(id, linear, levels > 1);
  return texture;
}

GlTexture make_texture_multisample(GLenum format, int width, int height, int samples) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D_MULTISAMPLE, 1, &id);
  GlTexture texture(id);
  glTextureStorage2DMultisample(id, samples, format, width, height, GL_TRUE);
  return texture;
}

int available_multisamples(int wanted) {
  GLint color = 1, depth = 1;
  glGetIntegerv(GL_MAX_COLOR_TEXTURE_SAMPLES, &color);
  glGetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &depth);
  int samples = 1;
  while (2 * samples <= std::min({wanted, color, depth})) samples *= 2;
  return samples;
}

GlTexture make_texture_cube(GLenum format, int size, bool linear) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_CUBE_MAP, 1, &id);
  GlTexture texture(id);
  glTextureStorage2D(id, 1, format, size, size);
  set_filter(id, linear, false);
  return texture;
}

GlFramebuffer make_framebuffer(std::initializer_list<const GlTexture*> colors, const GlTexture* depth) {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  GlFramebuffer framebuffer(id);
  std::vector<GLenum> draw_buffers;
  for (const GlTexture* color : colors) {
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(draw_buffers.size());
    glNamedFramebufferTexture(id, attachment, color->id(), 0);
    draw_buffers.push_back(attachment);
  }
  if (depth) glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth->id(), 0);
  glNamedFramebufferDrawBuffers(id, static_cast<GLsizei>(draw_buffers.size()), draw_buffers.data());
  const GLenum status = glCheckNamedFramebufferStatus(id, GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw Error({}, "OpenGL", "the driver refuses a framebuffer (status " + std::to_string(status) + ")",
                "the picture may be too large for the graphics memory");
  return framebuffer;
}

GlProgram make_program(std::initializer_list<std::string_view> vertex_files,
                       std::initializer_list<std::string_view> fragment_files,
                       std::span<const std::string> defines) {
  const GlShader vertex = compile(GL_VERTEX_SHADER, vertex_files, defines);
  const GlShader fragment = compile(GL_FRAGMENT_SHADER, fragment_files, defines);
  GlProgram program(glCreateProgram());
  glAttachShader(program.id(), vertex.id());
  glAttachShader(program.id(), fragment.id());
  glLinkProgram(program.id());
  GLint linked = 0;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  if (!linked) {
    std::array<char, 4096> log{};
    glGetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw Error({}, "shader " + std::string(*(fragment_files.end() - 1)), log.data());
  }
  return program;
}

}  // namespace catoptra::render

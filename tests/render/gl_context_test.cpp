// The OpenGL context: which ways are tried, and what is said where none works.
#include "render/src/gl_context.h"

#include <gtest/gtest.h>

#include <array>

#include "cad_import/error.h"
#include "render/src/gl_objects.h"

namespace catoptra::render {
namespace {

TEST(GlContext, IsMadeWithoutDisplay) {
  const auto context = GlContext::create();
  EXPECT_FALSE(context->renderer_name().empty());
  const GlScope scope(*context);
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  EXPECT_GE(10 * major + minor, 45);
}

TEST(GlContext, FailureNamesEveryAttemptAndItsReason) {
  const auto failing = [](const char* reason) -> std::unique_ptr<GlContext> {
    throw Error({}, "OpenGL", reason);
  };
  const std::array<GlContext::Factory, 2> factories{
      GlContext::Factory{"first way", [&] { return failing("no driver"); }},
      GlContext::Factory{"second way", [&] { return failing("no device"); }}};
  try {
    (void)GlContext::first_of(factories);
    FAIL() << "a context out of nothing";
  } catch (const Error& error) {
    const std::string text = error.what();
    for (const char* part :
         {"OpenGL 4.5", "first way: no driver", "second way: no device", "apt-get install"})
      EXPECT_NE(text.find(part), std::string::npos) << part << " is missing in: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
  }
}

TEST(GlContext, TakesTheNextWayWhereOneFails) {
  const std::array<GlContext::Factory, 2> factories{
      GlContext::Factory{"broken",
                         []() -> std::unique_ptr<GlContext> { throw Error({}, "OpenGL", "broken"); }},
      GlContext::Factory{"any", &GlContext::create}};
  EXPECT_TRUE(GlContext::first_of(factories));
}

TEST(GlContext, WrongCallBecomesAnError) {
  const auto context = GlContext::create();
  const GlScope scope(*context);
  EXPECT_NO_THROW(context->throw_if_errors());
  glBindTextureUnit(0, 12345);  // no such texture
  EXPECT_THROW(context->throw_if_errors(), Error);
  EXPECT_NO_THROW(context->throw_if_errors()) << "an error is told once";
}

TEST(GlContext, BrokenShaderIsAnErrorWithItsName) {
  const auto context = GlContext::create();
  const GlScope scope(*context);
  try {
    // The fragment shader alone lacks the declarations of raster_view.glsl.
    (void)make_program({"raster_accumulate.vert.glsl"}, {"raster_surface.frag.glsl"});
    FAIL() << "it compiled";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("raster_surface.frag.glsl"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace catoptra::render

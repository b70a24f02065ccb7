// Lenses in pictures: magnification, inversion, white, and what `compare` says of them, in every mode.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "render/image_io.h"
#include "tests/app/command_runner.h"
#include "tests/app/lens_scene_files.h"
#include "tests/app/test_scene.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

const char* const kModes[] = {"pvrr", "hybrid", "raytrace", "cubemap"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// The lens of write_test_lens() as it lies in its file, the eye on its axis `eye_mm` behind its back vertex.
std::string lens_scene(const cad_import::LensBlankReport& lens, double eye_mm, double fov_deg,
                       const std::string& resolution, const std::string& more) {
  return "[camera]\neye = [0, 0, " + number(-lens.center_thickness_mm - eye_mm) +
         "]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov_deg = " + number(fov_deg) +
         "\nresolution = " + resolution +
         "\n[environment]\ncolor = [1, 1, 1]\nambient = 0.8\n[[lens]]\nfile = \"lens.step\"\n" + more;
}

render::Frame picture(const TemporaryFolder& folder, const std::filesystem::path& scene, const char* mode) {
  const auto file = folder / (std::string(mode) + ".png");
  const CommandResult result = run_catoptra({"render", scene.string(), "-o", file.string(), "--mode", mode});
  EXPECT_EQ(result.code, 0) << mode << ": " << result.errors;
  return render::read_image(file);
}

glm::vec4 pixel(const render::Frame& frame, int x, int y) {
  return frame.color.at(std::size_t(y) * std::size_t(frame.width) + std::size_t(x));
}

/// A red band in a green wall 1 km away, so that the object may count as far: the band's edges are seen
/// `half_angle_deg` left and right of straight ahead where there is no lens.
constexpr double kFar_mm = 1e6;
void write_far_band(const TemporaryFolder& folder, double half_angle_deg) {
  const double x = kFar_mm * std::tan(glm::radians(half_angle_deg));
  int first = 1;
  const auto quad = [&first](double left, double right) {
    std::ostringstream text;
    for (const auto& [corner_x, corner_y] : {std::pair{left, -2e5}, {right, -2e5}, {right, 2e5}, {left, 2e5}})
      text << "v " << number(corner_x) << ' ' << corner_y << ' ' << kFar_mm << '\n';
    text << "f " << first << ' ' << first + 3 << ' ' << first + 2 << "\nf " << first << ' ' << first + 2
         << ' ' << first + 1 << '\n';
    first += 4;
    return text.str();
  };
  const std::string red = quad(-x, x), left = quad(-2e5, -x), right = quad(x, 2e5);
  folder.write("band.mtl", "newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n");
  folder.write("band.obj", "mtllib band.mtl\nusemtl red\n" + red + "usemtl green\n" + left + right);
}

/// Width of what is red in the middle row, px, its edges to a fraction of a pixel.
double red_width(const render::Frame& frame) {
  double width = 0;
  for (int x = 0; x < frame.width; ++x) {
    const glm::vec4 color = pixel(frame, x, frame.height / 2);
    width += double(color.r) / double(color.r + color.g);
  }
  return width;
}

/// Spectacle magnification 1 / ((1 - (t / n) F1) (1 - h F'v)), t and h in metres. Source: Jalie, Ophthalmic
/// Lenses and Dispensing, 3rd ed.
double spectacle_magnification(const cad_import::LensBlankReport& lens, double sphere_d, double eye_mm) {
  return 1 /
         ((1 - lens.center_thickness_mm / 1000 / 1.5 * lens.front_curve_d) * (1 - eye_mm / 1000 * sphere_d));
}

TEST(LensPicture, SpectacleMagnificationOfPlusAndMinusFour) {
  constexpr double kHalfAngle_deg = 1.5, kFov_deg = 0.45;  // paraxial: rays pass within 3 mm of the axis
  for (const auto& [sphere_d, eye_mm] : {std::pair{4.0, 70.0}, {-4.0, 60.0}}) {
    const TemporaryFolder folder;
    const auto lens = write_test_lens(folder, sphere_d);
    write_far_band(folder, kHalfAngle_deg);
    const auto scene =
        folder.write("scene.toml", lens_scene(lens, eye_mm, kFov_deg, "[800, 60]",
                                              "material = { rgb = [1.5, 1.5, 1.5] }\nwavelengths = 1\n"
                                              "[[surrounding]]\nfile = \"band.obj\"\n"));
    const double focal_px = 30 / std::tan(glm::radians(kFov_deg) / 2);
    const double direct_px = 2 * focal_px * std::tan(glm::radians(kHalfAngle_deg));
    const double expected = spectacle_magnification(lens, sphere_d, eye_mm);
    EXPECT_EQ(expected > 1, sphere_d > 0);
    // Not cubemap, whose texels of 0.1 degrees are 4 % of the band.
    for (const char* mode : {"pvrr", "hybrid", "raytrace"})
      EXPECT_NEAR(red_width(picture(folder, scene, mode)) / direct_px / expected, 1, 0.01)
          << mode << ", " << sphere_d << " D";
  }
}

/// Looking along +z with y up, +x is on the left: the wall's red half (x < 0) is on the right. A convex lens
/// far from the eye exchanges the halves, near the eye it does not.
TEST(LensPicture, FarConvexLensInverts) {
  for (const double eye_mm : {70.0, 760.0}) {
    const TemporaryFolder folder;
    const auto lens = write_test_lens(folder, 4);
    write_test_wall(folder);
    const auto scene = folder.write(
        "scene.toml", lens_scene(lens, eye_mm, eye_mm > 100 ? 8 : 60, "[96, 64]",
                                 "material = \"CR-39\"\n[[surrounding]]\nfile = \"wall.obj\"\n"));
    for (const char* mode : kModes) {
      if (std::string(mode) == "cubemap") continue;  // knows directions only: near objects stay upright
      const render::Frame frame = picture(folder, scene, mode);
      const glm::vec4 inside = pixel(frame, 55, 32), beside = pixel(frame, 90, 32);
      EXPECT_GT(beside.r, beside.g) << mode;
      EXPECT_EQ(inside.r > inside.g, eye_mm < 100) << mode << ", eye at " << eye_mm << " mm";
    }
  }
}

TEST(LensPicture, WhiteStaysWhiteWithAnyNumberOfWavelengths) {
  const TemporaryFolder folder;
  const auto lens = write_test_lens(folder, -4);
  for (const char* wavelengths : {"1", "3", "\"spectral\""}) {
    const auto scene = folder.write(
        "scene.toml",
        lens_scene(lens, 60, 30, "[96, 64]",
                   "material = { rgb = [1.5, 1.5, 1.5] }\nwavelengths = " + std::string(wavelengths) + "\n"));
    for (const char* mode : {"pvrr", "raytrace"}) {
      const glm::vec4 color = pixel(picture(folder, scene, mode), 50, 34);
      EXPECT_NEAR(color.r / color.g, 1, 0.01) << mode << ", " << wavelengths;
      EXPECT_NEAR(color.b / color.g, 1, 0.01) << mode << ", " << wavelengths;
      // Two surfaces of index 1.5 near normal incidence pass 0.96 each (Fresnel); 8 bits of sRGB round by
      // 0.004.
      EXPECT_NEAR(color.g, 0.96 * 0.96, 0.006) << mode << ", " << wavelengths;
    }
  }
}

/// Turned edge-on, no ray gets through: a picture all the same.
TEST(LensPicture, EdgeOnIsAPicture) {
  const TemporaryFolder folder;
  const auto lens = write_test_lens(folder, -4);
  const auto scene = folder.write(
      "scene.toml", lens_scene(lens, 200, 30, "[96, 64]", "material = \"CR-39\"\nrotate_deg = [90, 0, 0]\n"));
  for (const char* mode : kModes) {
    const glm::vec4 corner = pixel(picture(folder, scene, mode), 1, 1);
    EXPECT_GT(corner.g, 0.99f) << mode;
  }
}

TEST(LensPicture, CompareReportsALens) {
  const TemporaryFolder folder;
  const auto lens = write_test_lens(folder, -4);
  write_test_wall(folder);
  const auto scene = folder.write(
      "scene.toml",
      lens_scene(lens, 60, 50, "[192, 128]", "material = \"CR-39\"\n[[surrounding]]\nfile = \"wall.obj\"\n"));
  const CommandResult result =
      run_catoptra({"compare", scene.string(), "-o", (folder / "out").string(), "--frames", "1"});
  ASSERT_EQ(result.code, 0) << result.errors;
  const json report = json::parse(read_file(folder / "out" / "report.json"));
  for (const char* mode : {"pvrr", "hybrid"}) {
    const json& entry = report.at("modes").at(mode).at("optics").at(0);
    EXPECT_EQ(entry.at("kind"), "lens");
    EXPECT_GT(entry.at("pixels").get<int>(), 1000);
  }
  const auto& modes = report.at("modes");
  EXPECT_LT(modes.at("pvrr").at("optics").at(0).at("error_px").at("median").get<double>(), 1);
  EXPECT_LT(modes.at("hybrid").at("optics").at(0).at("error_px").at("p99").get<double>(), 0.1);
}

}  // namespace
}  // namespace catoptra::test

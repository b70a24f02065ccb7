// Lenses that are none, or that show nothing: each is a clear error with file, line and key, or a clear
// picture with a warning.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/scene_file.h"
#include "cad_import/error.h"
#include "cad_import/mirror_blank.h"
#include "render/image_io.h"
#include "tests/app/command_runner.h"
#include "tests/app/lens_scene_files.h"
#include "tests/app/test_scene.h"
#include "tests/support/bad_lenses.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

/// Files of good and of bad lenses, made once.
class BadLens : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const TemporaryFolder& folder = *folder_;
    write_test_lens(folder, -4);
    write_test_mirror(folder, 400);
    const Cap front{80, 0}, back{60, -3};
    write_caps({front, back}, folder / "loose.brep");
    write_solid(front, back, folder / "solid.brep");
    write_solid({50, 0}, {-50, 2 * Cap{50, 0}.rim_mm()}, folder / "knife_edge.brep");
    write_caps({front}, folder / "front.brep");
    write_caps({back}, folder / "back.brep");
    write_caps({{30, 0}, {-100, -2}}, folder / "crossing.brep");
    write_solid({30, 0}, {-100, -2}, folder / "crossing_solid.brep");
    write_caps({front, front}, folder / "no_thickness.brep");
    write_caps({back, front}, folder / "exchanged.brep");
    write_cube(20, folder / "cube.brep");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  /// A scene of one lens: [[lens]] in line 1, `keys` from line 2 on, the material last.
  static std::string scene(const std::string& keys) { return "[[lens]]\n" + keys + "material = \"CR-39\"\n"; }
  static app::SceneFile read(const std::string& keys) {
    return app::read_scene_text(scene(keys), "bad.toml", folder_->path());
  }
  static void expect_refused(const std::string& keys, const std::string& entity, const std::string& reason,
                             const std::string& remedy) {
    try {
      (void)read(keys);
      ADD_FAILURE() << keys << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), "bad.toml") << error.what();
      EXPECT_EQ(error.entity(), entity) << error.what();
      EXPECT_NE(error.reason().find(reason), std::string::npos) << error.what();
      EXPECT_NE(error.hint().find(remedy), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  static bool warns(const app::SceneFile& file, const std::string& part) {
    const auto& warnings = file.scene.warnings;
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string& text) { return text.find(part) != std::string::npos; });
  }

  static inline TemporaryFolder* folder_ = nullptr;
};

TEST_F(BadLens, TheGoodOnesAreAccepted) {
  for (const char* keys :
       {"file = \"lens.step\"\n", "file = \"solid.brep\"\n", "file = \"knife_edge.brep\"\n",
        "file = \"loose.brep\"\nfront_faces = [0]\nback_faces = [1]\n",
        "front = \"front.brep\"\nback = \"back.brep\"\n"})
    EXPECT_TRUE(read(keys).scene.warnings.empty()) << keys << read(keys).scene.warnings.at(0);
}

TEST_F(BadLens, OpenShell) {
  expect_refused("file = \"loose.brep\"\n", "line 2, lens.file", "open shell",
                 "name the faces of both sides");
}

TEST_F(BadLens, OneSurfaceOnly) {
  expect_refused("file = \"front.brep\"\n", "line 2, lens.file", "open shell", "name the faces");
  expect_refused("file = \"front.brep\"\nfront_faces = [0]\n", "line 3, lens.front_faces", "only one surface",
                 "name both sides");
  expect_refused("front = \"front.brep\"\n", "line 1, lens.back", "required", "two surfaces");
  expect_refused("file = \"front.brep\"\nfront_faces = [0]\nback_faces = [1]\n", "line 3, lens.front_faces",
                 "only 1 face", "catoptra info");
}

TEST_F(BadLens, FrontAndBackCross) {
  expect_refused("file = \"crossing.brep\"\nfront_faces = [0]\nback_faces = [1]\n",
                 "line 3, lens.front_faces", "cross", "thicker");
  expect_refused("file = \"crossing_solid.brep\"\n", "line 2, lens.file", "cross", "thicker");
}

TEST_F(BadLens, NoThickness) {
  expect_refused("file = \"no_thickness.brep\"\nfront_faces = [0]\nback_faces = [1]\n",
                 "line 3, lens.front_faces", "coincide", "two different surfaces");
  expect_refused("front = \"front.brep\"\nback = \"front.brep\"\n", "line 3, lens.back", "coincide",
                 "two different surfaces");
}

/// A front behind its back is the same glass entered from the other side: the picture is right, and says so.
TEST_F(BadLens, SidesTheWrongWayRound) {
  for (const char* keys : {"file = \"exchanged.brep\"\nfront_faces = [0]\nback_faces = [1]\n",
                           "front = \"back.brep\"\nback = \"front.brep\"\n"})
    EXPECT_TRUE(warns(read(keys), "exchanged: the front is concave and the back convex")) << keys;
  EXPECT_TRUE(warns(read("file = \"lens.step\"\nfront_faces = [\"back\"]\nback_faces = [\"front\"]\n"),
                    "exchanged: the front is called 'back'"));
}

TEST_F(BadLens, OneFaceForBothSides) {
  expect_refused("file = \"lens.step\"\nfront_faces = [0]\nback_faces = [0]\n", "line 3, lens.front_faces",
                 "on the front and on the back", "different faces");
}

TEST_F(BadLens, NotALens) {
  expect_refused("file = \"cube.brep\"\n", "line 2, lens.file", "no two curved sides face away",
                 "name the faces of both sides");
  expect_refused("file = \"cube.brep\"\nfront_faces = [0]\nback_faces = [2]\n", "line 3, lens.front_faces",
                 "do not lie behind one another", "name the faces of both sides");
  expect_refused("file = \"lens.step\"\nfront_faces = [\"rim\"]\n", "line 3, lens.front_faces",
                 "only one surface along its axis", "name both sides");
}

TEST_F(BadLens, MirrorGlass) {
  expect_refused("file = \"mirror.step\"\n", "line 2, lens.file", "is a mirror glass", "[[mirror]]");
  EXPECT_NO_THROW((void)read("file = \"mirror.step\"\nfront_faces = [\"Glass\"]\nback_faces = [\"Back\"]\n"));
}

TEST_F(BadLens, Wavelengths) {
  for (const char* count : {"0", "-3", "1001", "1000000000000"})
    expect_refused("file = \"lens.step\"\nwavelengths = " + std::string(count) + "\n",
                   "line 3, lens.wavelengths", "out of range", "");
  expect_refused("file = \"lens.step\"\nwavelengths = \"many\"\n", "line 3, lens.wavelengths", "'many'",
                 "spectral");
}

/// Renders with the eye at the origin, looking along +z; returns the standard error.
struct Drawn {
  CommandResult result;
  json report;
};
Drawn draw(const TemporaryFolder& folder, const std::string& keys, const char* mode) {
  const auto scene =
      folder.write("scene.toml",
                   "[camera]\neye = [0, 0, 0]\ntarget = [0, 0, 1]\nup = [0, 1, 0]\nfov_deg = 30\n"
                   "resolution = [48, 32]\n[environment]\ncolor = [1, 1, 1]\n" +
                       keys);
  const auto picture = folder / "picture.png", report = folder / "report.json";
  std::filesystem::remove(picture);
  Drawn drawn{run_catoptra({"render", scene.string(), "-o", picture.string(), "--mode", mode, "--report",
                            report.string()}),
              {}};
  if (drawn.result.code == 0) {
    drawn.report = json::parse(read_file(report));
    // White beside the optic, and through it all but what two surfaces of CR-39 reflect, 0.04 each.
    EXPECT_GT(render::read_image(picture).color[0].g, 0.9f);
  } else {
    EXPECT_FALSE(std::filesystem::exists(picture));
  }
  return drawn;
}

void expect_warning(const Drawn& drawn, const std::string& part) {
  EXPECT_EQ(drawn.result.code, 0) << drawn.result.errors;
  EXPECT_NE(drawn.result.errors.find("catoptra: warning: "), std::string::npos) << drawn.result.errors;
  EXPECT_NE(drawn.result.errors.find(part), std::string::npos) << drawn.result.errors;
  ASSERT_EQ(drawn.report.at("warnings").size(), 1u) << drawn.report.at("warnings");
  EXPECT_NE(drawn.report.at("warnings").at(0).get<std::string>().find(part), std::string::npos);
}

/// Biconcave, so that from its edge neither side is seen.
void write_biconcave(const TemporaryFolder& folder) {
  write_solid({-100, 0}, {100, -2}, folder / "biconcave.brep");
}

TEST(BadLensView, NoRayPassesFromTheEdge) {
  const TemporaryFolder folder;
  write_biconcave(folder);
  const std::string keys =
      "[[lens]]\nname = \"right\"\nfile = \"biconcave.brep\"\nmaterial = \"CR-39\"\ntranslate = [0, 0, "
      "150]\n";
  for (const char* mode : {"pvrr", "hybrid", "raytrace", "cubemap"}) {
    expect_warning(draw(folder, keys + "rotate_deg = [90, 0, 0]\n", mode),
                   "lens 'right': no ray from the eye passes");
    EXPECT_EQ(draw(folder, keys, mode).result.errors, "") << "facing the eye there is nothing to warn of";
  }
}

TEST(BadLensView, OutsideThePicture) {
  const TemporaryFolder folder;
  write_biconcave(folder);
  write_test_mirror(folder, 400);
  for (const char* place : {"[0, 0, -150]", "[0, 900, 150]"}) {
    const std::string at = "translate = " + std::string(place) + "\n";
    expect_warning(
        draw(folder, "[[lens]]\nfile = \"biconcave.brep\"\nmaterial = \"CR-39\"\n" + at, "raytrace"),
        "lens 'biconcave' lies outside the picture");
    expect_warning(draw(folder, "[[mirror]]\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\n" + at, "raytrace"),
                   "mirror 'mirror' lies outside the picture");
  }
}

TEST(BadLensView, MirrorFromItsBack) {
  const TemporaryFolder folder;
  write_test_mirror(folder, 400);
  const std::string keys =
      "[[mirror]]\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\ntranslate = [0, 0, 300]\n";
  expect_warning(draw(folder, keys, "raytrace"), "turns its back to the eye");
  EXPECT_EQ(draw(folder, keys + "rotate_deg = [0, 180, 0]\n", "raytrace").result.errors, "");
}

/// A square of 120 mm across the view, `x_mm` to the side. Its front looks away from the eye.
std::string square(const char* kind, double z_mm, double x_mm = 0) {
  const auto corner = [&](double x, double y) {
    return "[" + std::to_string(x_mm + x) + ", " + std::to_string(y) + ", " + std::to_string(z_mm) + "]";
  };
  return "[[planar]]\nkind = \"" + std::string(kind) + "\"\ncorners = [" + corner(-60, -60) + ", " +
         corner(60, -60) + ", " + corner(60, 60) + ", " + corner(-60, 60) + "]\n";
}

TEST(BadLensView, PlanarOpticFromItsBack) {
  const TemporaryFolder folder;
  for (const char* kind : {"mirror", "refractor", "pane"}) {
    const std::string keys = square(kind, 300);
    EXPECT_EQ(draw(folder, keys, "raytrace").result.errors, "") << kind << " works from both sides";
    const Drawn drawn = draw(folder, keys + "one_sided = true\n", "raytrace");
    expect_warning(drawn, std::string(kind) + " 'planar' turns its back to the eye");
    EXPECT_NE(drawn.result.errors.find("one_sided = false"), std::string::npos) << drawn.result.errors;
    EXPECT_EQ(drawn.result.errors.find("rotate_deg"), std::string::npos) << "[[planar]] has no such key here";
  }
}

/// Behind the eye, a mirror shows in one before the eye: at depth 1 it does not.
TEST(BadLensView, SeenInAnotherOpticOnly) {
  const TemporaryFolder folder;
  const std::string behind = square("mirror", -100), before = square("mirror", 300);
  const auto depth = [](int n) { return "[render]\ndepth = " + std::to_string(n) + "\n"; };
  EXPECT_EQ(draw(folder, before + behind + depth(2), "raytrace").result.errors, "");
  expect_warning(draw(folder, before + behind + depth(1), "raytrace"), "lies outside the picture");
  // A mirror that shows one side shows nothing that lies behind it.
  write_test_mirror(folder, 400);
  const std::string convex =
      "[[mirror]]\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\nrotate_deg = [0, 180, 0]\ntranslate = [0, 0, "
      "300]\n";
  EXPECT_EQ(draw(folder, convex + behind, "raytrace").result.errors, "");
  expect_warning(draw(folder, convex + square("mirror", 1000, 1000), "raytrace"),
                 "mirror 'planar' lies outside the picture");
}

TEST(BadLensView, LensAroundTheEye) {
  const TemporaryFolder folder;
  write_biconcave(folder);
  const std::string keys = "[[lens]]\nname = \"right\"\nfile = \"biconcave.brep\"\nmaterial = \"CR-39\"\n";
  for (const char* mode : {"pvrr", "raytrace"}) {
    const Drawn inside = draw(folder, keys + "translate = [0, 0, 1]\n", mode);
    EXPECT_EQ(inside.result.code, 1);
    EXPECT_EQ(inside.result.errors,
              "catoptra: " + (folder / "scene.toml").string() +
                  ": lens 'right': the eye lies inside the glass (move camera.eye out of "
                  "it, or the lens by translate)\n");
    // Within the hollow of the back, 1 mm before its vertex, the eye is in the open.
    EXPECT_EQ(draw(folder, keys + "translate = [0, 0, 3]\n", mode).result.code, 0);
  }
}

/// What compare says of nothing.
TEST(BadLensView, CompareOfAnOpticThatDoesNotShow) {
  const TemporaryFolder folder;
  write_biconcave(folder);
  const std::string scene =
      folder
          .write("scene.toml",
                 "[camera]\neye = [0, 0, 0]\ntarget = [0, 0, 1]\nup = [0, 1, 0]\nresolution = [48, 32]\n"
                 "[[lens]]\nfile = \"biconcave.brep\"\nmaterial = \"CR-39\"\ntranslate = [0, 0, -150]\n")
          .string();
  const std::vector<std::string> arguments{"compare", scene,    "-o",       (folder / "out").string(),
                                           "--modes", "hybrid", "--frames", "1"};
  const CommandResult result = run_catoptra(arguments);
  EXPECT_EQ(result.code, 0) << result.errors;
  EXPECT_NE(result.errors.find("optic 'biconcave' shows in no pixel"), std::string::npos) << result.errors;
  const json report = json::parse(read_file(folder / "out" / "report.json"));
  EXPECT_EQ(report.at("warnings").size(), 2u) << report.at("warnings");
}

}  // namespace
}  // namespace catoptra::test

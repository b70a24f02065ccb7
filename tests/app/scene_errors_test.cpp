// Every slip in a scene file is an error that names file, line and key.
#include <gtest/gtest.h>

#include "app/scene_file.h"
#include "cad_import/error.h"
#include "tests/app/test_scene.h"

namespace catoptra::app {
namespace {

struct BadScene {
  const char* name;
  const char* text;
  const char* entity;  ///< exactly
  const char* reason;  ///< part of the line
};

void PrintTo(const BadScene& bad, std::ostream* stream) {
  *stream << bad.name;
}

class BadSceneFile : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneFile, NamesFileLineAndKey) {
  const test::TemporaryFolder folder;
  test::write_test_mirror(folder, 400);
  test::write_test_wall(folder);
  try {
    (void)read_scene_text(GetParam().text, "bad.toml", folder.path());
    FAIL() << "the scene was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), "bad.toml");
    EXPECT_EQ(error.entity(), GetParam().entity) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().reason), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

constexpr BadScene kBadScenes[] = {
    {"Syntax", "[camera\n", "line 1", "not valid TOML"},
    {"UnknownTable", "[[mirorr]]\n", "line 1, mirorr", "did you mean 'mirror'?"},
    {"UnknownKey", "[camera]\neye = [0, -1, 0]\nfov = 40\n", "line 3, camera.fov", "unknown key"},
    {"UnknownKeySuggests", "[[surrounding]]\nfile = \"wall.obj\"\ntranslat = [0, 0, 0]\n",
     "line 3, surrounding.translat", "did you mean 'translate'?"},
    {"TableForArray", "[mirror]\nfile = \"mirror.step\"\n", "line 1, mirror", "[[mirror]]"},
    {"ArrayForTable", "[[camera]]\n", "line 1, camera", "[camera]"},
    {"WrongType", "[camera]\n\neye = \"here\"\n", "line 3, camera.eye",
     "expected an array of 3 numbers, found a string"},
    {"WrongCount", "[camera]\neye = [0, 1]\n", "line 2, camera.eye", "found 2"},
    {"NotANumber", "[camera]\nfov_deg = nan\n", "line 2, camera.fov_deg", "finite"},
    {"OutOfRange", "[camera]\nfov_deg = 180\n", "line 2, camera.fov_deg", "at most 170"},
    {"FractionOfPixel", "[camera]\nresolution = [640.5, 480]\n", "line 2, camera.resolution", "integers"},
    {"EyeOnTarget", "[camera]\neye = [1, 2, 3]\ntarget = [1, 2, 3]\n", "line 3, camera.target", "same point"},
    {"UpAlongView", "[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\nup = [0, 0, 1]\n", "line 4, camera.up",
     "parallel"},
    {"Units", "units = \"parsec\"\n", "line 1, units", "unknown unit"},
    {"ColorAndSky", "[environment]\ncolor = [1, 1, 1]\nsky = \"wall.obj\"\n", "line 2, environment.color",
     "exclude"},
    {"MissingSky", "[environment]\nsky = \"no.hdr\"\n", "line 2, environment.sky", "no file"},
    {"LightKind", "[[light]]\nkind = \"directionl\"\n", "line 2, light.kind", "did you mean 'directional'?"},
    {"PointLightWithoutPosition", "[[light]]\nkind = \"point\"\n", "line 1, light.position", "required"},
    {"SecondLight", "[[light]]\n[[light]]\nintensity = -1\n", "line 3, light.intensity", "at least 0"},
    {"MissingFileKey", "\n[[surrounding]]\ncolor = [1, 1, 1]\n", "line 2, surrounding.file", "required"},
    {"MissingFile", "[[surrounding]]\nfile = \"no.obj\"\n", "line 2, surrounding.file", "no.obj"},
    {"FolderForFile", "[[surrounding]]\nfile = \".\"\n", "line 2, surrounding.file", "folder"},
    {"ZeroScale", "[[surrounding]]\nfile = \"wall.obj\"\nscale = 0\n", "line 3, surrounding.scale",
     "greater than 0"},
    {"FileUnit", "[[surrounding]]\nfile = \"wall.obj\"\nunit = \"mn\"\n", "line 3, surrounding.unit",
     "unknown unit"},
    {"MirrorFromMesh", "[[mirror]]\nfile = \"wall.obj\"\n", "line 2, mirror.file", "exact surfaces"},
    {"FaceName", "[[mirror]]\nfile = \"mirror.step\"\nfaces = [\"Glas\"]\n", "line 3, mirror.faces",
     "did you mean 'Glass'?"},
    {"FaceIndex", "[[mirror]]\nfile = \"mirror.step\"\nfaces = [99]\n", "line 3, mirror.faces",
     "faces, numbered from 0"},
    {"FaceType", "[[mirror]]\nfile = \"mirror.step\"\nfaces = [1.5]\n", "line 3, mirror.faces", "indices"},
    {"Coating", "[[mirror]]\nfile = \"mirror.step\"\nreflectance = \"aluminum\"\n",
     "line 3, mirror.reflectance", "did you mean 'aluminium'?"},
    {"Reflectance", "[[mirror]]\nfile = \"mirror.step\"\nreflectance = 1.2\n", "line 3, mirror.reflectance",
     "at most 1"},
    {"GridAndVertices",
     "[[mirror]]\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\nvertices = 49\ngrid = [7, 7]\n",
     "line 5, mirror.grid", "exclude"},
    {"SameName",
     "[[mirror]]\nname = \"a\"\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\n"
     "[[mirror]]\nname = \"a\"\nfile = \"mirror.step\"\nfaces = [\"Back\"]\n",
     "line 6, mirror.name", "two optics"},
    {"FaceTwice",
     "[[mirror]]\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\n[[mirror]]\nfile = \"mirror.step\"\nfaces = "
     "[\"Glass\"]\n",
     "line 6, mirror.faces", "already belongs"},
    {"RenderMode", "[render]\nmode = \"pvr\"\n", "line 2, render.mode", "did you mean 'pvrr'?"},
    {"RenderDepth", "[render]\ndepth = 2.5\n", "line 2, render.depth", "expected an integer"},
    {"PlanarWithoutKind", "[[planar]]\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n", "line 1, planar.kind",
     "required"},
    {"PlanarKind", "[[planar]]\nkind = \"miror\"\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 2, planar.kind", "did you mean 'mirror'?"},
    {"PlanarWithoutOutline", "[[planar]]\nkind = \"pane\"\n", "line 1, planar", "needs corners or file"},
    {"PlanarTwoOutlines",
     "[[planar]]\nkind = \"pane\"\nfile = \"mirror.step\"\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 4, planar.corners", "excludes file"},
    {"PlanarTwoCorners", "[[planar]]\nkind = \"pane\"\ncorners = [[0, 0, 0], [1, 0, 0]]\n",
     "line 3, planar.corners", "at least three"},
    {"PlanarOnALine", "[[planar]]\nkind = \"pane\"\ncorners = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]\n",
     "line 3, planar.corners", "one line"},
    {"PlanarBent", "[[planar]]\nkind = \"pane\"\ncorners = [[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]]\n",
     "line 3, planar.corners", "plane of the others"},
    {"PlanarCrossing",
     "[[planar]]\nkind = \"pane\"\ncorners = [[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 1, 0]]\n",
     "line 3, planar.corners", "crosses itself"},
    {"PlanarCurvedFace", "[[planar]]\nkind = \"mirror\"\nfile = \"mirror.step\"\nfaces = [\"Glass\"]\n",
     "line 4, planar.faces", "is not planar"},
    {"PlanarIor",
     "[[planar]]\nkind = \"refractor\"\nior = 0.9\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 3, planar.ior", "at least 1"},
    {"PlanarThickness",
     "[[planar]]\nkind = \"pane\"\nthickness = -1\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 3, planar.thickness", "at least 0"},
    {"PlanarTint",
     "[[planar]]\nkind = \"pane\"\ntint = [1, 1, 2]\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 3, planar.tint", "at most 1"},
    {"PlanarFog",
     "[[planar]]\nkind = \"pane\"\ntranslucency = 1.5\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 3, planar.translucency", "at most 1"},
    {"PlanarAlpha",
     "[[planar]]\nkind = \"pane\"\nmaterial_alpha = -0.1\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 3, planar.material_alpha", "at least 0"},
    {"PlanarRoughness",
     "[[planar]]\nkind = \"mirror\"\nroughness_deg = [1]\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 3, planar.roughness_deg", "2 numbers"},
    {"PlanarUnknownKey",
     "[[planar]]\nkind = \"pane\"\nthicknes = 3\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 3, planar.thicknes", "did you mean 'thickness'?"},
    {"PlanarSameName",
     "[[planar]]\nname = \"a\"\nkind = \"pane\"\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, "
     "0]]\n[[planar]]\nname = \"a\"\nkind = \"pane\"\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "line 6, planar.name", "two optics"},
    {"PlanarCorner", "[[planar]]\nkind = \"mirror\"\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1]]\n",
     "line 3, planar.corners", "3 numbers"},
    {"PlanarCornersMoved",
     "[[planar]]\nkind = \"mirror\"\ncorners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\ntranslate = [0, 0, 1]\n",
     "line 4, planar.translate", "belongs to a file"},
};

INSTANTIATE_TEST_SUITE_P(Slips, BadSceneFile, testing::ValuesIn(kBadScenes),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(SceneFileOnDisk, MissingFileAndFolderAreErrors) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)read_scene(folder / "no.toml"), Error);
  EXPECT_THROW((void)read_scene(folder.path()), Error);
}

}  // namespace
}  // namespace catoptra::app

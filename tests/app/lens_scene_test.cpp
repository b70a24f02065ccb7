// [[lens]]: what the reader makes of it, and every slip told by file, line and key.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "app/scene_file.h"
#include "cad_import/error.h"
#include "optics/lens_path.h"
#include "tests/app/lens_scene_files.h"

namespace catoptra::app {
namespace {

using test::TemporaryFolder;

/// One round lens of +4 D, made once; scenes of it are read in its folder.
class LensScene : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    report_ = test::write_test_lens(*folder_, 4);
    folder_->write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder_->write("user.agf",
                   "NM MYGLASS 2 510000 1.51 60.0 0 0\nCD 1.2 0.01 0 0 0 0 0 0 0 0\nLD 0.35 2.0\n");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static SceneFile read(const std::string& keys) {
    return read_scene_text("[[lens]]\nfile = \"lens.step\"\n" + keys, "lens.toml", folder_->path());
  }
  static double index(const std::string& material, double nm) {
    return read("material = " + material + "\n").scene.optics.at(0).medium.index(nm);
  }

  static inline TemporaryFolder* folder_ = nullptr;
  static inline cad_import::LensBlankReport report_;
};

TEST_F(LensScene, SidesRimAndDefaults) {
  const SceneFile file = read("name = \"right\"\nmaterial = \"CR-39\"\n");
  const optics::Optic& lens = file.scene.optics.at(0);
  EXPECT_EQ(lens.name, "right");
  EXPECT_EQ(lens.kind, optics::OpticKind::lens);
  EXPECT_EQ(lens.wavelengths, 3);
  EXPECT_EQ(lens.around.index(optics::kLineD_nm), 1);
  for (const auto* mesh : {&lens.mesh, &lens.back.mesh}) {
    EXPECT_GE(mesh->vertices.size(), 500u);  // the paper's 500 to 1,000 rays a side
    EXPECT_LE(mesh->vertices.size(), 1000u);
  }
  for (const auto& face : lens.faces) EXPECT_EQ(face.name, "front");
  for (const auto& face : lens.back.faces) EXPECT_EQ(face.name, "back");
  for (const auto& vertex : lens.mesh.vertices) EXPECT_GT(vertex.normal.z, 0);
  for (const auto& vertex : lens.back.mesh.vertices) EXPECT_LT(vertex.normal.z, 0);
  ASSERT_EQ(file.scene.surroundings.size(), 1u);  // the rim
  EXPECT_FLOAT_EQ(file.scene.surroundings[0].materials.at(0).base_color.r, lens.rim_color.r);
}

TEST_F(LensScene, OverridesOfEveryKey) {
  const SceneFile file = read(
      "material = \"CR-39\"\nfront_faces = [\"back\"]\nback_faces = [\"front\"]\nwavelengths = \"spectral\"\n"
      "vertices = 200\ncolor = [0.2, 0.3, 0.4]\naround = { nd = 1.333, vd = 55 }\nscale = 2\n"
      "rotate_deg = [0, 90, 0]\ntranslate = [10, 0, 0]\n");
  const optics::Optic& lens = file.scene.optics.at(0);
  EXPECT_EQ(lens.name, "lens");
  EXPECT_EQ(lens.wavelengths, 16);
  EXPECT_NEAR(lens.around.index(optics::kLineD_nm), 1.333, 1e-9);
  EXPECT_LT(lens.mesh.vertices.size(), 300u);
  EXPECT_EQ(lens.faces.at(0).name, "back");
  EXPECT_EQ(lens.rim_color, glm::vec3(0.2f, 0.3f, 0.4f));
  // The front vertex goes from the origin to x = 10; z turns into x.
  double most = -1e9;
  for (const auto& vertex : lens.back.mesh.vertices) most = std::max(most, vertex.position_mm.x);
  EXPECT_NEAR(most, 10, 0.05);  // no vertex of the mesh need lie on the axis
}

/// Normals of loose surfaces may point either way: both sides end up with theirs out of the glass, so that
/// rays pass.
TEST_F(LensScene, TwoFilesMakeALens) {
  for (const bool exchanged : {false, true}) {
    const SceneFile file = read_scene_text(
        std::string("[[lens]]\nfront = \"lens.step\"\nback = \"lens.step\"\nfront_faces = [\"") +
            (exchanged ? "back" : "front") + "\"]\nback_faces = [\"" + (exchanged ? "front" : "back") +
            "\"]\nmaterial = { nd = 1.5, vd = 60 }\n",
        "lens.toml", folder_->path());
    const optics::Optic& lens = file.scene.optics.at(0);
    const optics::LensTracer tracer(lens);
    const auto path = tracer.trace({{1, 2, 100}, {0, 0, -1}}, optics::side_towards(lens, {0, 0, 100}),
                                   optics::lens_indices(lens, optics::kLineD_nm));
    EXPECT_EQ(path.end, optics::LensPathEnd::passed);
    EXPECT_NEAR(glm::distance(path.entry.position_mm, path.exit.position_mm), report_.center_thickness_mm,
                0.05);  // 2.2 mm off the axis, where the lens is thinner by 2.2^2/2 * 4 D / 500 = 0.02 mm
  }
}

TEST_F(LensScene, MaterialForms) {
  EXPECT_NEAR(index("\"CR-39\"", optics::kLineD_nm), 1.498, 1e-6);
  EXPECT_NEAR(index("\"cr39\"", optics::kLineD_nm), 1.498, 1e-6);
  EXPECT_NEAR(index("{ nd = 1.6, vd = 42 }", optics::kLineD_nm), 1.6, 1e-9);
  EXPECT_NEAR(0.6 / (index("{ nd = 1.6, vd = 42 }", optics::kLineF_nm) -
                     index("{ nd = 1.6, vd = 42 }", optics::kLineC_nm)),
              42, 1e-6);
  EXPECT_NEAR(index("{ rgb = [1.60, 1.61, 1.62] }", optics::kLineC_nm), 1.60, 1e-12);
  EXPECT_NEAR(index("{ rgb = [1.60, 1.61, 1.62] }", optics::kLineE_nm), 1.61, 1e-12);
  EXPECT_NEAR(index("{ rgb = [1.60, 1.61, 1.62] }", optics::kLineF_nm), 1.62, 1e-12);
  // n^2 = 1 + 1.2 L^2 / (L^2 - 0.01), Zemax formula 2.
  EXPECT_NEAR(index("\"MYGLASS\"\ncatalogue = \"user.agf\"", 1000), std::sqrt(1 + 1.2 / 0.99), 1e-9);
  // N-BK7: 1.51680 at d (data sheet, SCHOTT).
  EXPECT_NEAR(index("{ sellmeier = [1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, "
                    "103.560653] }",
                    optics::kLineD_nm),
              1.51680, 5e-6);
}

struct BadLens {
  const char* name;
  const char* text;
  const char* entity;  ///< exactly
  const char* reason;  ///< part of the line
};

void PrintTo(const BadLens& bad, std::ostream* stream) {
  *stream << bad.name;
}

class BadLensScene : public LensScene, public testing::WithParamInterface<BadLens> {};

TEST_P(BadLensScene, NamesFileLineAndKey) {
  try {
    (void)read_scene_text(GetParam().text, "bad.toml", folder_->path());
    FAIL() << "the scene was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), "bad.toml");
    EXPECT_EQ(error.entity(), GetParam().entity) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().reason), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

constexpr BadLens kBadLenses[] = {
    {"NoFile", "[[lens]]\nmaterial = \"CR-39\"\n", "line 1, lens.file", "required"},
    {"OneSurface", "[[lens]]\nfront = \"lens.step\"\nmaterial = \"CR-39\"\n", "line 1, lens.back",
     "two surfaces"},
    {"OtherSurface", "[[lens]]\nback = \"lens.step\"\nmaterial = \"CR-39\"\n", "line 1, lens.front",
     "two surfaces"},
    {"BothForms", "[[lens]]\nfile = \"lens.step\"\nfront = \"lens.step\"\nmaterial = \"CR-39\"\n",
     "line 2, lens.file", "excludes"},
    {"SolidForSurface", "[[lens]]\nfront = \"lens.step\"\nback = \"lens.step\"\nmaterial = \"CR-39\"\n",
     "line 2, lens.front", "is a solid"},
    {"Mesh", "[[lens]]\nfile = \"triangle.obj\"\nmaterial = \"CR-39\"\n", "line 2, lens.file",
     "exact surfaces"},
    {"NoMaterial", "[[lens]]\nfile = \"lens.step\"\n", "line 1, lens.material", "required"},
    {"UnknownMaterial", "[[lens]]\nfile = \"lens.step\"\nmaterial = \"CR-93\"\n", "line 3, lens.material",
     "CR-39"},
    {"IndexBelowOne", "[[lens]]\nfile = \"lens.step\"\nmaterial = { nd = 0.9, vd = 58 }\n",
     "line 3, lens.material.nd", "at least 1"},
    {"RgbBelowOne", "[[lens]]\nfile = \"lens.step\"\nmaterial = { rgb = [1.5, 0.5, 1.5] }\n",
     "line 3, lens.material.rgb", "at least 1"},
    {"SellmeierBelowOne", "[[lens]]\nfile = \"lens.step\"\nmaterial = { sellmeier = [-0.5, 0.01] }\n",
     "line 3, lens.material", "its index at 390 nm"},
    {"SellmeierOdd", "[[lens]]\nfile = \"lens.step\"\nmaterial = { sellmeier = [1.0] }\n",
     "line 3, lens.material.sellmeier", "pairs"},
    {"NdAlone", "[[lens]]\nfile = \"lens.step\"\nmaterial = { nd = 1.5 }\n", "line 3, lens.material.vd",
     "belong together"},
    {"TwoForms", "[[lens]]\nfile = \"lens.step\"\nmaterial = { nd = 1.5, vd = 50, rgb = [1.5, 1.5, 1.5] }\n",
     "line 3, lens.material", "exactly one"},
    {"NumberForMaterial", "[[lens]]\nfile = \"lens.step\"\nmaterial = 1.5\n", "line 3, lens.material",
     "catalogue name or a table"},
    {"MaterialKey", "[[lens]]\nfile = \"lens.step\"\nmaterial = { nd = 1.498, abbe = 58 }\n",
     "line 3, lens.material.abbe", "unknown key"},
    {"AroundUnknown", "[[lens]]\nfile = \"lens.step\"\nmaterial = \"CR-39\"\naround = \"vinegar\"\n",
     "line 4, lens.around", "not in the catalogue"},
    {"CatalogueMissing", "[[lens]]\nfile = \"lens.step\"\nmaterial = \"CR-39\"\ncatalogue = \"no.agf\"\n",
     "line 4, lens.catalogue", "no file"},
    {"TwoWavelengths", "[[lens]]\nfile = \"lens.step\"\nmaterial = \"CR-39\"\nwavelengths = 2\n",
     "line 4, lens.wavelengths", "1, 3 or more"},
    {"FaceName", "[[lens]]\nfile = \"lens.step\"\nmaterial = \"CR-39\"\nfront_faces = [\"frnt\"]\n",
     "line 4, lens.front_faces", "did you mean 'front'?"},
    {"SameFaceTwice",
     "[[lens]]\nfile = \"lens.step\"\nmaterial = \"CR-39\"\nfront_faces = [\"front\"]\nback_faces = "
     "[\"front\"]\n",
     "line 4, lens.front_faces", "on the front and on the back"},
    {"SameSurfaceTwice",
     "[[lens]]\nfront = \"lens.step\"\nback = \"lens.step\"\nfront_faces = [\"front\"]\nback_faces = "
     "[\"front\"]\nmaterial = \"CR-39\"\n",
     "line 3, lens.back", "front and back"},
    {"SameName",
     "[[lens]]\nname = \"a\"\nfile = \"lens.step\"\nmaterial = \"CR-39\"\n[[lens]]\nname = \"a\"\nfile = "
     "\"lens.step\"\nmaterial = \"CR-39\"\n",
     "line 6, lens.name", "two optics"},
    {"UnknownKey", "[[lens]]\nfile = \"lens.step\"\nmateral = \"CR-39\"\n", "line 3, lens.materal",
     "did you mean 'material'?"},
};

INSTANTIATE_TEST_SUITE_P(Slips, BadLensScene, testing::ValuesIn(kBadLenses),
                         [](const auto& bad) { return std::string(bad.param.name); });

}  // namespace
}  // namespace catoptra::app

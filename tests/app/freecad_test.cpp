// FreeCAD documents through the program: catoptra info, and as lens, mirror and surroundings of a scene.
#include <gtest/gtest.h>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/command_runner.h"
#include "tests/cad_import/freecad_files.h"

namespace catoptra::test {
namespace {

using nlohmann::json;

constexpr double kRadiusMm = 60, kApartMm = 110;  // of the balls, and of their centres: 10 mm thick

/// The common part of two balls on the z axis: a biconvex lens whose vertices are at their poles, z = -5
/// and 5.
TopoDS_Shape biconvex() {
  const auto ball = [](double z) {
    return BRepPrimAPI_MakeSphere(gp_Ax2(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1)), kRadiusMm).Shape();
  };
  return BRepAlgoAPI_Common(ball(-0.5 * kApartMm), ball(0.5 * kApartMm)).Shape();
}

/// The lens, 50 mm down in an App::Part, and a plate beside it.
std::string write_document(const TemporaryFolder& folder) {
  FreecadFile file;
  file.object("App::Part", "Part", "Optics",
              placement(0, 0, -50) + link("Origin", "Origin") + link_list("Group", {"Common"}));
  file.shape("Part::MultiCommon", "Common", "my lens", biconvex());
  file.shape("Part::Box", "Box", "plate", BRepPrimAPI_MakeBox(20, 30, 1).Shape(), placement(40, -15, -60));
  return file.write(folder / "bench.FCStd").string();
}

TEST(FreecadDocuments, InfoTellsBodiesFacesAndTheLens) {
  const TemporaryFolder folder;
  const CommandResult result = run_catoptra({"info", write_document(folder), "--json"});
  ASSERT_EQ(result.code, 0) << result.errors;
  const json info = json::parse(result.output).at("files").at(0);
  EXPECT_EQ(info.at("format"), "FreeCAD");
  EXPECT_EQ(info.at("unit"), "mm");
  ASSERT_EQ(info.at("bodies").size(), 2U);
  const json& body = info.at("bodies").at(0);
  EXPECT_EQ(body.at("name"), "my lens");
  EXPECT_EQ(body.at("faces").at(1).at("name"), "my lens.Face2");
  ASSERT_TRUE(body.contains("lens"));
  const json& lens = body.at("lens");
  EXPECT_NEAR(lens.at("center_thickness_mm").get<double>(), 2 * kRadiusMm - kApartMm, 1e-9);
  for (const char* side : {"front_vertex_curvature", "back_vertex_curvature"})
    for (const int i : {0, 1})
      EXPECT_NEAR(lens.at(side).at(std::size_t(i)).get<double>(), 1 / kRadiusMm, 1e-9);
  EXPECT_NEAR(lens.at("front_vertex_mm").at(2).get<double>(), -45, 1e-9);
  EXPECT_EQ(info.at("bodies").at(1).at("name"), "plate");
}

std::string scene(const std::string& lens, const std::string& rest) {
  return "units = \"mm\"\n[camera]\neye = [0, 3, -400]\ntarget = [0, 0, -50]\nfov_deg = 12\nresolution = "
         "[120, 90]\n"
         "[environment]\ncolor = [0.4, 0.6, 0.9]\n[[lens]]\nname = \"lens\"\nmaterial = \"CR-39\"\n" +
         lens + rest;
}

/// The same lens as a BREP file, moved by the scene, gives the same picture.
TEST(FreecadDocuments, LensInADocumentIsTheLensInABrep) {
  const TemporaryFolder folder;
  FreecadFile file;
  file.object("App::Part", "Part", "Optics",
              placement(0, 0, -50) + link("Origin", "Origin") + link_list("Group", {"Common"}));
  file.shape("Part::MultiCommon", "Common", "my lens", biconvex());
  file.write(folder / "lens.FCStd");
  folder.write("lens.brep", brep_text(biconvex()));
  FreecadFile wall;
  wall.shape("Part::Box", "Box", "post", BRepPrimAPI_MakeBox(6, 200, 6).Shape(), placement(4, -100, 60), true,
             property("ShapeColor", "App::PropertyColor", R"(<PropertyColor value="3425920512"/>)"));
  wall.write(folder / "wall.FCStd");
  const std::string post = "[[surrounding]]\nfile = \"wall.FCStd\"\n";
  folder.write("a.toml", scene("file = \"lens.FCStd\"\n", post));
  folder.write("b.toml", scene("file = \"lens.brep\"\ntranslate = [0, 0, -50]\n", post));
  folder.write("c.toml", scene("file = \"lens.brep\"\ntranslate = [0, 0, -80]\n", post));
  for (const std::string name : {"a", "b", "c"}) {
    const CommandResult result = run_catoptra({"render", (folder / (name + ".toml")).string(), "--mode",
                                               "raytrace", "-o", (folder / (name + ".png")).string()});
    ASSERT_EQ(result.code, 0) << result.errors;
  }
  EXPECT_EQ(read_file(folder / "a.png"), read_file(folder / "b.png"));
  EXPECT_NE(read_file(folder / "a.png"), read_file(folder / "c.png"));
}

TEST(FreecadDocuments, MirrorFaceIsNamedByItsBodyOrAsFreecadNamesIt) {
  const TemporaryFolder folder;
  write_document(folder);
  const auto render = [&](const std::string& face) {
    folder.write(
        "m.toml",
        "units = \"mm\"\n[camera]\neye = [50, 0, 200]\ntarget = [50, 0, -60]\nup = [0, 1, 0]\nfov_deg = "
        "20\nresolution = [60, 45]\n[[mirror]]\nname = \"m\"\nfile = \"bench.FCStd\"\nfaces = [\"" +
            face + "\"]\n");
    return run_catoptra({"render", (folder / "m.toml").string(), "-o", (folder / "m.png").string()});
  };
  EXPECT_EQ(render("plate.Face6").code, 0);
  EXPECT_EQ(render("my lens").code, 0);
  const CommandResult wrong = render("plate.Face7");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_NE(wrong.errors.find("plate.Face7"), std::string::npos) << wrong.errors;
}

TEST(FreecadDocuments, BrokenDocumentIsOneLineWithARemedy) {
  const TemporaryFolder folder;
  const std::string file = write_document(folder);
  std::filesystem::resize_file(file, 2000);
  const CommandResult result = run_catoptra({"info", file});
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.errors.find("bench.FCStd: the FreeCAD document is cut off or damaged"), std::string::npos)
      << result.errors;
  EXPECT_NE(result.errors.find("save it again"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace catoptra::test

// FreeCAD documents: what is shown, where, under which name and in which colour.
#include <gtest/gtest.h>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cad_import/import.h"
#include "tests/cad_import/freecad_files.h"
#include "tests/cad_import/mesh_files.h"

namespace catoptra::cad_import {
namespace {

using test::FreecadFile;

TopoDS_Shape box() {
  return BRepPrimAPI_MakeBox(1, 2, 3).Shape();
}

BoundingBox bounds_of(const CadModel& model, const Body& body) {
  BoundingBox box;
  for (const int face : body.faces) {
    box.min = glm::min(box.min, model.faces[std::size_t(face)].bounds.min);
    box.max = glm::max(box.max, model.faces[std::size_t(face)].bounds.max);
  }
  return box;
}

void expect_box(const CadModel& model, std::size_t body, const glm::dvec3& min, const glm::dvec3& max) {
  ASSERT_LT(body, model.bodies.size());
  const BoundingBox box = bounds_of(model, model.bodies[body]);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(box.min[axis], min[axis], 1e-9) << model.bodies[body].name << " min "
                                                << "xyz"[axis];
    EXPECT_NEAR(box.max[axis], max[axis], 1e-9) << model.bodies[body].name << " max "
                                                << "xyz"[axis];
  }
}

std::vector<std::string> names(const CadModel& model) {
  std::vector<std::string> all;
  for (const Body& body : model.bodies) all.push_back(body.name);
  return all;
}

using Names = std::vector<std::string>;
const double kHalf = std::sqrt(0.5);  // of the quaternion of a quarter turn

TEST(FreecadDocument, ShowsVisibleShapesUnderTheirLabels) {
  const ScratchFolder folder;
  FreecadFile file;
  file.shape("Part::Box", "Box", "K\xC3\xBChler &amp; Co", box(), test::placement(10, 0, 0));
  file.shape("Part::Box", "Box001", "hidden", box(), "", false);
  file.shape("Part::Feature", "Ray", "a ray",
             BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Shape());
  file.object("Part::FeaturePython", "Settings", "settings", test::shape_property("Settings.Shape.brp"));
  file.entries.emplace_back("Settings.Shape.brp", "");
  const auto path = file.write(folder / "document.FCStd");
  EXPECT_EQ(sniff_format(path), FileFormat::freecad);
  const CadModel model = import_cad(path);
  EXPECT_EQ(model.format, "FreeCAD");
  EXPECT_EQ(model.unit, "mm");
  ASSERT_EQ(names(model), Names{"K\xC3\xBChler & Co"});
  EXPECT_TRUE(model.bodies[0].solid);
  EXPECT_TRUE(model.warnings.empty()) << model.warnings.front();
  expect_box(model, 0, {10, 0, 0}, {11, 2, 3});
  EXPECT_EQ(model.faces[0].name, "K\xC3\xBChler & Co.Face1");
  EXPECT_EQ(model.faces[5].name, "K\xC3\xBChler & Co.Face6");
  EXPECT_DOUBLE_EQ(model.faces[0].area_mm2, 6);  // x = 0, as FreeCAD numbers a box
}

TEST(FreecadDocument, PlacementStandsInPlaceOfTheShapesOwnLocation) {
  const ScratchFolder folder;
  FreecadFile file;
  gp_Trsf shift;
  shift.SetTranslation(gp_Vec(10, 0, 0));
  file.shape("Part::Box", "Box", "Box", box().Located(TopLoc_Location(shift)), test::placement(10, 0, 0));
  file.shape("Part::Feature", "Old", "no placement", box().Located(TopLoc_Location(shift)));
  const CadModel model = import_cad(file.write(folder / "a.FCStd"));
  expect_box(model, 0, {10, 0, 0}, {11, 2, 3});
  expect_box(model, 1, {10, 0, 0}, {11, 2, 3});
}

TEST(FreecadDocument, ComposesThePlacementsOfNestedParts) {
  const ScratchFolder folder;
  FreecadFile file;
  // (x, y, z) of the box -> +z by 5 -> quarter turn about z: (-y, x, z) -> +x by 100.
  file.object(
      "App::Part", "Outer", "Outer",
      test::placement(100, 0, 0) + test::link("Origin", "O") + test::link_list("Group", {"Inner", "Folder"}));
  file.object("App::Part", "Inner", "Inner",
              test::placement(0, 0, 0, "Placement", 0, 0, kHalf, kHalf) + test::link("Origin", "O2") +
                  test::link_list("Group", {"Box"}));
  file.object("App::DocumentObjectGroup", "Folder", "Folder", test::link_list("Group", {"Box001"}));
  file.shape("Part::Box", "Box", "Box", box(), test::placement(0, 0, 5));
  file.shape("Part::Box", "Box001", "in a folder", box());
  const CadModel model = import_cad(file.write(folder / "a.FCStd"));
  ASSERT_EQ(names(model), (Names{"Box", "in a folder"}));
  expect_box(model, 0, {98, 0, 5}, {100, 1, 8});
  expect_box(model, 1, {100, 0, 0}, {101, 2, 3});
}

TEST(FreecadDocument, HiddenContainerHidesWhatIsInIt) {
  const ScratchFolder folder;
  FreecadFile file;
  file.object("App::Part", "Part", "Part", test::link("Origin", "O") + test::link_list("Group", {"Box"}),
              false);
  file.shape("Part::Box", "Box", "Box", box());
  file.shape("Part::Sphere", "Sphere", "Sphere", BRepPrimAPI_MakeSphere(1).Shape());
  EXPECT_EQ(names(import_cad(file.write(folder / "a.FCStd"))), Names{"Sphere"});
}

TEST(FreecadDocument, BodyIsItsResultNotItsHistory) {
  const ScratchFolder folder;
  FreecadFile file;
  const std::string tree = test::link("Origin", "O") + test::link_list("Group", {"Pad", "Pocket"}) +
                           test::link("Tip", "Pocket") + test::placement(0, 0, 50);
  file.shape("PartDesign::Body", "Body", "Body", box(), tree);
  file.shape("PartDesign::Pad", "Pad", "Pad", BRepPrimAPI_MakeBox(9, 9, 9).Shape());
  file.shape("PartDesign::Pocket", "Pocket", "Pocket", box());
  file.object("PartDesign::Body", "Old", "old body",  // FreeCAD 0.16: no shape of its own
              test::link("Origin", "O") + test::link_list("Model", {"Pad001", "Pocket001"}) +
                  test::link("Tip", "Pocket001") + test::placement(0, 0, -50));
  file.shape("PartDesign::Pad", "Pad001", "Pad001", BRepPrimAPI_MakeBox(9, 9, 9).Shape());
  file.shape("PartDesign::Pocket", "Pocket001", "Pocket001", box(), "", false);
  file.shape("PartDesign::Plane", "DatumPlane", "a datum plane", box());
  const CadModel model = import_cad(file.write(folder / "a.FCStd"));
  ASSERT_EQ(names(model), (Names{"Body", "old body"}));
  expect_box(model, 0, {0, 0, 50}, {1, 2, 53});
  expect_box(model, 1, {0, 0, -50}, {1, 2, -47});
}

TEST(FreecadDocument, LinksShowTheirObjectAtTheirOwnPlace) {
  const ScratchFolder folder;
  FreecadFile file;
  file.shape("Part::Box", "Box", "Box", box(), test::placement(10, 0, 0), false);
  const auto place = [](double y) {
    return test::placement(0, y, 0, "LinkPlacement") + test::placement(0, y, 0);
  };
  file.object("App::Link", "Link", "copy", test::x_link("Box") + place(100));
  file.object("App::Link", "Link001", "with its place",
              test::x_link("Box") + place(200) + test::boolean("LinkTransform", true));
  file.object("App::Link", "Link002", "of the copy", test::x_link("Link001") + place(300));
  file.object("App::Link", "Link003", "twice as large",
              test::x_link("Box") + place(400) +
                  test::property("ScaleVector", "App::PropertyVector",
                                 R"(<PropertyVector valueX="2" valueY="2" valueZ="2"/>)"));
  file.object("App::Link", "Link004", "squeezed",
              test::x_link("Box") + place(500) +
                  test::property("ScaleVector", "App::PropertyVector",
                                 R"(<PropertyVector valueX="2" valueY="1" valueZ="0.5"/>)"));
  const CadModel model = import_cad(file.write(folder / "a.FCStd"));
  ASSERT_EQ(names(model), (Names{"copy", "with its place", "of the copy", "twice as large", "squeezed"}));
  expect_box(model, 0, {0, 100, 0}, {1, 102, 3});
  expect_box(model, 1, {10, 200, 0}, {11, 202, 3});
  expect_box(model, 2, {10, 300, 0},
             {11, 302, 3});  // the inner link's own place does not count, its object's does
  expect_box(model, 3, {0, 400, 0}, {2, 404, 6});
  expect_box(model, 4, {0, 500, 0}, {2, 502, 1.5});
  EXPECT_EQ(model.faces[6].name, "with its place.Face1");  // each copy's faces have names of their own
}

TEST(FreecadDocument, LinkToAPartShowsWhatIsInIt) {
  const ScratchFolder folder;
  FreecadFile file;
  file.object(
      "App::Part", "Part", "Part",
      test::placement(1000, 0, 0) + test::link("Origin", "O") + test::link_list("Group", {"Box", "Box001"}),
      false);
  file.shape("Part::Box", "Box", "Box", box(), test::placement(10, 0, 0));
  file.shape("Part::Box", "Box001", "hidden in it", box(), "", false);
  file.object("App::Link", "Link", "copy", test::x_link("Part") + test::placement(0, 100, 0));
  file.object("App::Link", "Link001", "one thing of it",
              test::x_link("Part", "", "Box.") + test::placement(0, 200, 0));
  const CadModel model = import_cad(file.write(folder / "a.FCStd"));
  ASSERT_EQ(names(model), (Names{"Box", "one thing of it"}));
  expect_box(model, 0, {10, 100, 0}, {11, 102, 3});
  expect_box(model, 1, {10, 200, 0}, {11, 202, 3});
}

/// A list of placements as FreeCAD stores it: a count, then position and quaternion, each in double
/// precision.
std::string placement_bytes(const std::vector<std::array<double, 7>>& list) {
  const auto count = static_cast<std::uint32_t>(list.size());
  std::string bytes(sizeof count + list.size() * sizeof(list[0]), '\0');
  std::memcpy(bytes.data(), &count, sizeof count);
  std::memcpy(bytes.data() + sizeof count, list.data(), list.size() * sizeof(list[0]));
  return bytes;
}

TEST(FreecadDocument, ArraysAndGroupsOfLinks) {
  const ScratchFolder folder;
  FreecadFile file;
  file.shape("Part::Box", "Box", "Box", box(), test::placement(7, 7, 7), false);
  file.object(
      "App::Link", "Array", "row",
      test::x_link("Box") + test::placement(0, 100, 0) +
          test::property("ElementCount", "App::PropertyIntegerConstraint", R"(<Integer value="2"/>)") +
          test::property("PlacementList", "App::PropertyPlacementList", R"(<PlacementList file="Places"/>)"));
  file.entries.emplace_back("Places",
                            placement_bytes({{0, 0, 0, 0, 0, 0, 1}, {20, 0, 0, 0, 0, kHalf, kHalf}}));
  file.shape("Part::Box", "A", "A", box(), test::placement(1, 0, 0), false);
  file.shape("Part::Box", "B", "B", box(), test::placement(2, 0, 0));
  file.shape("Part::Box", "C", "C", box(), test::placement(3, 0, 0));
  // The last digit is the first element's: A shown (though hidden itself), B not, C shown.
  file.object("App::LinkGroup", "Group", "Group",
              test::link_list("ElementList", {"A", "B", "C"}) + test::placement(0, 0, 50) +
                  test::property("VisibilityList", "App::PropertyBoolList", R"(<BoolList value="101"/>)"));
  const CadModel model = import_cad(file.write(folder / "a.FCStd"));
  ASSERT_EQ(names(model), (Names{"row 1", "row 2", "A", "C"}));
  expect_box(model, 0, {0, 100, 0}, {1, 102, 3});
  expect_box(model, 1, {18, 100, 0}, {20, 101, 3});
  expect_box(model, 2, {1, 0, 50}, {2, 2, 53});
  expect_box(model, 3, {3, 0, 50}, {4, 2, 53});
}

TEST(FreecadDocument, WithoutAUserInterfaceTheResultsAreShown) {
  const ScratchFolder folder;
  FreecadFile file;
  file.shape("Part::Box", "Box", "Box", box());
  file.shape("Part::Sphere", "Sphere", "Sphere", BRepPrimAPI_MakeSphere(9).Shape());
  file.shape("Part::Cut", "Cut", "Cut", box(), test::link("Base", "Box") + test::link("Tool", "Sphere"));
  const CadModel made_by_script = import_cad(file.write(folder / "a.FCStd", false));
  EXPECT_EQ(names(made_by_script), Names{"Cut"});
  EXPECT_TRUE(made_by_script.warnings.empty());

  FreecadFile hidden;
  hidden.shape("Part::Box", "Box", "Box", box(), "", false);
  hidden.shape("Part::Fillet", "Fillet", "Fillet", box(), test::link("Base", "Box"), false);
  const CadModel model = import_cad(hidden.write(folder / "b.FCStd"));
  EXPECT_EQ(names(model), Names{"Fillet"});
  ASSERT_EQ(model.warnings.size(), 1U);
  EXPECT_NE(model.warnings[0].find("every shape is hidden"), std::string::npos) << model.warnings[0];
}

TEST(FreecadDocument, NamesMeshesAndLinksElsewhereThatItLeavesOut) {
  const ScratchFolder folder;
  FreecadFile file;
  file.shape("Part::Box", "Box", "Box", box());
  file.object("Mesh::Feature", "Mesh", "scanned face", "");
  file.object("App::Link", "Link", "wheel", test::x_link("Body", "wheel.FCStd"));
  file.object("App::Link", "Link001", "one face", test::x_link("Box", "", "Face3"));
  const CadModel model = import_cad(file.write(folder / "a.FCStd"));
  EXPECT_EQ(names(model), Names{"Box"});
  ASSERT_EQ(model.warnings.size(), 3U);
  EXPECT_NE(model.warnings[0].find("\"scanned face\" is a mesh"), std::string::npos) << model.warnings[0];
  EXPECT_NE(model.warnings[1].find("\"wheel\" is a link into another document, wheel.FCStd"),
            std::string::npos);
  EXPECT_NE(model.warnings[2].find("\"one face\" is a link to a face"), std::string::npos)
      << model.warnings[2];
}

std::string words(const std::vector<std::uint32_t>& values) {
  std::string bytes(4 * values.size(), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

// IEC 61966-2-1, 5.2.
double linear(double srgb) {
  return std::pow((srgb + 0.055) / 1.055, 2.4);
}

TEST(FreecadDocument, ColoursOfAllVersionsAreLinear) {
  const ScratchFolder folder;
  FreecadFile file;
  const auto list = [](const std::string& name, const std::string& kind, const std::string& entry) {
    return test::property(name, "App::Property" + kind,
                          "<" + kind + " file=\"" + entry + "\" version=\"3\"/>");
  };
  file.shape("Part::Box", "A", "0.16", box(), "", true,
             test::property("ShapeColor", "App::PropertyColor", R"(<PropertyColor value="3425920512"/>)"));
  file.shape("Part::Box", "B", "faces", box(), "", true, list("DiffuseColor", "ColorList", "Diffuse"));
  const std::uint32_t red = 0xCC336600, blue = 0x3366CC00;
  file.entries.emplace_back("Diffuse", words({6, red, blue, red, red, red, red}));
  file.shape("Part::Box", "C", "1.0", box(), "", true, list("ShapeAppearance", "MaterialList", "Look"));
  file.entries.emplace_back("Look", words({1, 0x555555FF, blue, 0x888888FF, 0xFF, 0x3F666666, 0, 0, 0, 0}));
  file.object("App::Link", "Link", "copy", test::x_link("A"), true,
              test::boolean("OverrideMaterial", true) +
                  test::property("ShapeMaterial", "App::PropertyMaterial",
                                 R"(<PropertyMaterial diffuseColor="862374912"/>)"));
  file.object("App::Link", "Link001", "plain copy", test::x_link("C"));
  const CadModel model = import_cad(file.write(folder / "a.FCStd"));
  ASSERT_EQ(model.bodies.size(), 5U);
  const glm::dvec3 linear_red(linear(0.8), linear(0.2), linear(0.4)),
      linear_blue(linear(0.2), linear(0.4), linear(0.8));
  const auto expect_color = [&](int face, const glm::dvec3& color) {
    ASSERT_TRUE(model.faces[std::size_t(face)].color) << face;
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR((*model.faces[std::size_t(face)].color)[i], color[i], 1e-6) << face;
  };
  expect_color(0, linear_red);
  expect_color(6, linear_red);
  expect_color(7, linear_blue);
  expect_color(12, linear_blue);
  expect_color(18, linear_blue);
  expect_color(24, linear_blue);
}

TEST(FreecadDocument, ReadsBinaryShapes) {
  const ScratchFolder folder;
  FreecadFile file;
  file.object("Part::Box", "Box", "Box", test::shape_property("PartShape.bin"));
  file.entries.emplace_back("PartShape.bin", test::brep_binary(box()));
  const CadModel model = import_cad(file.write(folder / "a.FCStd"));
  ASSERT_EQ(names(model), Names{"Box"});
  expect_box(model, 0, {0, 0, 0}, {1, 2, 3});
}

TEST(FreecadDocument, TakesUnitScaleAndSurroundingsAsOtherCadDoes) {
  const ScratchFolder folder;
  FreecadFile file;
  file.shape("Part::Box", "Box", "Box", box());
  const auto path = file.write(folder / "a.FCStd");
  ImportOptions options;
  options.unit = "in";  // the designer drew inches as if they were mm
  const CadModel model = import_cad(path, options);
  expect_box(model, 0, {0, 0, 0}, {25.4, 50.8, 76.2});
  EXPECT_EQ(import_mesh(path).triangles.size(), 12U);
}

}  // namespace
}  // namespace catoptra::cad_import

// Units, names, colours, assemblies, topology and identity of imported CAD files.
#include <gtest/gtest.h>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax1.hxx>
#include <gp_Trsf.hxx>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numbers>
#include <regex>
#include <set>
#include <thread>

#include "cad_import/import.h"
#include "tests/cad_import/cad_files.h"

namespace catoptra::cad_import {
namespace {

constexpr double kFileRounding = 1e-9;  // mm; STEP writers keep 15 digits

void expect_box(const BoundingBox& box, const glm::dvec3& low, const glm::dvec3& high,
                double tolerance = kFileRounding) {
  EXPECT_LT(glm::length(box.min - low), tolerance) << box.min.x << ' ' << box.min.y << ' ' << box.min.z;
  EXPECT_LT(glm::length(box.max - high), tolerance) << box.max.x << ' ' << box.max.y << ' ' << box.max.z;
}

bool has_warning(const std::vector<std::string>& warnings, const std::string& part) {
  return std::ranges::any_of(warnings,
                             [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

class StepUnit : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(StepUnit, BecomesMillimetres) {
  const ScratchFolder folder;
  const auto [written, recognised] = GetParam();
  test::write_box(folder / "box.step", written);
  const CadModel model = import_cad(folder / "box.step");
  EXPECT_EQ(model.format, "STEP");
  EXPECT_EQ(model.unit, recognised);
  expect_box(model.bounds, {0, 0, 0}, {10, 20, 30});
  EXPECT_TRUE(model.warnings.empty()) << model.warnings.front();
}

INSTANTIATE_TEST_SUITE_P(Units, StepUnit,
                         testing::Values(std::pair("MM", "mm"), std::pair("CM", "cm"), std::pair("M", "m"),
                                         std::pair("INCH", "in"), std::pair("FT", "ft")));

TEST(ImportCad, UnitNamesInAnyLetterCase) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step", "INCH");
  std::string text = test::read_text(folder / "box.step");
  const std::size_t at = text.find("'INCH'");
  ASSERT_NE(at, std::string::npos);
  for (const char* name : {"'inch'", "'Inch'"}) {
    test::write_text(folder / "case.step", text.replace(at, 6, name));
    const CadModel model = import_cad(folder / "case.step");
    EXPECT_EQ(model.unit, "in");
    expect_box(model.bounds, {0, 0, 0}, {10, 20, 30});
  }
}

TEST(ImportCad, UnitOptionReplacesWhatTheFileSays) {
  const ScratchFolder folder;
  test::write_box(folder / "mm.step", "MM");
  test::write_box(folder / "inch.step", "INCH");
  ImportOptions options;
  options.unit = "m";
  const CadModel model = import_cad(folder / "mm.step", options);
  expect_box(model.bounds, {0, 0, 0}, {10e3, 20e3, 30e3}, 1e-6);
  EXPECT_EQ(model.unit, "mm");  // still what the file says
  EXPECT_TRUE(has_warning(model.warnings, "30 m long: is the unit right?"));
  options.unit = "mm";  // the numbers in the file are 10 / 25.4 and so on
  expect_box(import_cad(folder / "inch.step", options).bounds, {0, 0, 0}, glm::dvec3(10, 20, 30) / 25.4);
  options.unit = "parsec";
  EXPECT_THROW((void)import_cad(folder / "mm.step", options), ImportError);
}

TEST(ImportCad, ScaleThenPlacement) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step");
  ImportOptions options;
  options.scale = 2;
  options.placement = glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(100, 0, 0)), std::numbers::pi / 2,
                                  glm::dvec3(0, 0, 1));
  const CadModel model = import_cad(folder / "box.step", options);
  expect_box(model.bounds, {60, 0, 0}, {100, 20, 60});
  double area = 0;
  for (const Face& face : model.faces) area += face.area_mm2;
  EXPECT_NEAR(area, 4 * 2200, 1e-8);
  for (const Face& face : model.faces) {  // normals still point away from the middle
    const ParameterDomain d = face.surface->domain();
    const double u = 0.5 * (d.u_min + d.u_max), v = 0.5 * (d.v_min + d.v_max);
    EXPECT_GT(glm::dot(face.surface->unit_normal(u, v), face.surface->point(u, v) - glm::dvec3(80, 10, 30)),
              0);
  }
  options.scale = 0;
  EXPECT_THROW((void)import_cad(folder / "box.step", options), ImportError);
  options.scale = 1;
  options.placement = glm::scale(glm::dmat4(1), glm::dvec3(1, 2, 1));
  EXPECT_THROW((void)import_cad(folder / "box.step", options), ImportError);
}

TEST(ImportCad, NamesAndColoursOfFacesAndBodies) {
  const ScratchFolder folder;
  test::CadDocument document;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  const TDF_Label part = document.add(box, "Spiegel \xC3\xA4");  // UTF-8
  document.color(part, 0.25, 0.5, 0.75);
  TopExp_Explorer it(box, TopAbs_FACE);
  document.name_face(part, it.Current(), "Glass");
  document.color_face(part, it.Current(), 1, 0, 0.125);
  it.Next();
  document.name_face(part, it.Current(), "It's \\ back");
  document.write_step(folder / "named.step");

  const CadModel model = import_cad(folder / "named.step");
  ASSERT_EQ(model.bodies.size(), 1u);
  EXPECT_TRUE(model.bodies[0].solid);
  ASSERT_TRUE(model.bodies[0].color);
  EXPECT_LT(glm::length(*model.bodies[0].color - glm::dvec3(0.25, 0.5, 0.75)), 1e-6);
  std::map<std::string, glm::dvec3> color_of;
  for (const Face& face : model.faces) color_of[face.name] = *face.color;
  ASSERT_EQ(color_of.count("Glass"), 1u);
  EXPECT_LT(glm::length(color_of["Glass"] - glm::dvec3(1, 0, 0.125)), 1e-6);
  EXPECT_EQ(color_of.count("It's \\ back"), 1u);
  EXPECT_LT(glm::length(color_of[""] - glm::dvec3(0.25, 0.5, 0.75)), 1e-6)
      << "the body's colour where a face has none";
}

TEST(ImportCad, InstancesOfAnAssemblyStandWhereTheyArePut) {
  const ScratchFolder folder;
  test::CadDocument document;
  const TDF_Label nut = document.add(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "Nut");
  const TDF_Label inner = document.shapes->NewShape(), outer = document.shapes->NewShape();
  TDataStd_Name::Set(inner, "Inner");
  TDataStd_Name::Set(outer, "Outer");
  gp_Trsf right, turned;
  right.SetTranslation(gp_Vec(100, 0, 0));
  turned.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), std::numbers::pi / 2);
  document.shapes->AddComponent(inner, nut, TopLoc_Location());
  document.shapes->AddComponent(inner, nut, TopLoc_Location(right));
  document.shapes->AddComponent(outer, inner, TopLoc_Location(turned));
  document.write_step(folder / "assembly.step");

  const CadModel model = import_cad(folder / "assembly.step");
  ASSERT_EQ(model.bodies.size(), 2u);
  std::vector<BoundingBox> boxes(2);
  for (const Face& face : model.faces) {
    boxes[face.body].min = glm::min(boxes[face.body].min, face.bounds.min);
    boxes[face.body].max = glm::max(boxes[face.body].max, face.bounds.max);
  }
  expect_box(boxes[0], {-20, 0, 0}, {0, 10, 30});
  expect_box(boxes[1], {-20, 100, 0}, {0, 110, 30});
  for (const Body& body : model.bodies) EXPECT_EQ(body.name, "Nut");
  EXPECT_NEAR(model.bodies[1].placement[3].y, 100, kFileRounding);
  std::set<std::string> ids;
  for (const Face& face : model.faces) ids.insert(face.id);
  EXPECT_EQ(ids.size(), 12u);
}

TEST(ImportCad, EveryEdgeOfABoxBelongsToTwoFacesThatRunItOppositely) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step");
  const CadModel model = import_cad(folder / "box.step");
  std::map<int, std::vector<std::pair<int, int>>> ends_of_edge;
  std::set<int> vertices;
  for (const Face& face : model.faces) {
    ASSERT_EQ(face.loops.size(), 1u);
    EXPECT_TRUE(face.loops[0].outer);
    EXPECT_TRUE(face.planar);
    ASSERT_EQ(face.loops[0].edges.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      const EdgeUse& use = face.loops[0].edges[i];
      EXPECT_EQ(use.end_vertex, face.loops[0].edges[(i + 1) % 4].start_vertex);
      EXPECT_FALSE(use.seam || use.degenerate);
      ends_of_edge[use.edge].emplace_back(use.start_vertex, use.end_vertex);
      vertices.insert(use.start_vertex);
      for (const double t : {use.t_begin, 0.3 * use.t_begin + 0.7 * use.t_end, use.t_end}) {
        const glm::dvec2 uv = use.curve->uv(t);
        EXPECT_LT(glm::length(face.surface->point(uv.x, uv.y) - use.curve->point(t)), 1e-9);
      }
    }
  }
  EXPECT_EQ(ends_of_edge.size(), 12u);
  EXPECT_EQ(vertices.size(), 8u);
  for (const auto& [edge, ends] : ends_of_edge) {
    ASSERT_EQ(ends.size(), 2u);
    // Loops run counter-clockwise about du x dv; seen from outside the two uses run against each other, and
    // each face with orientation() < 0 sees its loop the other way round.
    std::vector<bool> forward;
    for (const Face& face : model.faces)
      for (const EdgeUse& use : face.loops[0].edges)
        if (use.edge == edge)
          forward.push_back((use.start_vertex == ends[0].first) == (face.surface->orientation() > 0));
    EXPECT_NE(forward[0], forward[1]);
  }
}

TEST(ImportCad, SphereAndCylinderHaveSeamsAndPoles) {
  const ScratchFolder folder;
  test::CadDocument document;
  document.add(BRepPrimAPI_MakeSphere(25).Shape(), "Ball");
  document.add(BRepPrimAPI_MakeCylinder(5, 40).Shape(), "Rod");
  document.write_step(folder / "round.step");
  const CadModel model = import_cad(folder / "round.step");
  for (const Face& face : model.faces) {
    int seams = 0, poles = 0;
    for (const TrimLoop& loop : face.loops)
      for (const EdgeUse& use : loop.edges) {
        seams += use.seam;
        poles += use.degenerate;
        if (!use.degenerate) continue;
        const glm::dvec3 begin = use.curve->point(use.t_begin), end = use.curve->point(use.t_end);
        EXPECT_LT(glm::length(begin - end), 1e-9);
      }
    if (face.surface->kind() == SurfaceKind::sphere) {
      EXPECT_EQ(seams, 2);
      EXPECT_EQ(poles, 2);
      EXPECT_NEAR(face.area_mm2, 4 * std::numbers::pi * 625, 1e-6);
      expect_box(face.bounds, glm::dvec3(-25), glm::dvec3(25), 1e-4);
      EXPECT_TRUE(face.trim->contains(0.1, 0.2));
      EXPECT_TRUE(face.trim->contains(0.1 + 4 * std::numbers::pi, 0.2));
      EXPECT_GT(face.surface->unit_normal(0.3, 0.4).x, 0);
    }
    if (face.surface->kind() == SurfaceKind::cylinder) {
      EXPECT_EQ(seams, 2);
      EXPECT_EQ(poles, 0);
      const ParameterDomain d = face.surface->domain();
      EXPECT_NEAR(d.v_max - d.v_min, 40, 1e-9);
      EXPECT_NEAR(d.u_period, 2 * std::numbers::pi, 1e-15);
    }
  }
}

TEST(ImportCad, IdentityOutlivesReimportAndPlacement) {
  const ScratchFolder folder;
  test::write_box(folder / "a.step", "MM");
  test::write_box(folder / "b.step", "INCH");
  const auto ids = [](const CadModel& model) {
    std::vector<std::string> list;
    for (const Face& face : model.faces) list.push_back(face.id);
    return list;
  };
  const CadModel first = import_cad(folder / "a.step");
  EXPECT_EQ(first.faces[0].id.size(), 8u);
  EXPECT_EQ(ids(first), ids(import_cad(folder / "a.step")));
  EXPECT_EQ(ids(first), ids(import_cad(folder / "b.step")));
  ImportOptions options;
  options.scale = 3;
  options.placement = glm::translate(glm::dmat4(1), glm::dvec3(7, 8, 9));
  EXPECT_EQ(ids(first), ids(import_cad(folder / "a.step", options)));
}

TEST(ImportCad, EqualFacesInOnePlaceAreNumbered) {
  const ScratchFolder folder;
  test::CadDocument document;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  document.add(box, "One");
  document.add(BRepBuilderAPI_Transform(box, gp_Trsf(), true).Shape(), "Two");
  document.write_step(folder / "twice.step");
  const CadModel model = import_cad(folder / "twice.step");
  ASSERT_EQ(model.faces.size(), 12u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(model.faces[i + 6].id, model.faces[i].id + "-2");
}

TEST(ImportCad, BrepTextAndBinaryHaveNoUnit) {
  const ScratchFolder folder;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  BRepTools::Write(box, (folder / "text.brep").string().c_str());
  BinTools::Write(box, (folder / "binary.brep").string().c_str());
  for (const char* name : {"text.brep", "binary.brep"}) {
    ImportOptions options;
    CadModel model = import_cad(folder / name, options);
    EXPECT_EQ(model.format, "BREP");
    EXPECT_EQ(model.unit, "unknown");
    expect_box(model.bounds, {0, 0, 0}, {10, 20, 30});
    options.unit = "cm";
    expect_box(import_cad(folder / name, options).bounds, {0, 0, 0}, {100, 200, 300});
  }
}

TEST(ImportCad, IgesInInches) {
  const ScratchFolder folder;
  test::CadDocument document;
  document.add(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "Box");
  document.write_iges(folder / "box.igs", "INCH");
  const CadModel model = import_cad(folder / "box.igs");
  EXPECT_EQ(model.format, "IGES");
  EXPECT_EQ(model.unit, "in");
  EXPECT_EQ(model.faces.size(), 6u);
  expect_box(model.bounds, {0, 0, 0}, {10, 20, 30}, 1e-6);
}

// How often each edge of the model is used, for faces whose neighbours must share their borders.
std::map<int, int> uses_of_edges(const CadModel& model) {
  std::map<int, int> uses;
  for (const Face& face : model.faces)
    for (const TrimLoop& loop : face.loops)
      for (const EdgeUse& use : loop.edges) ++uses[use.edge];
  return uses;
}

void expect_closed_box(const CadModel& model) {
  ASSERT_EQ(model.faces.size(), 6u);
  const std::map<int, int> uses = uses_of_edges(model);
  EXPECT_EQ(uses.size(), 12u);
  for (const auto& [edge, count] : uses) EXPECT_EQ(count, 2) << "edge " << edge;
  const glm::dvec3 centre = 0.5 * (model.bounds.min + model.bounds.max);
  for (const Face& face : model.faces) {
    const ParameterDomain d = face.surface->domain();
    const double u = 0.5 * (d.u_min + d.u_max), v = 0.5 * (d.v_min + d.v_max);
    EXPECT_GT(glm::dot(face.surface->unit_normal(u, v), face.surface->point(u, v) - centre), 0) << face.index;
  }
}

TEST(ImportCad, FacesThatIgesListsOneByOneShareTheirBorders) {
  const ScratchFolder folder;
  test::CadDocument document;
  document.add(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "Box");
  document.write_iges(folder / "box.igs");
  expect_closed_box(import_cad(folder / "box.igs"));
}

TEST(ImportCad, LooseFacesFaceTheSideOfTheirMajority) {
  const ScratchFolder folder;
  TopoDS_Compound loose;
  BRep_Builder builder;
  builder.MakeCompound(loose);
  bool turned = false;  // the first face looks inwards
  for (TopExp_Explorer it(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Shape face = BRepBuilderAPI_Copy(it.Current()).Shape();  // with edges of its own
    builder.Add(loose, turned ? face : face.Reversed());
    turned = true;
  }
  BRepTools::Write(loose, (folder / "loose.brep").string().c_str());
  expect_closed_box(import_cad(folder / "loose.brep"));
}

// A spectacle frame warned of missing parts because it names the CATIA documents that it was made from.
TEST(ImportCad, NativeDocumentsOfPartsThatAreInTheFileAreNoMissingFiles) {
  const ScratchFolder folder;
  test::write_box(folder / "box.step");
  std::string text = test::read_text(folder / "box.step");
  text = std::regex_replace(text, std::regex(R"(PRODUCT_DEFINITION\(([^;]*)\);)"),
                            "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS($1,(#90002));"
                            "#90001=DOCUMENT_TYPE('');#90002=DOCUMENT('4','box.NAME','a document',#90001);",
                            std::regex_constants::format_first_only);
  const auto named = [&](const char* suffix) {
    std::string renamed = text;
    renamed.replace(renamed.find("box.NAME"), 8, std::string("box.") + suffix);
    return renamed;
  };
  test::write_text(folder / "native.step", named("CATPart"));
  EXPECT_FALSE(has_warning(import_cad(folder / "native.step").warnings, "other file"));
  test::write_text(folder / "missing.step", named("stp"));
  EXPECT_TRUE(has_warning(import_cad(folder / "missing.step").warnings, "other file"));
}

TEST(ImportCad, ManyThreadsMayImportAtOnce) {
  const ScratchFolder folder;
  test::write_box(folder / "mm.step", "MM");
  test::write_box(folder / "inch.step", "INCH");
  std::vector<CadModel> models(6);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < models.size(); ++i)
    threads.emplace_back([&, i] { models[i] = import_cad(folder / (i % 2 ? "mm.step" : "inch.step")); });
  for (std::thread& thread : threads) thread.join();
  for (const CadModel& model : models) expect_box(model.bounds, {0, 0, 0}, {10, 20, 30});
}

}  // namespace
}  // namespace catoptra::cad_import

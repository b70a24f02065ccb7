// Lenses recognised in CAD models: those that the maker made, turned and in parts, and what is no lens.
#include "cad_import/lens_faces.h"

#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepTools.hxx>
#include <glm/gtc/matrix_transform.hpp>

#include "cad_import/import.h"
#include "cad_import/lens_blank.h"
#include "tests/cad_import/lens_rays.h"
#include "tests/cad_import/mesh_files.h"
#include "tests/support/bad_lenses.h"

namespace catoptra::cad_import {
namespace {

LensBlank minus_lens() {
  LensBlank blank;
  blank.sphere_d = -4;
  blank.cylinder_d = -1;
  blank.axis_deg = 30;
  blank.front_curve_d = 4;
  blank.diameter_mm = 50;
  return blank;
}

/// Names and order removed: only the geometry tells.
CadModel without_names(CadModel model) {
  for (Face& face : model.faces) face.name.clear();
  return model;
}

void expect_minus_lens(const LensFaces& lens, const LensBlankReport& report) {
  EXPECT_NEAR(lens.geometry.center_thickness_mm, report.center_thickness_mm, 1e-7);
  EXPECT_NEAR(lens.geometry.front_curvature.k1, 1 / report.front_radius_mm, 1e-7);
  EXPECT_NEAR(lens.geometry.front_curvature.k2, 1 / report.front_radius_mm, 1e-7);
  // Concave towards the eye: negative from outside, the flatter one first.
  const double a = -1 / report.back_radius1_mm, b = -1 / report.back_radius2_mm;
  EXPECT_NEAR(lens.geometry.back_curvature.k1, std::max(a, b), 1e-7);
  EXPECT_NEAR(lens.geometry.back_curvature.k2, std::min(a, b), 1e-7);
}

TEST(RecogniseLens, MadeLensHasItsAxisThicknessAndCurvatures) {
  const LensShape shape(minus_lens());
  const CadModel named = lens_model(shape);
  for (const CadModel& model : {named, without_names(named)}) {
    const LensFaces lens = recognise_lens(model);
    EXPECT_EQ(lens.front, std::vector<int>{test::face_called(named, "front").index});
    EXPECT_EQ(lens.back, std::vector<int>{test::face_called(named, "back").index});
    EXPECT_EQ(lens.rim.size(), 4u);
    EXPECT_EQ(lens.geometry.axis, glm::dvec3(0, 0, 1));
    EXPECT_LT(glm::length(lens.geometry.front_vertex_mm), 1e-6);
    expect_minus_lens(lens, shape.report());
    EXPECT_TRUE(lens_in_body(model, 0).has_value());
  }
}

TEST(RecogniseLens, TurnedAndMovedLensIsTheSame) {
  const ScratchFolder folder;
  const LensShape shape(minus_lens());
  write_lens(shape, folder / "lens.step");
  ImportOptions options;
  options.placement =
      glm::rotate(glm::translate(glm::dmat4(1), {100, -40, 7}), 0.7, glm::normalize(glm::dvec3(1, 2, -0.5)));
  const LensFaces lens = recognise_lens(without_names(import_cad(folder / "lens.step", options)));
  const glm::dvec3 axis(options.placement * glm::dvec4(0, 0, 1, 0));
  EXPECT_LT(glm::length(lens.geometry.axis - axis), 1e-6);
  EXPECT_LT(glm::length(lens.geometry.front_vertex_mm - glm::dvec3(100, -40, 7)), 1e-3);
  EXPECT_NEAR(lens.geometry.center_thickness_mm, shape.report().center_thickness_mm, 1e-6);
}

TEST(RecogniseLens, VertexOfADecentredOutlineIsStillTheOrigin) {
  LensBlank blank = minus_lens();
  blank.outline = {{-12, -10}, {25, -14}, {24, 18}, {-10, 15}};
  const LensFaces lens = recognise_lens(lens_model(LensShape(blank)));
  EXPECT_LT(glm::length(lens.geometry.front_vertex_mm), 1e-6);
  EXPECT_EQ(lens.geometry.axis, glm::dvec3(0, 0, 1));
}

TEST(RecogniseLens, GivenFacesGoFirst) {
  const CadModel model = lens_model(LensShape(minus_lens()));
  const int front = test::face_called(model, "front").index, back = test::face_called(model, "back").index;
  // The other way round: what is named the back is entered first.
  const std::vector<int> as_front{back};
  const LensFaces turned = recognise_lens(model, as_front);
  EXPECT_EQ(turned.front, as_front);
  EXPECT_EQ(turned.back, std::vector<int>{front});
  EXPECT_EQ(turned.geometry.axis, glm::dvec3(0, 0, -1));
  EXPECT_THROW((void)recognise_lens(model, as_front, as_front), Error);
  const std::vector<int> none{99};
  EXPECT_THROW((void)recognise_lens(model, none), Error);
}

TEST(RecogniseLens, TwoLooseSurfacesAreMeasured) {
  const LensShape shape(minus_lens());
  const CadModel model = lens_model(shape);
  const std::vector<Face> front{test::face_called(model, "front")}, back{test::face_called(model, "back")};
  const LensGeometry lens = measure_lens(front, back, "two files");
  EXPECT_EQ(lens.axis, glm::dvec3(0, 0, 1));
  EXPECT_NEAR(lens.center_thickness_mm, shape.report().center_thickness_mm, 1e-7);
  EXPECT_THROW((void)measure_lens(front, {}, "one file"), Error);
}

TEST(RecogniseLens, OpenShellIsToldUnlessBothSidesAreGiven) {
  CadModel model = lens_model(LensShape(minus_lens()));
  for (Body& body : model.bodies) body.solid = false;
  try {
    (void)recognise_lens(model);
    FAIL() << "an open shell is no lens";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("open shell"), std::string::npos) << error.what();
  }
  const std::vector<int> front{0}, back{1};
  EXPECT_TRUE(recognise_lens(model, front, back).rim.empty());
}

/// Balls' caps on their poles, as CAD systems turn lenses: the surface is singular on the axis, and the ball
/// behind a cap meets the axis twice.
TEST(RecogniseLens, CapsOfBallsWithTheirPolesOnTheAxis) {
  const ScratchFolder folder;
  for (const double back_mm : {60.0, -100.0}) {
    test::write_solid({80, 0}, {back_mm, -6}, folder / "caps.brep");
    const LensFaces lens = recognise_lens(import_cad(folder / "caps.brep"));
    EXPECT_EQ(lens.geometry.axis, glm::dvec3(0, 0, 1));
    EXPECT_NEAR(lens.geometry.center_thickness_mm, 6, 1e-9);
    EXPECT_NEAR(lens.geometry.front_curvature.k1, 1 / 80.0, 1e-7);
    EXPECT_NEAR(lens.geometry.back_curvature.k1, -1 / back_mm, 1e-7);
  }
}

/// Both sides end in the same edge.
TEST(RecogniseLens, KnifeEdge) {
  const ScratchFolder folder;
  const double back_vertex = 2 * test::Cap{50, 0}.rim_mm();
  test::write_solid({50, 0}, {-50, back_vertex}, folder / "knife.brep");
  const LensFaces lens = recognise_lens(import_cad(folder / "knife.brep"));
  EXPECT_NEAR(lens.geometry.center_thickness_mm, -back_vertex, 1e-9);
  EXPECT_TRUE(lens.rim.empty());
}

TEST(RecogniseLens, BoxIsNoLens) {
  const ScratchFolder folder;
  BRepTools::Write(BRepPrimAPI_MakeBox(40, 40, 3).Shape(), (folder / "box.brep").c_str());
  const CadModel model = import_cad(folder / "box.brep");
  EXPECT_FALSE(lens_in_body(model, 0).has_value());
  EXPECT_THROW((void)recognise_lens(model), Error);
}

}  // namespace
}  // namespace catoptra::cad_import

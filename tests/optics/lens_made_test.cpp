// Lenses made to order and measured: the prescription comes back, and a progressive obeys Minkwitz.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "cad_import/lens_blank.h"
#include "cad_import/lens_faces.h"
#include "optics/lens_evaluation.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::optics {
namespace {

// A made lens within the square that its round outline holds.
struct MadeLens {
  cad_import::CadModel model;
  Optic optic;
  LensFrame frame;

  explicit MadeLens(const cad_import::LensBlank& blank) : model(lens_model(cad_import::LensShape(blank))) {
    const auto sides = cad_import::recognise_lens(model);
    const auto& front = model.faces[std::size_t(sides.front[0])];
    const auto& back = model.faces[std::size_t(sides.back[0])];
    optic = test::lens_of_sides(front.surface, back.surface, 0.7 * blank.diameter_mm, 41);
    optic.medium = abbe_medium(blank.index, 40);
    frame = lens_frame(sides.geometry);
  }
};

TEST(MadeLens, FrameIsThatOfTheFile) {
  cad_import::LensBlank blank;
  blank.sphere_d = -3;
  const MadeLens lens(blank);
  EXPECT_LT(glm::distance(lens.frame.x, {1, 0, 0}), 1e-12);
  EXPECT_LT(glm::distance(lens.frame.y, {0, 1, 0}), 1e-12);
  EXPECT_LT(glm::distance(lens.frame.z, {0, 0, 1}), 1e-12);
  EXPECT_LT(glm::length(lens.frame.front_vertex_mm), 1e-6);
  // Where up runs along the axis, z of the model is up unless that is the axis too.
  cad_import::LensGeometry geometry;
  geometry.axis = {0, 1, 0};
  EXPECT_EQ(lens_frame(geometry).y, glm::dvec3(0, 0, 1));
  EXPECT_EQ(lens_frame(geometry).x, glm::dvec3(-1, 0, 0));
  geometry.axis = {0, 0, 1};
  EXPECT_EQ(lens_frame(geometry, {0, 0, 1}).y, glm::dvec3(0, 1, 0));
}

// The focimeter reads at the back vertex what was ordered.
TEST(MadeLens, FocimeterReadsThePrescription) {
  for (const double axis : {180.0, 35.0, 120.0})
    for (const bool aspheric : {false, true}) {
      cad_import::LensBlank blank;
      blank.index = 1.6;
      blank.sphere_d = 2.25;
      blank.cylinder_d = -1.75;
      blank.axis_deg = axis;
      if (aspheric) {
        blank.front = cad_import::LensFrontForm::asphere;
        blank.conic = -1.5;
        blank.asphere_mm = {1e-7};
        blank.back_conic = -0.5;
      }
      const MadeLens lens(blank);
      EvaluationOptions options;
      const auto result = LensEvaluator(lens.optic, lens.frame).at_points({}, options);
      constexpr double kCurve_d = 0.002;  // what the made spline's second derivatives allow
      EXPECT_NEAR(result.reference.sphere_d, 2.25, kCurve_d);
      EXPECT_NEAR(result.reference.cylinder_d, -1.75, kCurve_d);
      EXPECT_NEAR(std::remainder(glm::degrees(result.reference.axis_rad) - axis, 180), 0, 0.05);
      EXPECT_NEAR(glm::length(result.reference_prism), 0, 1e-3);
    }
}

struct Reading {
  double mean_d, astigmatism_d;
};

Reading through_lens(const LensEvaluator& evaluator, double x, double y) {
  EvaluationOptions options;
  options.chromatic = false;
  const glm::dvec2 point(x, y);
  const LensPoint p = evaluator.at_points(std::span(&point, 1), options).points[0];
  EXPECT_EQ(p.end, LensPathEnd::passed);
  return {p.power.mean(), -sphere_cylinder(p.power, CylinderForm::minus).cylinder_d};
}

Reading front_surface(const MadeLens& lens, double x, double y) {
  const auto k = lens.optic.faces[0].surface->principal_curvatures(x, y);
  const double d = 1000 * (lens.optic.medium.nd - 1);
  return {0.5 * d * (k.k1 + k.k2), d * (k.k1 - k.k2)};
}

// Beside an umbilical line astigmatism grows at twice the rate of the mean power along it: dA/dx = 2 dP/dy.
// Exact for the front surface where the line is flat; its curvature and slope and the lens's thickness change
// the rates by their own order.
TEST(MadeLens, MinkwitzBesideTheCorridor) {
  cad_import::LensBlank blank;
  blank.index = 1.5;
  blank.front = cad_import::LensFrontForm::freeform;
  blank.front_curve_d = 2;
  blank.addition_d = 2;
  blank.corridor_mm = 16;
  blank.center_thickness_mm = 2;
  blank.sphere_d = 0;
  const MadeLens lens(blank);
  const LensEvaluator evaluator(lens.optic, lens.frame);
  const double h = 0.5;
  for (const double y : {-5.0, -8.0, -11.0}) {
    // On the front, the height that belongs to the same place is the same to within the thickness's slope.
    const double along =
        (front_surface(lens, 0, y - h).mean_d - front_surface(lens, 0, y + h).mean_d) / (2 * h);
    for (const double x : {h, -h}) {
      const double across = front_surface(lens, x, y).astigmatism_d / h;
      EXPECT_NEAR(across / along, 2, 0.02) << y;
    }
    const double through =
        (through_lens(evaluator, 0, y - h).mean_d - through_lens(evaluator, 0, y + h).mean_d) / (2 * h);
    // Thickness magnifies the front's growth (1 / (1 - t F1 / n)^2) and stretches its scale (1 + t / R), by 1
    // to 2 % each.
    EXPECT_NEAR(through, along, 0.05 * along) << y;
    // Through the lens a little astigmatism stands on the line itself: the growth on both sides, from
    // opposite axes.
    const double sideways =
        (through_lens(evaluator, h, y).astigmatism_d + through_lens(evaluator, -h, y).astigmatism_d) /
        (2 * h);
    EXPECT_NEAR(sideways / through, 2, 0.05) << y;
  }
}

}  // namespace
}  // namespace catoptra::optics

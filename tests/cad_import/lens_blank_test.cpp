// Lenses to order, judged by rays through their exact surfaces, by closed forms and by the reader of files.
#include "cad_import/lens_blank.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include "cad_import/import.h"
#include "tests/cad_import/lens_rays.h"
#include "tests/cad_import/mesh_files.h"

namespace catoptra::cad_import {
namespace {

using test::measure;
using test::MeasuredLens;
using test::MeasuredPower;

/// What the issue asks of powers and prisms.
constexpr double kPower_d = 0.01;
constexpr double kPrism_d = 0.02;

std::string told(const LensBlank& b) {
  std::ostringstream text;
  text << b.sphere_d << " / " << b.cylinder_d << " x " << b.axis_deg << ", prism " << b.prism_d << " base "
       << b.prism_base_deg << ", index " << b.index;
  return text.str();
}

/// Largest entry of measured minus prescribed power matrix (Thibos et al. 1997: S + C sin^2 A, ...).
double power_error_d(const MeasuredPower& measured, const LensBlank& blank) {
  const double a = blank.axis_deg * std::numbers::pi / 180, s = std::sin(a), c = std::cos(a);
  const double wanted[2][2] = {{blank.sphere_d + blank.cylinder_d * s * s, -blank.cylinder_d * s * c},
                               {-blank.cylinder_d * s * c, blank.sphere_d + blank.cylinder_d * c * c}};
  double worst = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) worst = std::max(worst, std::abs(measured.power_d[i][j] - wanted[i][j]));
  return worst;
}

double prism_error_d(const MeasuredPower& measured, const LensBlank& blank) {
  const double base = blank.prism_base_deg * std::numbers::pi / 180;
  return glm::length(measured.prism_d - blank.prism_d * glm::dvec2(std::cos(base), std::sin(base)));
}

/// 15 spheres from -20 to +15 D, each with 14 combinations of cylinder, axis, prism, base and index.
std::vector<LensBlank> prescriptions() {
  std::vector<LensBlank> all;
  const double cylinders[]{0, -0.5, -1.25, -2, -4, 1.5, 3};
  const double indices[]{1.5, 1.6, 1.67, 1.74};
  for (int i = 0; i < 15; ++i)
    for (int k = 0; k < 14; ++k) {
      LensBlank blank;
      blank.sphere_d = -20 + 2.5 * i;
      blank.cylinder_d = cylinders[k % 7];
      blank.axis_deg = std::fmod(37.0 * k + 11 * i, 180);
      blank.prism_d = k < 7 ? 0 : 0.75 * (k - 6);
      blank.prism_base_deg = std::fmod(80.0 * k + 25 * i, 360);
      blank.index = indices[(i + k) % 4];
      blank.diameter_mm = std::abs(blank.sphere_d) > 10 ? 40 : 60;
      all.push_back(blank);
    }
  return all;
}

TEST(LensPower, TwoHundredPrescriptionsMeasureAsOrdered) {
  double worst_power = 0, worst_prism = 0;
  for (const LensBlank& blank : prescriptions()) {
    const LensShape shape(blank);
    const CadModel model = lens_model(shape);
    const MeasuredPower measured = measure(MeasuredLens(model, blank.index));
    const double power = power_error_d(measured, blank), prism = prism_error_d(measured, blank);
    EXPECT_LT(power, kPower_d) << told(blank);
    EXPECT_LT(prism, kPrism_d) << told(blank);
    EXPECT_NEAR(test::face_called(model, "front").surface->point(0, 0).z, 0, 1e-7) << told(blank);
    EXPECT_NEAR(test::face_called(model, "back").surface->point(0, 0).z, -shape.report().center_thickness_mm,
                1e-7)
        << told(blank);
    worst_power = std::max(worst_power, power);
    worst_prism = std::max(worst_prism, prism);
  }
  RecordProperty("worst_power_d", std::to_string(worst_power));
  RecordProperty("worst_prism_d", std::to_string(worst_prism));
  std::printf("worst power error %.2g D, worst prism error %.2g\n", worst_power, worst_prism);
}

LensBlank ordered(double sphere, double cylinder, double axis) {
  LensBlank blank;
  blank.sphere_d = sphere;
  blank.cylinder_d = cylinder;
  blank.axis_deg = axis;
  blank.diameter_mm = 54;
  return blank;
}

/// One of each kind, with prisms and additions.
std::vector<LensBlank> every_kind() {
  std::vector<LensBlank> all{ordered(-2, 0, 0),  ordered(-6, -2.5, 140), ordered(0, 0, 0),
                             ordered(4, -1, 15), ordered(7.5, 2, 95),    ordered(-12, 0, 0),
                             ordered(1, -4, 60)};
  all[1].prism_d = 3;
  all[1].prism_base_deg = 270;
  all[3].outline = {{-25, -18}, {22, -20}, {27, 4}, {15, 18}, {-20, 16}};
  all[4].center_thickness_mm = 9;
  LensBlank conic = ordered(6, 0, 0);
  conic.front = LensFrontForm::conic;
  conic.conic = -1;
  conic.edge_thickness_mm = 0.8;
  LensBlank asphere = ordered(5, -0.75, 10);
  asphere.front = LensFrontForm::asphere;
  asphere.conic = -0.5;
  asphere.asphere_mm = {-2e-7, 1e-11};
  LensBlank atoric = ordered(-5, -3, 75);
  atoric.back_conic = -0.8;
  LensBlank progressive = ordered(1.5, -0.5, 20);
  progressive.front = LensFrontForm::freeform;
  progressive.addition_d = 2.25;
  progressive.prism_d = 1;
  progressive.prism_base_deg = 180;
  for (const LensBlank& blank : {conic, asphere, atoric, progressive}) all.push_back(blank);
  return all;
}

TEST(LensFile, EveryKindReadsBackAsOrdered) {
  const ScratchFolder folder;
  for (const LensBlank& blank : every_kind()) {
    const LensShape shape(blank);
    write_lens(shape, folder / "lens.step");
    const CadModel model = import_cad(folder / "lens.step");
    ASSERT_EQ(model.bodies.size(), 1u);
    EXPECT_TRUE(model.bodies[0].solid);
    EXPECT_EQ(model.unit, "mm");
    EXPECT_TRUE(model.warnings.empty());
    std::set<std::string> names;
    for (const Face& face : model.faces) names.insert(face.name);
    EXPECT_EQ(names, (std::set<std::string>{"front", "back", "rim"}));
    EXPECT_EQ(model.faces.size(), 2 + (blank.outline.empty() ? 4 : blank.outline.size()));
    const MeasuredPower measured = measure(MeasuredLens(model, blank.index));
    EXPECT_LT(power_error_d(measured, blank), kPower_d) << told(blank);
    EXPECT_LT(prism_error_d(measured, blank), kPrism_d) << told(blank);
    EXPECT_GT(test::face_called(model, "front").surface->unit_normal(0, 0).z, 0.99);
    EXPECT_LT(test::face_called(model, "back").surface->unit_normal(0, 0).z, -0.9);
  }
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1) << "no temporary file is left";
}

/// Height and curvature of the faces against the ideal surfaces, over the whole aperture.
TEST(LensModel, SurfacesFollowTheIdealOnesToTheirCurvature) {
  constexpr double kHeight_mm = 1e-7;  // lens_model's promise
  constexpr double kCurvature = 2e-6;  // 1/mm: 0.002 D at an index of 2
  constexpr double kStep_mm = 0.05;    // of the differences: rounding 1e-10, truncation 1e-7 / mm
  for (const LensBlank& blank : every_kind()) {
    const LensShape shape(blank);
    const CadModel model = lens_model(shape);
    for (const char* name : {"front", "back"}) {
      const Face& face = test::face_called(model, name);
      const auto z = [&](double x, double y) {
        return name == std::string("front") ? shape.front_z_mm(x, y) : shape.back_z_mm(x, y);
      };
      for (int i = -20; i <= 20; ++i)
        for (int k = -20; k <= 20; ++k) {
          const double x = 1.31 * i, y = 1.31 * k;
          if (std::hypot(x, y) > 26.5 || !face.trim->contains(x, y)) continue;
          const SurfaceDerivatives s = face.surface->d2(x, y);
          ASSERT_NEAR(s.point.z, z(x, y), kHeight_mm)
              << told(blank) << ", " << name << " at " << x << " " << y;
          const double h = kStep_mm;
          const double bend = (z(x + h, y) - 2 * z(x, y) + z(x - h, y)) / (h * h);
          ASSERT_NEAR(s.duu.z, bend, kCurvature) << told(blank) << ", " << name << " at " << x << " " << y;
        }
    }
  }
}

TEST(LensShape, ThickLensFormulaGivesTheBack) {
  // F1 = +6, F2 = -10, n = 1.5, t = 2 mm: F'v = 6 / (1 - 0.002 / 1.5 * 6) - 10.
  LensBlank blank = ordered(6 / (1 - 0.002 / 1.5 * 6) - 10, 0, 0);
  blank.front_curve_d = 6;
  blank.center_thickness_mm = 2;
  const LensBlankReport report = LensShape(blank).report();
  EXPECT_NEAR(report.front_radius_mm, 500.0 / 6, 1e-9);
  EXPECT_NEAR(report.back_radius1_mm, 50, 1e-9);
  EXPECT_NEAR(report.back_radius2_mm, 50, 1e-9);
  EXPECT_NEAR(report.center_thickness_mm, 2, 0);
  // Sphere sags at the rim, r = 27.
  const auto sag = [](double radius) { return radius - std::sqrt(radius * radius - 27 * 27); };
  EXPECT_NEAR(report.edge_thickness_min_mm, 2 - sag(500.0 / 6) + sag(50), 1e-9);
  EXPECT_NEAR(report.edge_thickness_max_mm, report.edge_thickness_min_mm, 1e-9);
}

TEST(LensShape, ConicAndAsphericFrontsFollowTheirFormulas) {
  LensBlank blank = ordered(3, 0, 0);
  blank.front = LensFrontForm::conic;
  blank.conic = -1;
  blank.front_curve_d = 8;
  const double r = 62.5;                                                     // 500 / 8
  EXPECT_NEAR(LensShape(blank).front_z_mm(12, -16), -400 / (2 * r), 1e-12);  // a paraboloid
  blank.front = LensFrontForm::asphere;
  blank.asphere_mm = {3e-7, -2e-10};
  EXPECT_NEAR(LensShape(blank).front_z_mm(12, -16), -400 / (2 * r) - 3e-7 * 160000 + 2e-10 * 64000000, 1e-12);
}

TEST(LensShape, BaseOfThePrismIsThick) {
  LensBlank blank = ordered(0, 0, 0);
  blank.prism_d = 4;
  blank.prism_base_deg = 90;
  const LensShape shape(blank);
  const auto thickness = [&](double y) { return shape.front_z_mm(0, y) - shape.back_z_mm(0, y); };
  // A thin prism of 4 at n = 1.5 has an apex slope of 0.04 / 0.5.
  EXPECT_NEAR((thickness(20) - thickness(-20)) / 40, 0.08, 0.006);
  EXPECT_NEAR(shape.report().edge_thickness_min_mm, 1, 1e-6) << "the default edge";
}

TEST(LensShape, ThicknessIsTheOneAskedForElseSensible) {
  LensBlank plus = ordered(6, -2, 30);
  EXPECT_NEAR(LensShape(plus).report().edge_thickness_min_mm, 1, 1e-6);
  plus.edge_thickness_mm = 1.7;
  EXPECT_NEAR(LensShape(plus).report().edge_thickness_min_mm, 1.7, 1e-6);
  EXPECT_EQ(LensShape(ordered(-6, 0, 0)).report().center_thickness_mm, 2);
  LensBlank thin = ordered(-6, 0, 0);
  thin.index = 1.67;
  EXPECT_EQ(LensShape(thin).report().center_thickness_mm, 1.5);
}

/// Mean curvature of the front and half the difference of its principal curvatures, in dioptre of front
/// power.
struct FrontPower {
  double mean_d, astigmatism_d;
};
FrontPower front_power(const Face& front, double x, double y, double index) {
  const PrincipalCurvatures k = front.surface->principal_curvatures(x, y);
  return {500 * (index - 1) * (k.k1 + k.k2), 1000 * (index - 1) * (k.k1 - k.k2)};
}

TEST(Progressive, AdditionIsReachedAlongAnUmbilicalMeridian) {
  LensBlank blank = ordered(1, 0, 0);
  blank.front = LensFrontForm::freeform;
  blank.addition_d = 2;
  blank.front_curve_d = 6;
  const CadModel model = lens_model(LensShape(blank));
  const Face& front = test::face_called(model, "front");
  constexpr double kCurve_d = 0.002;  // what the spline's second derivatives allow
  for (const double y : {20.0, 8.0, 0.0}) {
    EXPECT_NEAR(front_power(front, 0, y, 1.5).mean_d, 6, kCurve_d) << y;
    EXPECT_LT(front_power(front, 0, y, 1.5).astigmatism_d, 2 * kCurve_d) << y;
  }
  double before = 6;
  for (double y = -0.5; y > -14; y -= 0.5) {
    const FrontPower power = front_power(front, 0, y, 1.5);
    EXPECT_GT(power.mean_d, before - kCurve_d) << y;
    EXPECT_LT(power.astigmatism_d, 2 * kCurve_d) << "an umbilical line, at " << y;
    before = power.mean_d;
  }
  for (const double y : {-14.5, -18.0, -24.0})
    EXPECT_NEAR(front_power(front, 0, y, 1.5).mean_d, 8, kCurve_d) << y;
  // Minkwitz: across the corridor the astigmatism grows twice as fast as the mean power along it.
  const double along = (front_power(front, 0, -6.5, 1.5).mean_d - front_power(front, 0, -7.5, 1.5).mean_d);
  const double across = front_power(front, 1, -7, 1.5).astigmatism_d;
  EXPECT_NEAR(across, 2 * std::abs(along), 0.05 * across);
}

TEST(Progressive, SecondDifferencesHaveNoJump) {
  LensBlank blank = ordered(0, 0, 0);
  blank.front = LensFrontForm::freeform;
  blank.addition_d = 3;
  blank.front_curve_d = 5;
  const LensShape shape(blank);
  const CadModel model = lens_model(shape);
  const Face& front = test::face_called(model, "front");
  // Near the corridor z = sphere + (growth of curvature) x^2 / 2 with a growth of 3 D, 0.006 / mm, times a
  // step over 14 mm whose first derivative is at most 2.46 and whose third at most 78.75. The slope of the
  // sphere adds less than as much again.
  const auto steepest = [](double x) { return 2 * 0.006 * (2.46 / 14 + x * x / 2 * 78.75 / (14 * 14 * 14)); };
  constexpr double kStep_mm = 0.1;
  for (const double x : {0.0, 5.0, 15.0, -20.0}) {
    double before = 0;
    for (double y = -20; y <= 20; y += kStep_mm) {
      const double h = kStep_mm;
      const auto z = [&](double at) { return front.surface->point(x, at).z; };
      const double bend = (z(y + h) - 2 * z(y) + z(y - h)) / (h * h);
      if (y > -20) {
        ASSERT_LT(std::abs(bend - before), steepest(x) * h) << x << " " << y;
      }
      before = bend;
    }
  }
}

TEST(Progressive, RaysThroughTheNearZoneGainTheAddition) {
  LensBlank single = ordered(0, 0, 0), progressive;
  single.front = LensFrontForm::freeform;
  single.front_curve_d = 6;
  single.center_thickness_mm = 2.5;
  progressive = single;
  progressive.addition_d = 2;
  const auto mean_power = [](const LensBlank& blank, double y) {
    const CadModel model = lens_model(LensShape(blank));
    const MeasuredPower p = measure(MeasuredLens(model, blank.index), 0, y);
    return 0.5 * (p.power_d[0][0] + p.power_d[1][1]);
  };
  // Oblique rays through a thick lens: both the obliquity and the shape factor are within some percent of 1.
  EXPECT_NEAR(mean_power(progressive, -17) - mean_power(single, -17), 2, 0.25);
  EXPECT_NEAR(mean_power(progressive, 10) - mean_power(single, 10), 0, 0.01);
}

std::string message_of(const LensBlank& blank) {
  try {
    const LensShape shape(blank);
    return "no error; " + std::to_string(shape.report().edge_thickness_min_mm);
  } catch (const Error& error) {
    return error.what();
  }
}

template <typename Change>
std::string message_after(Change change) {
  LensBlank blank = ordered(-2, -1, 30);
  change(blank);
  const std::string message = message_of(blank);
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_EQ(message.rfind("lens: ", 0), 0u) << message;
  return message;
}

void expect_part(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message << " should say: " << part;
}

TEST(LensErrors, NameTheValueAtFault) {
  expect_part(message_after([](LensBlank& b) { b.index = 1; }), "index: 1 is not above 1");
  expect_part(message_after([](LensBlank& b) { b.index = NAN; }), "index");
  expect_part(message_after([](LensBlank& b) { b.center_thickness_mm = 0; }), "center thickness: 0 mm");
  expect_part(message_after([](LensBlank& b) { b.center_thickness_mm = -1; }), "center thickness: -1 mm");
  expect_part(message_after([](LensBlank& b) { b.edge_thickness_mm = -2; }), "edge thickness: -2 mm");
  expect_part(message_after([](LensBlank& b) { b.edge_thickness_mm = 0.5; }), "edge thickness: 0.5 mm");
  expect_part(message_after([](LensBlank& b) {
                b.edge_thickness_mm = 1;
                b.center_thickness_mm = 1;
              }),
              "exclude each other");
  expect_part(message_after([](LensBlank& b) { b.axis_deg = 181; }), "axis: 181");
  expect_part(message_after([](LensBlank& b) { b.axis_deg = -5; }), "axis: -5");
  expect_part(message_after([](LensBlank& b) { b.cylinder_d = INFINITY; }), "cylinder");
  expect_part(message_after([](LensBlank& b) { b.prism_d = -1; }), "prism: -1");
  expect_part(message_after([](LensBlank& b) { b.prism_base_deg = 400; }), "prism base: 400");
  expect_part(message_after([](LensBlank& b) { b.addition_d = 2; }), "addition: 2 D");
  expect_part(message_after([](LensBlank& b) { b.conic = -1; }), "conic");
  expect_part(message_after([](LensBlank& b) { b.asphere_mm = {1e-7}; }), "asphere");
  expect_part(message_after([](LensBlank& b) { b.diameter_mm = 0; }), "diameter: 0 mm");
  expect_part(message_after([](LensBlank& b) { b.front_curve_d = 19; }),
              "front curve: its radius of 26.3158 mm");
  expect_part(message_after([](LensBlank& b) { b.sphere_d = -40; }), "back curve: its radius of ");
  expect_part(message_after([](LensBlank& b) {
                b.sphere_d = 6;
                b.center_thickness_mm = 2;
              }),
              "center thickness: 2 mm lets front and back cross");
  expect_part(message_after([](LensBlank& b) { b.outline = {{0, 0}, {1, 1}}; }), "outline");
  expect_part(message_after([](LensBlank& b) { b.outline = {{10, 0}, {20, 0}, {15, 10}}; }), "axis (0, 0)");
}

TEST(LensErrors, UnwritableFileIsTold) {
  EXPECT_THROW(write_lens(LensShape(ordered(0, 0, 0)), "/nonexistent-folder/lens.step"), Error);
}

}  // namespace
}  // namespace catoptra::cad_import

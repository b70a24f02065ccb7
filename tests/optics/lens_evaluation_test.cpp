// Lenses measured, against published designs and worked examples.
#include "optics/lens_evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/support/analytic_lens.h"

namespace catoptra::optics {
namespace {

// A lens of spherical surfaces by their powers as the trade gives them, front vertex at the origin.
struct Design {
  double index, front_d, back_d, thickness_mm;
};

Optic lens_of(const Design& d) {
  const auto radius = [&](double power) { return power == 0 ? 0 : 1000 * (d.index - 1) / power; };
  Optic lens = test::spherical_lens(radius(d.front_d), -radius(d.back_d), d.thickness_mm, 60, 41);
  lens.medium = constant_medium(d.index);
  return lens;
}

LensFrame frame_of(double thickness_mm) {
  return {.front_vertex_mm = {0, 0, 0}, .back_vertex_mm = {0, 0, -thickness_mm}};
}

// Light from infinity, powers on the vertex sphere, rotation centre 27 mm behind the back vertex; traced
// elsewhere in double precision, to the digits given.
struct Golden {
  const char* name;
  Design design;
  double back_vertex_power_d;
  double tangential_d[3], sagittal_d[3], object_deg[3];  ///< at gaze angles of 15, 30 and 40 degrees
};
constexpr Golden kGoldens[] = {{"G1",
                                {1.5, 6, -10, 2},
                                -3.9516,
                                {-3.89557, -3.67411, -3.35855},
                                {-3.90794, -3.76332, -3.59269},
                                {16.50120, 33.20467, 44.55037}},
                               {"G2",
                                {1.5, 10, -5.5, 6},
                                4.9167,
                                {4.87847, 4.71469, 4.46335},
                                {4.85828, 4.67072, 4.45907},
                                {12.45187, 24.69377, 32.65836}}};

TEST(LensEvaluator, VertexSpherePowersOfARotatingEye) {
  for (const Golden& golden : kGoldens) {
    const Optic lens = lens_of(golden.design);
    const LensEvaluator evaluator(lens, frame_of(golden.design.thickness_mm));
    EvaluationOptions options;
    options.mode = EvaluationMode::as_worn;
    options.position.rotation_centre_mm = 27;
    const double gaze_deg[3] = {15, 30, 40};
    for (const double meridian : {0.0, 0.7, 2.5, 4.0})
      for (int k = 0; k < 3; ++k) {
        const double tangent = std::tan(glm::radians(gaze_deg[k]));
        const glm::dvec2 gaze{std::atan(tangent * std::cos(meridian)),
                              std::atan(tangent * std::sin(meridian))};
        const auto result = evaluator.at_gaze(std::span(&gaze, 1), options);
        EXPECT_NEAR(result.reference.sphere_d, golden.back_vertex_power_d, 0.5e-4) << golden.name;
        EXPECT_EQ(result.reference.cylinder_d, 0);
        const LensPoint& point = result.points[0];
        ASSERT_EQ(point.end, LensPathEnd::passed);
        EXPECT_NEAR(point.tangential_d, golden.tangential_d[k], 0.6e-5) << golden.name;
        EXPECT_NEAR(point.sagittal_d, golden.sagittal_d[k], 0.6e-5) << golden.name;
        const double object =
            std::atan(std::hypot(std::tan(point.object_rad.x), std::tan(point.object_rad.y)));
        EXPECT_NEAR(glm::degrees(object), golden.object_deg[k], 0.6e-5) << golden.name;
        EXPECT_NEAR(point.oblique_astigmatism_d, point.tangential_d - point.sagittal_d, 1e-10);
        EXPECT_NEAR(point.mean_power_error_d,
                    0.5 * (point.tangential_d + point.sagittal_d) - result.reference.sphere_d, 1e-10);
      }
  }
}

}  // namespace
}  // namespace catoptra::optics

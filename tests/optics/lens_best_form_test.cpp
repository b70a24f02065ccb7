// The best front curve of spherical lenses: where the eye turned by 30 degrees meets no astigmatism, no
// tangential error or no mean power error (Tscherning's ellipse and its kin).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/trigonometric.hpp>

#include "optics/lens_evaluation.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::optics {
namespace {

// n 1.5, rotation centre 25 mm, distance vision, centre thickness 2 mm (minus) or 2 + 0.8 F (plus); by an
// exact scan made elsewhere.
struct BestForm {
  double power_d;
  double point_focal_d, tangential_d, mean_d;  ///< front curves
};
constexpr BestForm kTable[] = {{-8, 3.05, 2.21, 1.83}, {-6, 4.10, 3.12, 2.68}, {-4, 5.38, 4.23, 3.72},
                               {-2, 7.30, 5.76, 5.12}, {2, 7.87, 6.79, 6.30},  {4, 9.78, 8.40, 7.82},
                               {6, 12.09, 10.10, 9.41}};

LensPoint at_thirty_degrees(double power_d, double front_d) {
  const double n = 1.5, thickness_mm = power_d < 0 ? 2 : 2 + 0.8 * power_d;
  const double back_d = power_d - front_d / (1 - 0.001 * thickness_mm / n * front_d);
  const Optic lens =
      test::spherical_lens(1000 * (n - 1) / front_d, -1000 * (n - 1) / back_d, thickness_mm, 50, 31);
  EvaluationOptions options;
  options.mode = EvaluationMode::as_worn;
  options.chromatic = false;
  options.position.rotation_centre_mm = 25;
  const glm::dvec2 gaze{0, glm::radians(30.0)};
  const auto result =
      LensEvaluator(lens, {.back_vertex_mm = {0, 0, -thickness_mm}}).at_gaze(std::span(&gaze, 1), options);
  EXPECT_NEAR(result.reference.sphere_d, power_d, 1e-10);
  EXPECT_EQ(result.points[0].end, LensPathEnd::passed);
  return result.points[0];
}

// The front curve near `start_d` where `error` is nothing.
double front_curve(double power_d, double start_d, const std::function<double(const LensPoint&)>& error) {
  double low = start_d - 0.3, high = start_d + 0.3;
  const auto at = [&](double front_d) { return error(at_thirty_degrees(power_d, front_d)); };
  const double at_low = at(low);
  EXPECT_LT(at_low * at(high), 0) << "no change of sign near " << start_d;
  while (high - low > 1e-4) {
    const double middle = 0.5 * (low + high);
    (at_low * at(middle) > 0 ? low : high) = middle;
  }
  return low;
}

TEST(BestForm, FrontCurvesOfTheTable) {
  for (const BestForm& row : kTable) {
    const double power = row.power_d;
    EXPECT_NEAR(
        front_curve(power, row.point_focal_d, [](const LensPoint& p) { return p.oblique_astigmatism_d; }),
        row.point_focal_d, 0.05)
        << power;
    EXPECT_NEAR(
        front_curve(power, row.tangential_d, [&](const LensPoint& p) { return p.tangential_d - power; }),
        row.tangential_d, 0.05)
        << power;
    EXPECT_NEAR(front_curve(power, row.mean_d, [](const LensPoint& p) { return p.mean_power_error_d; }),
                row.mean_d, 0.05)
        << power;
  }
}

}  // namespace
}  // namespace catoptra::optics

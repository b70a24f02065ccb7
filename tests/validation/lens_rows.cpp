// Rows about measured lenses.
#include <cmath>
#include <glm/trigonometric.hpp>
#include <span>

#include "optics/lens_evaluation.h"
#include "tests/support/analytic_lens.h"
#include "tests/validation/table.h"

namespace catoptra::validation {
namespace {

/// What the eye meets that looks `gaze_deg` up through a lens of these powers.
optics::LensEvaluation worn(double front_d, double back_d, double thickness_mm, double index, double gaze_deg,
                            double rotation_centre_mm) {
  const optics::Optic lens = [&] {
    auto made = test::spherical_lens(1000 * (index - 1) / front_d, -1000 * (index - 1) / back_d, thickness_mm,
                                     60, 41);
    made.medium = optics::constant_medium(index);
    return made;
  }();
  optics::EvaluationOptions options;
  options.mode = optics::EvaluationMode::as_worn;
  options.position.rotation_centre_mm = rotation_centre_mm;
  const glm::dvec2 gaze(0, glm::radians(gaze_deg));
  return optics::LensEvaluator(lens, {.back_vertex_mm = {0, 0, -thickness_mm}})
      .at_gaze(std::span(&gaze, 1), options);
}

Row compared(const std::string& what, double expected, double computed, const std::string& unit) {
  return {what, number(expected, 6, unit), number(computed, 6, unit),
          below(std::abs(computed - expected), unit)};
}

}  // namespace

std::vector<Row> lens_rows() {
  // Powers traced elsewhere in double precision.
  const auto point = worn(6, -10, 2, 1.5, 30, 27).points[0];
  // Shape times power, h = 15 mm to the entrance pupil.
  const double n = 1.498, shape = 1 / (1 - 0.004 / n * 8), magnification = shape / (1 - 0.015 * 4);
  const double found = worn(8, 4 - 8 * shape, 4, n, 0, 25).spectacle_magnification;
  return {
      compared("Lens of n 1.5, +6 and -10 D, 2 mm thick, gaze 30°: tangential power on the vertex sphere",
               -3.67411, point.tangential_d, "D"),
      compared("... sagittal power", -3.76332, point.sagittal_d, "D"),
      compared("Lens of +4 D, front +8 D, 4 mm thick: spectacle magnification", magnification, found, "")};
}

}  // namespace catoptra::validation

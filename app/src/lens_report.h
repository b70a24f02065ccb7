// What `lens evaluate` finds out about one lens, as values: the text, JSON, CSV and HTML writers and the
// batch share it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/src/lens_limits.h"
#include "app/src/lens_source.h"
#include "optics/lens_evaluation.h"

namespace catoptra::app {

/// Where the addition is measured, by the focimeter.
struct AdditionPoints {
  glm::dvec2 distance_mm{0}, near_mm{0, -14};  ///< x, y in the lens's frame, on the side measured
  bool on_front = true;  ///< the front against the support (additions of the front surface), else the back
};

struct LensReportOptions {
  optics::EvaluationOptions evaluation;
  optics::CylinderForm cylinder = optics::CylinderForm::minus;
  std::vector<glm::dvec2> gaze_rad;   ///< where to measure, as optics::LensPoint::gaze_rad
  std::vector<glm::dvec2> points_mm;  ///< and at points of the back surface
  bool drop_missed = false;  ///< of points_mm, leave out those that are not on the lens (maps over it)
  std::optional<AdditionPoints> addition;
  std::optional<RuleFile> rule;  ///< kind "lens"
  std::optional<LensOrder> order;
};

struct LensReportPoint {
  optics::LensPoint measured;
  bool asked_by_gaze = true;     ///< else by its place on the back; missed points know only what was asked
  optics::SphereCylinder power;  ///< of `measured`, in the form asked for
  double base_out = 0;           ///< prism dioptre, for the eye of the position; negative: base in
};

struct LensAddition {
  AdditionPoints at;
  optics::SphereCylinder distance, near;  ///< vertex powers of the side measured, in the form asked for
  double addition_d = 0;                  ///< difference of their mean powers
};

struct LensReport {
  std::string lens, material;
  bool material_unverified = false;  ///< its figures are trade knowledge without a document
  double index = 1, index_around = 1;
  bool dispersion = true;  ///< false: one index at all wavelengths; transverse colour is 0 by that
  LensReportOptions options;

  double center_thickness_mm = 0;
  /// True powers (n - 1)/R of both principal sections at the vertices, larger first; positive: convex from
  /// outside.
  glm::dvec2 front_curve_d{0}, back_curve_d{0};

  optics::SphereCylinder reference;  ///< by the focimeter at the back vertex, in the form asked for
  glm::dvec2 reference_prism{0};     ///< prism dioptre, base towards +x and up
  double spectacle_magnification = 1;
  std::vector<LensReportPoint> points;  ///< at gaze_rad, then at points_mm, in their order

  std::optional<LensAddition> addition;
  std::optional<LensVerdict> verdict;  ///< where rule and order were given
  std::vector<InputFile> inputs;       ///< left empty by lens_report()
  std::vector<std::string> warnings;
};

/// Measures `lens`, whose frame is `frame`. Throws catoptra::Error for options out of range and where a
/// reference point does not transmit.
[[nodiscard]] LensReport lens_report(const optics::Optic& lens, const optics::LensFrame& frame,
                                     const LensReportOptions& options);

/// The same with the inputs and warnings of its source.
[[nodiscard]] LensReport lens_report(const LensSource& source, const LensReportOptions& options);

/// The square grid of points, `step_mm` apart and through the back vertex, over the lens's width and height.
/// Throws catoptra::Error beyond 4 million of them.
[[nodiscard]] std::vector<glm::dvec2> lens_map_points(const optics::Optic& lens,
                                                      const optics::LensFrame& frame, double step_mm);

/// Size and direction (TABO, radians, 0 <= base < 2 pi; 0 where there is none) of a prism.
struct PrismBase {
  double prism = 0, base_rad = 0;
};
[[nodiscard]] PrismBase prism_base(const glm::dvec2& prism);

/// "passed", "total_reflection", "rim", "missed"
[[nodiscard]] std::string_view path_end_name(optics::LensPathEnd end);

}  // namespace catoptra::app

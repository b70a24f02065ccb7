// What `catoptra lens evaluate` was asked for, as the command line has it, and checked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/src/lens_report.h"
#include "app/src/lens_source.h"

namespace catoptra::app {

/// Angles in degrees, lengths in mm, powers in D. Empty and nullopt: not given.
struct LensEvaluateOptions {
  std::string file, lens, material, catalogue, unit;
  std::optional<double> index, abbe;
  std::vector<std::string> front_faces, back_faces;
  std::string up;

  std::string mode = "lensmeter", eye = "right", cylinder = "minus", object_distance = "infinity";
  double rotation_centre = 25, vertex_distance = 12, panto = 0, wrap = 0;
  std::optional<double> gaze_max, gaze_step, map_step, wavelength;
  std::vector<std::string> gaze, points;
  std::string distance_point, near_point, addition_side = "front";
  int threads = 0;

  std::string rule, lens_type;
  std::optional<double> sphere, cyl, axis, prism, base, add, front_curve, thickness;
  bool strict = false;

  std::string json, csv, html;
};

/// Where the lens comes from. Throws UsageError for options that are wrong or do not go together.
[[nodiscard]] LensSourceOptions source_options(const LensEvaluateOptions& options);

/// What is measured, and judged by which rule; what depends on the lens (map, reference line) is left open.
/// Throws UsageError, and catoptra::Error for a rule file that cannot be read.
[[nodiscard]] LensReportOptions report_options(const LensEvaluateOptions& options);

}  // namespace catoptra::app

// Real lenses through `catoptra lens evaluate`, against what the CAD kernel measured on their faces.
// lens_corpus_check FILE KIND measures one; without argument it says that there is no corpus.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/app/command_runner.h"

namespace {

using nlohmann::json;

constexpr int kSkipped = 77;

/// What the kernel measured at the vertices, 1/mm and mm, and how well.
struct Known {
  std::optional<double> front_curvature;  ///< unknown: only their sum is
  double sum_of_curvatures, curvature_error;
  double thickness_mm;
  double cylinder_error_d;
};

/// The aspheric lens of a headset, surfaces of revolution; given to 1e-6. They meet in a pole on the axis.
constexpr Known kHeadset{0.042347, 0.042347 + 0.004176, 1e-6, 15.0, 0.003};
/// A plano lens with wavy sides that run parallel to 0.01 mm over 50: curvatures of opposite sign to 3.2e-5.
/// 0.01 D is a tenth of what any standard tolerates.
constexpr Known kPlano{std::nullopt, 0, 1.6e-5, 2.002, 0.01};

constexpr double kIndex = 1.498;

int wrong = 0;

void expect(double found, double known, double error, const char* what) {
  const bool good = std::abs(found - known) <= error;  // not-a-number is no pass
  std::printf("%s %s: %.6g, known %.6g within %g\n", good ? "  " : "x ", what, found, known, error);
  if (!good) ++wrong;
}

/// A focimeter looks along no line of sight, and has no distortion.
void check_finite(const json& points, bool as_worn) {
  std::size_t passed = 0;
  for (const json& point : points) {
    if (point.at("end") != "passed") continue;
    ++passed;
    for (const auto& [key, value] : point.items()) {
      if (key == "distortion" && !as_worn && value.is_null()) continue;
      if (key == "end" || (value.is_number() && std::isfinite(value.get<double>()))) continue;
      std::printf("x  %s is %s\n", key.c_str(), value.dump().c_str());
      ++wrong;
    }
  }
  if (passed * 2 < points.size()) {
    std::printf("x  only %zu of %zu points transmit\n", passed, points.size());
    ++wrong;
  }
}

double mean(const json& pair) {
  return 0.5 * (pair.at(0).get<double>() + pair.at(1).get<double>());
}

void check(const std::string& file, const Known& known) {
  for (const char* mode : {"lensmeter", "as-worn"}) {
    const auto result =
        catoptra::test::run_catoptra({"lens", "evaluate", file, "--material", "CR-39", "--mode", mode,
                                      "--gaze-max", "20", "--gaze-step", "5", "--json", "-"});
    if (result.code != 0) {
      std::printf("x  exit code %d: %s\n", result.code, result.errors.c_str());
      ++wrong;
      return;
    }
    const json report = json::parse(result.output);
    const double n = 1000 * (kIndex - 1);
    const double front = mean(report.at("front_curve_d")) / n, back = mean(report.at("back_curve_d")) / n;
    if (known.front_curvature)
      expect(front, *known.front_curvature, known.curvature_error, "front curvature, 1/mm");
    expect(front + back, known.sum_of_curvatures, 2 * known.curvature_error, "sum of curvatures, 1/mm");
    expect(report.at("center_thickness_mm").get<double>(), known.thickness_mm, 1e-3, "thickness, mm");
    // The thick lens of these curvatures. A curvature wrong by e makes a power wrong by n e and, through 15
    // mm, by some more.
    const json& reference = report.at("reference");
    const double f1 = n * known.front_curvature.value_or(front), f2 = n * known.sum_of_curvatures - f1;
    const double sphere = reference.at("sphere_d").get<double>(),
                 cylinder = reference.at("cylinder_d").get<double>();
    expect(sphere + 0.5 * cylinder, f1 / (1 - 0.001 * known.thickness_mm / kIndex * f1) + f2,
           4 * n * known.curvature_error, "back vertex power, D");
    expect(cylinder, 0, known.cylinder_error_d, "cylinder, D");
    check_finite(report.at("points"), std::string_view(mode) == "as-worn");
  }
}

/// A frame holds no lens: one line, and no report.
void check_frame(const std::string& file) {
  const auto result = catoptra::test::run_catoptra({"lens", "evaluate", file, "--material", "CR-39"});
  if (result.code == 1 && result.output.empty() && result.errors.find('\n') == result.errors.size() - 1)
    return;
  std::printf("x  exit code %d: %s%s\n", result.code, result.output.c_str(), result.errors.c_str());
  ++wrong;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::printf("CATOPTRA_CORPUS is not set: no lens of the corpus was measured\n");
    return kSkipped;
  }
  const std::string file = argv[1], kind = argv[2];
  if (kind == "frame")
    check_frame(file);
  else
    check(file, kind == "headset" ? kHeadset : kPlano);
  return wrong == 0 ? 0 : 1;
}

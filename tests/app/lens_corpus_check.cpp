// Real lenses through `catoptra lens evaluate`, against what the CAD kernel measured on their faces.
// lens_corpus_check FILE KIND measures one; without argument it says that there is no corpus.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/app/command_runner.h"

namespace {

using nlohmann::json;

constexpr int kSkipped = 77;

/// What is known of a lens: vertex curvatures (1/mm, the mean of both sections) and thickness, and the back
/// vertex power that a thick lens of them has in CR-39.
struct Known {
  double front_curvature, back_curvature, thickness_mm;
  double curvature_error;  ///< of the figures, and what the surface's own unevenness adds
  double power_error_d;
};

/// A Fresnel-free aspheric lens of a headset: surfaces of revolution, curvatures to 1e-6.
constexpr Known kHeadset{0.042347, 0.004176, 15.0, 1e-6, 0.01};
/// A plano lens of wavy faces "parallel to 0.01": no power. Its own curvatures are not known to better than
/// their spread.
constexpr Known kPlano{0, 0, 2.002, 0.006, 0.05};

constexpr double kIndex = 1.498;

int wrong = 0;

void expect(double found, double known, double error, const char* what) {
  const bool good = std::abs(found - known) <= error;  // not-a-number is no pass
  std::printf("%s %s: %.6g, known %.6g within %g\n", good ? "  " : "x ", what, found, known, error);
  if (!good) ++wrong;
}

void check_finite(const json& points) {
  std::size_t passed = 0;
  for (const json& point : points) {
    if (point.at("end") != "passed") continue;
    ++passed;
    for (const auto& [key, value] : point.items()) {
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
    expect(mean(report.at("front_curve_d")) / n, known.front_curvature, known.curvature_error,
           "front curvature, 1/mm");
    expect(mean(report.at("back_curve_d")) / n, known.back_curvature, known.curvature_error,
           "back curvature, 1/mm");
    expect(report.at("center_thickness_mm").get<double>(), known.thickness_mm, 1e-3, "thickness, mm");
    const json& reference = report.at("reference");
    const double f1 = n * known.front_curvature, f2 = n * known.back_curvature;
    expect(reference.at("sphere_d").get<double>() + 0.5 * reference.at("cylinder_d").get<double>(),
           f1 / (1 - 0.001 * known.thickness_mm / kIndex * f1) + f2, known.power_error_d,
           "back vertex power, D");
    expect(reference.at("cylinder_d").get<double>(), 0, 0.02, "cylinder, D");
    check_finite(report.at("points"));
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

// Values of options that are wrong by themselves: told as wrong usage, with what is allowed.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "app/src/commands.h"
#include "app/src/nearest_name.h"
#include "cad_import/outline.h"

namespace catoptra::app {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

/// A validator that says `what` of a number that does not pass. What is no number at all is left to the
/// option's own conversion.
template <typename Passes>
CLI::Validator number_check(Passes passes, const std::string& what) {
  return CLI::Validator(
      [passes, what](std::string& text) -> std::string {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        if (end == text.c_str() || *end != '\0') return "'" + text + "' is not a number";
        return std::isfinite(value) && passes(value) ? std::string{} : text + " is not " + what;
      },
      "", "number");
}

}  // namespace

CLI::Validator finite() {
  return number_check([](double) { return true; }, "a finite number");
}

CLI::Validator between(double min, double max) {
  return number_check([min, max](double value) { return value >= min && value <= max; },
                      "between " + number(min) + " and " + number(max));
}

CLI::Validator above(double min) {
  return number_check([min](double value) { return value > min; }, "above " + number(min));
}

CLI::Validator at_least(double min) {
  return number_check([min](double value) { return value >= min; }, "at least " + number(min));
}

void check_step_path(const std::string& file) {
  std::string suffix = std::filesystem::path(file).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (suffix != ".step" && suffix != ".stp")
    throw UsageError("-o '" + file + "': solids are written as STEP", "choose the suffix .step or .stp");
}

std::vector<glm::dvec2> outline_corners(const std::string& file, const std::vector<std::string>& words) {
  const std::filesystem::path path(file);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored) && !path.has_parent_path() && !path.has_extension()) {
    const std::string nearest = nearest_name(file, words);
    throw UsageError(
        "--outline '" + file + "' is neither a file nor an outline of that name",
        (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") +
            (words.empty() ? "round lenses: --diameter D" : "outlines: " + list_of_names(words)) +
            "; or a file with one corner \"x y\" in mm per line");
  }
  return cad_import::read_outline(path);
}

}  // namespace catoptra::app

// A measured lens against what was ordered, by the tolerances of a standard.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/src/rule_file.h"
#include "optics/lens_power.h"

namespace catoptra::app {

/// kind = "lens"; docs/rules.md says what each quantity, variable and unit means.
[[nodiscard]] const RuleVocabulary& lens_rule_words();

enum class LensType { single_vision, multifocal, progressive };

/// "single vision", ...: the words of `applies_to`.
[[nodiscard]] std::string_view lens_type_name(LensType type);

/// What the lens should be. Angles in radians, TABO.
struct LensOrder {
  LensType type = LensType::single_vision;
  optics::SphereCylinder power;  ///< cylinder of either sign: verdicts are given in its form (none: minus)
  glm::dvec2 prism{0};           ///< prism dioptre, base towards +x and up
  double addition_d = 0;         ///< 0: none
  std::optional<double> front_curve_d, center_thickness_mm;  ///< not judged where absent
};

/// What the focimeter and the thickness gauge read.
struct LensReading {
  optics::SphereCylinder power;
  glm::dvec2 prism{0};
  std::optional<double> addition_d;
  double front_curve_d = 0;  ///< mean true power (n - 1)/R at the front vertex
  double center_thickness_mm = 0;
};

/// One tolerance and what became of it.
struct LensLimit {
  RuleFigure figure;
  std::string requirement;  ///< "cylinder within 0.12 D of -1.5 D"
  double ordered = 0, measured = 0;
  double deviation = 0;  ///< measured - ordered; of axes the smaller angle; of `prism` the distance, >= 0
  double limit = 0;      ///< on |deviation|
  std::string unit;      ///< of the four numbers
  bool pass = false;
};

/// A quantity of the rule without a verdict, and why.
struct NotJudged {
  std::string quantity, reason;
};

struct LensVerdict {
  std::vector<LensLimit> limits;
  std::vector<NotJudged> not_judged;
  /// Every limit holds; false where there is none.
  [[nodiscard]] bool passed() const;
  /// The least sure of the figures that were used; nullopt where there is none.
  [[nodiscard]] std::optional<Certainty> certainty() const;
};

/// Throws catoptra::Error where the rule contradicts itself.
[[nodiscard]] LensVerdict judge_lens(const RuleFile& rule, const LensOrder& order,
                                     const LensReading& reading);

}  // namespace catoptra::app

// The words of rule files about lenses.
#pragma once

#include "app/src/rule_file.h"

namespace catoptra::app {

/// kind = "lens"; docs/rules.md says what each quantity, variable and unit means.
[[nodiscard]] const RuleVocabulary& lens_rule_words();

}  // namespace catoptra::app

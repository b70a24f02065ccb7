// Cases that measure a lens.
#pragma once

#include "app/src/case_evaluator.h"

namespace catoptra::app {

/// The evaluator of all cases of this version.
[[nodiscard]] const CaseEvaluator& lens_case_evaluator();

}  // namespace catoptra::app

// The report on a mirror as an HTML page.
#pragma once

#include <string>

#include "app/scene_file.h"
#include "app/src/mirror_evaluation.h"

namespace catoptra::app {

/// `evaluation` is of `scene`, which is also drawn from its eye. Throws catoptra::Error.
[[nodiscard]] std::string mirror_page(const MirrorEvaluation& evaluation, const SceneFile& scene);

}  // namespace catoptra::app

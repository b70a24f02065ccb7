// The report on a lens as an HTML page.
#pragma once

#include <string>

#include "app/src/lens_report.h"

namespace catoptra::app {

/// `report` was measured on `source`, which is also drawn as its wearer sees through it. Throws
/// catoptra::Error.
[[nodiscard]] std::string lens_page(const LensReport& report, const LensSource& source);

}  // namespace catoptra::app

// The version of this build.
#pragma once

#include <string_view>

namespace catoptra::app {

/// "MAJOR.MINOR.PATCH", as CMake's project() has it.
[[nodiscard]] std::string_view version();

}  // namespace catoptra::app

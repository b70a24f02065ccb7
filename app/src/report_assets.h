// The parts of the HTML report that are files of their own, compiled into the program.
#pragma once

#include <string_view>

namespace catoptra::app {

/// Text of one file of app/report. Throws catoptra::Error where it is not part of the program.
[[nodiscard]] std::string_view report_asset(std::string_view name);

/// The plotting library (Plotly.js, MIT licence), minified, and its version.
[[nodiscard]] std::string_view plotly_source();
[[nodiscard]] std::string_view plotly_version();

}  // namespace catoptra::app

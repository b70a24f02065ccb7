// The report as one HTML page that works offline: data, plots and their program in a single file.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace catoptra::app {

/// What stands on a page. All entries are the JSON of the commands themselves (docs/reports.md).
struct HtmlPage {
  std::string title;
  std::string summary;  ///< a sentence under the title; may be empty
  nlohmann::ordered_json lenses =
      nlohmann::ordered_json::array();  ///< of `lens evaluate`; "picture" may be added
  nlohmann::ordered_json mirrors = nlohmann::ordered_json::array();  ///< of `mirror evaluate`
  nlohmann::ordered_json batch;                                      ///< of `batch report`; null: none
  nlohmann::ordered_json inputs = nlohmann::ordered_json::array();   ///< file and sha256
};

/// The page as text. The data stand in it as JSON, so that other programs find them; no text of a file or a
/// name becomes markup. The same page is the same bytes.
[[nodiscard]] std::string html_report(const HtmlPage& page);

/// The bytes as `data:` address, for pictures in a page.
[[nodiscard]] std::string data_address(std::string_view bytes, std::string_view media_type);

}  // namespace catoptra::app

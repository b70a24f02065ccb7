#include "app/src/html_report.h"

#include <cstdint>
#include <string_view>

#include "app/src/report.h"
#include "app/src/report_assets.h"

namespace catoptra::app {
namespace {

/// Inside <script>, "</" or "<!--" could end the data; in JSON both may be written with an escape.
std::string json_for_script(const nlohmann::ordered_json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

void replace_once(std::string& text, std::string_view mark, std::string_view by) {
  const std::size_t at = text.find(mark);
  if (at != std::string::npos) text.replace(at, mark.size(), by);
}

}  // namespace

std::string html_report(const HtmlPage& page) {
  nlohmann::ordered_json data{
      {"title", page.title}, {"summary", page.summary}, {"versions", versions_json()}};
  data["versions"]["plotly"] = plotly_version();
  data["inputs"] = page.inputs;
  if (!page.batch.is_null()) data["batch"] = page.batch;
  data["lenses"] = page.lenses;
  data["mirrors"] = page.mirrors;
  std::string text(report_asset("report.html.in"));
  std::string script;
  for (const std::string_view part : {"page.js", "lens.js", "mirror.js", "batch.js", "main.js"})
    script += report_asset(part);
  // Each mark stands once, before everything that is put in for a later one.
  replace_once(text, "{{css}}", report_asset("report.css"));
  const std::size_t data_at = text.find("{{data}}");
  const std::string head = text.substr(0, data_at), tail = text.substr(data_at);
  std::string rest = tail;
  replace_once(rest, "{{script}}", script);
  replace_once(rest, "{{plotly}}", plotly_source());
  replace_once(rest, "{{data}}", json_for_script(data));
  return head + rest;
}

std::string data_address(std::string_view bytes, std::string_view media_type) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";  // RFC 4648
  std::string text = "data:" + std::string(media_type) + ";base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group =
          group << 8 | (i + k < bytes.size() ? std::uint32_t(static_cast<unsigned char>(bytes[i + k])) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace catoptra::app

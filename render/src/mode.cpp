#include <array>
#include <utility>

#include "render/mode.h"

namespace catoptra::render {
namespace {

constexpr std::array<std::pair<Mode, std::string_view>, 6> kNames{{{Mode::pvrr, "pvrr"},
                                                                   {Mode::hybrid, "hybrid"},
                                                                   {Mode::exact, "exact"},
                                                                   {Mode::raytrace, "raytrace"},
                                                                   {Mode::cubemap, "cubemap"},
                                                                   {Mode::automatic, "auto"}}};

}  // namespace

std::string_view mode_name(Mode mode) {
  for (const auto& [value, name] : kNames)
    if (value == mode) return name;
  return "";
}

std::optional<Mode> mode_from_name(std::string_view name) {
  for (const auto& [value, text] : kNames)
    if (text == name) return value;
  return std::nullopt;
}

}  // namespace catoptra::render

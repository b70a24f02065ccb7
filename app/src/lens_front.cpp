#include "app/src/lens_front.h"

#include <array>
#include <cstddef>

namespace catoptra::app {
namespace {

using cad_import::LensFrontForm;

constexpr std::array<std::string_view, 4> kFronts{"sphere", "conic", "asphere", "freeform"};

}  // namespace

std::string_view front_name(LensFrontForm form) {
  return kFronts[std::size_t(form)];
}

std::optional<LensFrontForm> front_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kFronts.size(); ++i)
    if (kFronts[i] == name) return static_cast<LensFrontForm>(i);
  return std::nullopt;
}

LensFrontForm needed_front(const cad_import::LensBlank& blank) {
  if (blank.addition_d != 0) return LensFrontForm::freeform;
  if (!blank.asphere_mm.empty()) return LensFrontForm::asphere;
  return blank.conic != 0 ? LensFrontForm::conic : LensFrontForm::sphere;
}

}  // namespace catoptra::app

// Forms of a lens's front: by name, and the one that an order needs.
#pragma once

#include <optional>
#include <string_view>

#include "cad_import/lens_blank.h"

namespace catoptra::app {

/// "sphere", "conic", "asphere", "freeform"
[[nodiscard]] std::string_view front_name(cad_import::LensFrontForm form);
[[nodiscard]] std::optional<cad_import::LensFrontForm> front_from_name(std::string_view name);

/// The simplest form that addition, asphere_mm and conic of `blank` can have, whatever its `front` says.
[[nodiscard]] cad_import::LensFrontForm needed_front(const cad_import::LensBlank& blank);

}  // namespace catoptra::app

// What a user of mode pvrr is told of the parts of a picture that one viewpoint cannot show.
#pragma once

#include <optional>
#include <string>

#include "optics/view_regions.h"

namespace catoptra::render {

/// For the optic of that name; nullopt where there is nothing to say.
[[nodiscard]] std::optional<std::string> region_warning(const std::string& optic,
                                                        const optics::ViewRegions& regions);

}  // namespace catoptra::render

#include "optics/medium.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "optics/src/names.h"

namespace catoptra::optics {

double reference_line_nm(const Medium& medium) {
  return medium.nd == 0 && medium.ne > 0 ? kLineE_nm : kLineD_nm;
}

Medium air() {
  return {"air", Dispersion(1.0), 1, 1, 0, "by definition of ISO 13666", Certainty::verified};
}

Medium constant_medium(double n) {
  if (!(n >= 1) || !std::isfinite(n))
    throw Error("", "refractive index " + std::to_string(n), "is below 1",
                "give the index of a transparent medium, e.g. 1.5");
  return {"n = " + std::to_string(n), Dispersion(n), n, n, 0, "given by the user", Certainty::verified};
}

Medium abbe_medium(double nd, double vd) {
  if (!(nd >= 1) || !std::isfinite(nd))
    throw Error("", "n_d " + std::to_string(nd), "is below 1",
                "give the index of a transparent medium, e.g. 1.5");
  if (!(vd > 0))
    throw Error("", "Abbe number " + std::to_string(vd), "is not positive",
                "spectacle materials have 25 to 60");
  return {"n_d = " + std::to_string(nd),
          Dispersion::from_abbe(nd, vd),
          nd,
          0,
          vd,
          "given by the user",
          Certainty::verified};
}

const Medium& MediumCatalogue::find(std::string_view name) const {
  const std::string key = folded(name);
  const auto found =
      std::find_if(media_.begin(), media_.end(), [&](const Medium& m) { return folded(m.name) == key; });
  if (found != media_.end()) return *found;
  std::vector<std::string> names;
  for (const Medium& medium : media_) names.push_back(medium.name);
  throw Error("", "material \"" + std::string(name) + "\"", "is not in the catalogue",
              "nearest names: " + nearest_names(name, names));
}

void MediumCatalogue::add(std::span<const Medium> media) {
  for (const Medium& medium : media) {
    const auto same = std::find_if(media_.begin(), media_.end(),
                                   [&](const Medium& m) { return folded(m.name) == folded(medium.name); });
    if (same != media_.end())
      *same = medium;
    else
      media_.push_back(medium);
  }
}

}  // namespace catoptra::optics

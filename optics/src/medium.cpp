#include "optics/medium.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>

namespace catoptra::optics {
namespace {

/// Letters and digits only, lower case: "CR-39", "cr 39" and "CR39" are one name.
std::string folded(std::string_view name) {
  std::string key;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '.')
      key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return key;
}

/// Levenshtein distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

std::string nearest_names(std::string_view name, std::span<const Medium> media) {
  const std::string key = folded(name);
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (const Medium& medium : media)
    ranked.emplace_back(edit_distance(key, folded(medium.name)), medium.name);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, ranked.size()); ++i)
    text += (i ? ", " : "") + ranked[i].second;
  return text;
}

}  // namespace

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
  throw Error("", "material \"" + std::string(name) + "\"", "is not in the catalogue",
              "nearest names: " + nearest_names(name, media_));
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

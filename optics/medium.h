// Transparent media by name: the built-in catalogue, Abbe pairs, and catalogues that users bring.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cad_import/error.h"
#include "optics/dispersion.h"

namespace catoptra::optics {

/// How sure a catalogue figure is.
enum class Certainty {
  verified,    ///< read in the cited source
  unverified,  ///< trade knowledge without a document at hand: results that rest on it say so
};

/// A homogeneous transparent medium.
struct Medium {
  std::string name;
  Dispersion dispersion;
  double nd = 0;  ///< as the source quotes it, 0 where it does not
  double ne = 0;
  double vd = 0;
  std::string source;
  Certainty certainty = Certainty::verified;

  [[nodiscard]] double index(double wavelength_nm) const { return dispersion.index(wavelength_nm); }
};

/// The line that the medium is quoted at, nm: d, or e where the source gives n_e alone (ISO 7944).
[[nodiscard]] double reference_line_nm(const Medium& medium);

/// Air and vacuum are both index 1: spectacle powers are defined in air (ISO 13666), and catalogue indices
/// are relative to air.
[[nodiscard]] Medium air();

/// A medium of constant index. Throws Error where n < 1 or not finite.
[[nodiscard]] Medium constant_medium(double n);

/// A medium from n_d and Abbe number V_d. Throws Error where nd < 1 or vd <= 0.
[[nodiscard]] Medium abbe_medium(double nd, double vd);

/// A set of media found by name, letter case and spaces aside.
class MediumCatalogue {
 public:
  MediumCatalogue() = default;
  explicit MediumCatalogue(std::vector<Medium> media) : media_(std::move(media)) {}

  /// Throws Error naming the nearest names where there is no such medium.
  [[nodiscard]] const Medium& find(std::string_view name) const;
  [[nodiscard]] std::span<const Medium> media() const { return media_; }

  /// Adds media; one of a name that is there already replaces it.
  void add(std::span<const Medium> media);

 private:
  std::vector<Medium> media_;
};

/// Spectacle materials and common glasses, each with its source.
[[nodiscard]] const MediumCatalogue& built_in_media();

/// Reads a glass catalogue in .agf format (formulas 1 to 12). Throws Error naming file and line.
[[nodiscard]] std::vector<Medium> read_agf(const std::filesystem::path& file);

/// Reads one material of the refractiveindex.info database (.yml): formulas 1 to 6 and tables. A file that
/// holds only an absorption is refused. Throws Error naming file and entry.
[[nodiscard]] Medium read_refractive_index_yml(const std::filesystem::path& file);

}  // namespace catoptra::optics

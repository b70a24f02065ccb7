// Reads one glass catalogue or material file of the corpus and holds its indices to what is known of them.
//   corpus_check CORPUS FILE   one file, named from the corpus folder
//   corpus_check               the corpus is absent: says so and exits with 77, which CTest shows as skipped
// Exit 0: as expected; 1: not; 2: wrong usage.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>

#include "optics/coating.h"
#include "optics/medium.h"

namespace {

using namespace catoptra;
using namespace catoptra::optics;

constexpr int kSkipped = 77;

/// n_d, n_e and V_d computed elsewhere from the same file; V_d 0 where the file has no dispersion.
struct KnownMedium {
  std::string_view file;  // part of its name
  double nd, ne, vd;
  /// Both indices are rounded to five digits by whoever computed them.
  double tolerance = 1.1e-5;
};
// Zhang's is a table in steps of 10 nm: how it is interpolated is in the fifth digit.
constexpr std::array kMedia{KnownMedium{"polycarbonate_nk_Sultanova", 1.58476, 1.58975, 27.86},
                            KnownMedium{"polycarbonate_nk_Zhang", 1.59023, 1.59554, 27.9, 3e-5},
                            KnownMedium{"CR-39_nk_poly", 1.498, 1.498, 0},
                            KnownMedium{"CR-39_nk_mono", 1.452, 1.452, 0},
                            KnownMedium{"optical_N-BK7", 1.51680, 1.51872, 64.17},
                            KnownMedium{"SiO2_nk_Malitson", 1.45846, 1.46008, 67.82},
                            KnownMedium{"MgF2_nk_Dodge-o", 1.37774, 1.37859, 106.22},
                            KnownMedium{"(methyl-methacrylate)_nk_Sultanova", 1.49062, 1.49282, 53.18}};

/// Reflectance in air at 450, 550 and 650 nm, computed elsewhere from the same file.
struct KnownMetal {
  std::string_view file;
  std::array<double, 3> reflectance;
};
constexpr std::array kMetals{KnownMetal{"Al_nk_Rakic", {0.922, 0.915, 0.906}},
                             KnownMetal{"Ag_nk_Johnson", {0.980, 0.983, 0.990}},
                             KnownMetal{"Cr_nk_Johnson", {0.555, 0.555, 0.556}}};

/// V_d is rounded to a tenth at the least.
constexpr double kAbbeTolerance = 0.06;
/// Catalogues print n_d for the melt or for air at another pressure than their formula.
constexpr double kCatalogueTolerance = 2e-4;

class Judge {
 public:
  void near(const std::string& what, double found, double expected, double tolerance) {
    if (std::abs(found - expected) <= tolerance) return;
    failed_ = true;
    std::cout << what << ": " << found << ", expected " << expected << " to " << tolerance << '\n';
  }
  void fail(const std::string& what) {
    failed_ = true;
    std::cout << what << '\n';
  }
  [[nodiscard]] int exit_code() const { return failed_ ? 1 : 0; }

 private:
  bool failed_ = false;
};

/// Every glass's own formula gives the n_d of its NM line. Infrared glasses have no d line: their catalogue
/// entry says n_d = 1 or the like.
void check_catalogue(const std::filesystem::path& file, Judge& judge) {
  std::size_t compared = 0;
  for (const Medium& glass : read_agf(file)) {
    if (!glass.dispersion.in_range(kLineD_nm)) {
      std::cout << "not compared: " << glass.name << " does not transmit the d line\n";
      continue;
    }
    judge.near(glass.name + " n_d", glass.index(kLineD_nm), glass.nd, kCatalogueTolerance);
    ++compared;
  }
  std::cout << compared << " glasses compared\n";
  if (compared == 0) judge.fail("no glass was compared");
}

void check_material(const std::filesystem::path& file, Judge& judge) {
  const std::string name = file.filename().string();
  const auto named = [&](const auto& known) { return name.find(known.file) != std::string::npos; };
  if (const auto metal = std::ranges::find_if(kMetals, named); metal != kMetals.end()) {
    const Coating coating = read_coating_yml(file);
    for (int i = 0; i < 3; ++i)
      judge.near("reflectance at " + std::to_string(450 + 100 * i) + " nm",
                 coating.reflectance(450 + 100 * i), metal->reflectance[std::size_t(i)], 1e-3);
    return;
  }
  const auto known = std::ranges::find_if(kMedia, named);
  if (known == kMedia.end()) return judge.fail("nothing is known of this material: add it to the table");
  const Medium medium = read_refractive_index_yml(file);
  judge.near("n_d", medium.nd, known->nd, known->tolerance);
  judge.near("n_e", medium.ne, known->ne, known->tolerance);
  if (known->vd > 0) judge.near("V_d", medium.vd, known->vd, kAbbeTolerance);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc == 1) {
    std::cout << "CATOPTRA_CORPUS is not set: no glass catalogue is checked\n";
    return kSkipped;
  }
  if (argc != 3) return 2;
  const std::filesystem::path file = std::filesystem::path(argv[1]) / argv[2];
  Judge judge;
  if (file.extension() == ".agf")
    check_catalogue(file, judge);
  else
    check_material(file, judge);
  return judge.exit_code();
} catch (const std::exception& error) {
  std::cout << error.what() << '\n';
  return 1;
}

// Glass catalogues in .agf format: NM (name, formula, MIL number, n_d, V_d), CD (coefficients), LD (range,
// micrometres). Field meanings: nzhagen/zemaxglass and facts checked against nd of every glass in the tests.
#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include "optics/medium.h"

namespace catoptra::optics {
namespace {

/// Index = formula number of the format; 0 is unused.
constexpr std::array<DispersionFormula, 13> kFormulas{
    DispersionFormula::constant,   DispersionFormula::schott,     DispersionFormula::sellmeier1,
    DispersionFormula::herzberger, DispersionFormula::sellmeier2, DispersionFormula::conrady,
    DispersionFormula::sellmeier3, DispersionFormula::handbook1,  DispersionFormula::handbook2,
    DispersionFormula::sellmeier4, DispersionFormula::extended1,  DispersionFormula::sellmeier5,
    DispersionFormula::extended2};

/// One glass as its lines come in.
struct Entry {
  std::string name;
  int formula = 0;
  double nd = 0, vd = 0;
  std::vector<double> coefficients;
  double min_nm = 0, max_nm = 0;
  std::size_t line = 0;
};

[[noreturn]] void fail(const std::filesystem::path& file, std::size_t line, const std::string& reason) {
  throw Error(file.string(), "line " + std::to_string(line), reason,
              "expected a glass catalogue in .agf format");
}

Medium finish(const std::filesystem::path& file, const Entry& entry) {
  if (entry.coefficients.empty()) fail(file, entry.line, "glass \"" + entry.name + "\" has no CD line");
  Medium medium;
  medium.name = entry.name;
  medium.dispersion = {kFormulas[static_cast<std::size_t>(entry.formula)], entry.coefficients, entry.min_nm,
                       entry.max_nm};
  // A negative square of the index, or a pole of the formula: wrong coefficients or a wrong formula number.
  const double middle_nm = entry.max_nm > 0 ? 0.5 * (entry.min_nm + entry.max_nm) : kLineD_nm;
  if (!std::isfinite(medium.index(middle_nm)))
    fail(file, entry.line, "the coefficients of glass \"" + entry.name + "\" give no refractive index");
  medium.nd = entry.nd;
  medium.vd = entry.vd;
  medium.source = file.filename().string();
  return medium;
}

Entry read_name(const std::filesystem::path& file, std::istringstream& fields, std::size_t line) {
  Entry entry;
  double formula = 0;
  std::string mil;
  if (!(fields >> entry.name >> formula >> mil >> entry.nd >> entry.vd))
    fail(file, line, "NM line is too short");
  if (formula < 1 || formula > 12 || formula != static_cast<int>(formula))
    fail(file, line, "glass \"" + entry.name + "\" uses an unknown dispersion formula");
  entry.formula = static_cast<int>(formula);
  entry.line = line;
  return entry;
}

std::string without_byte_order_mark(const std::string& text) {
  for (const std::string_view mark : {"\xff\xfe", "\xfe\xff", "\xef\xbb\xbf"})
    if (text.starts_with(mark)) return text.substr(mark.size());
  return text;
}

}  // namespace

std::vector<Medium> read_agf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(file.string(), "", "cannot be opened", "check the path and its permissions");
  std::vector<Medium> media;
  std::optional<Entry> entry;
  std::string text;
  for (std::size_t line = 1; std::getline(in, text); ++line) {
    if (line == 1) text = without_byte_order_mark(text);
    std::erase(text, '\0');  // some catalogues are UTF-16 with Latin letters only
    std::istringstream fields(text);
    std::string tag;
    fields >> tag;
    if (tag == "NM") {
      if (entry) media.push_back(finish(file, *entry));
      entry = read_name(file, fields, line);
    } else if (tag == "CD" && entry) {
      for (double value; fields >> value;) entry->coefficients.push_back(value);
    } else if (tag == "LD" && entry) {
      double min_um = 0, max_um = 0;
      if (!(fields >> min_um >> max_um)) fail(file, line, "LD line needs two wavelengths");
      entry->min_nm = min_um * 1e3;
      entry->max_nm = max_um * 1e3;
    }
  }
  if (entry) media.push_back(finish(file, *entry));
  if (media.empty()) fail(file, 1, "no NM line: no glass");
  return media;
}

}  // namespace catoptra::optics

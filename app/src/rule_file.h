// Figures of standards and regulations as versioned data: tolerances, required fields, radii. A rule file is
// TOML:
//
//   format = 1                       # of this layout
//   id = "R46-III"                   # its name for --rule
//   kind = "mirror"                  # what it judges
//   title = "..."
//   edition = "..."                  # edition of a standard, series of a regulation
//   date = "2023-07"
//   source = "..."                   # where the figures come from; `note` (optional): what is left out
//
//   [[figure]]
//   quantity = "axis"                # one that the kind knows
//   clause = "..."
//   unit = "deg"                     # one that the quantity takes
//   value = 3                        # or values = { width_m = 4, from_m = 20 }, or both
//   applies_to = ["single vision"]   # left out: everything
//   when = { cylinder_d = { above = 0.75, up_to = 1.5 } }   # also: from, below; every range has to hold
//   source = "..."                   # left out: the file's
//   certainty = "unverified"         # verified | cross-checked | derived | unverified
//   note = "..."                     # optional
//
// Nothing here knows what the figures mean: each kind of rule brings the words of its own (RuleVocabulary).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cad_import/error.h"

namespace catoptra::app {

/// How sure a figure is. `verified`: read in the source that it cites; `cross_checked`: two sources, or a
/// source and a calculation, agree; `derived`: calculated; `unverified`: second-hand, and every verdict that
/// rests on it says so.
enum class Certainty { verified, cross_checked, derived, unverified };

/// "verified", "cross-checked", "derived", "unverified"
[[nodiscard]] std::string_view certainty_name(Certainty certainty);

/// Range of a variable: above < x, from <= x, x <= up_to, x < below, as far as given.
struct RuleRange {
  std::optional<double> above, from, up_to, below;
  [[nodiscard]] bool contains(double x) const;
};

struct RuleFigure {
  std::string quantity, clause, unit, source, note;
  std::optional<double> value;
  std::map<std::string, double> values;   ///< by the names that the quantity has
  std::vector<std::string> applies_to;    ///< empty: everything
  std::map<std::string, RuleRange> when;  ///< by variable
  Certainty certainty = Certainty::unverified;
  std::size_t line = 0;  ///< in the file
};

struct RuleFile {
  std::string file;                 ///< as the user named it, or "ID (built in)"
  std::filesystem::path path = {};  ///< empty for one that is built in
  std::string id, kind, title, edition, date, source, note;
  std::vector<RuleFigure> figures;
};

/// A quantity that a kind of rule may limit. One without names takes a plain `value`; one with names takes
/// `values`, and a `value` where that means something.
struct RuleQuantity {
  std::string name;
  std::vector<std::string> units;                 ///< that `unit` may be
  std::vector<std::string> values = {};           ///< names that `values` must hold
  std::vector<std::string> optional_values = {};  ///< names that it may hold besides
};

/// The words that one kind of rule understands. Whatever else a file holds is refused.
struct RuleVocabulary {
  std::string kind;
  std::vector<RuleQuantity> quantities;
  std::vector<std::string> applies_to, variables;
};

/// --rule names neither a rule that is built in nor a file.
class UnknownRule : public Error {
 public:
  using Error::Error;
};

/// Reads a rule file. Throws catoptra::Error with file, "line N, figure.key" and reason: not readable, not
/// TOML, a key that is unknown, missing or of the wrong type, a word that `vocabulary` does not have, a range
/// that nothing lies in.
[[nodiscard]] RuleFile read_rule_file(const std::filesystem::path& file, const RuleVocabulary& vocabulary);

/// The same from text; `name` stands for the file in messages.
[[nodiscard]] RuleFile read_rule_text(std::string_view text, const std::string& name,
                                      const RuleVocabulary& vocabulary);

/// Ids of the rules of `kind` in the program, in alphabetical order.
[[nodiscard]] std::vector<std::string> built_in_rules(std::string_view kind);

/// The rule that is built in under `name` (letter case ignored), else the file of that name. Throws
/// UnknownRule with the nearest names where there is neither, and as read_rule_file.
[[nodiscard]] RuleFile find_rule(const std::string& name, const RuleVocabulary& vocabulary);

/// The figure for `quantity` that applies to `what` (empty: only figures that apply to everything) and whose
/// ranges hold for `variables`; null where there is none. Throws catoptra::Error where two do: the file
/// contradicts itself. A range over a variable that is not given does not hold.
[[nodiscard]] const RuleFigure* find_figure(const RuleFile& rule, std::string_view quantity,
                                            std::string_view what,
                                            const std::map<std::string, double>& variables);

}  // namespace catoptra::app

#include "app/src/rule_file.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include "app/src/built_in_rules.h"
#include "app/src/nearest_name.h"
#include "app/src/toml_table.h"

namespace catoptra::app {
namespace {

/// Version of the layout that this program reads.
constexpr int kFormat = 1;

bool has(std::span<const std::string> names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// As the rule itself says it.
struct BuiltIn {
  std::string id, kind;
};

BuiltIn built_in(const BuiltInRule& rule) {
  const toml::table table = toml::parse(rule.text);
  return {table["id"].value_or(std::string()), table["kind"].value_or(std::string())};
}

std::string letters_of(std::string_view name) {
  std::string letters;
  for (const unsigned char c : name)
    if (std::isalnum(c)) letters += char(std::tolower(c));
  return letters;
}

/// What `name` may have been meant for: the one that differs in punctuation alone, else all that it begins,
/// else a slip of one of them. Where two are as near (R46-VI, which is no rule here), none is named.
std::string meant_rules(const std::string& name, const std::vector<std::string>& known) {
  const std::string letters = letters_of(name);
  if (letters.empty()) return {};
  std::vector<std::string> same, begun;
  for (const std::string& id : known) {
    if (letters_of(id) == letters) same.push_back(id);
    if (letters_of(id).starts_with(letters)) begun.push_back(id);
  }
  const std::vector<std::string>& found = same.empty() ? begun : same;
  std::string text;
  for (const std::string& id : found) text += (text.empty() ? "'" : " or '") + id + "'";
  if (!text.empty()) return text;
  const std::string nearest = nearest_name(name, known);
  if (nearest.empty()) return {};
  std::vector<std::string> rest;
  for (const std::string& id : known)
    if (id != nearest) rest.push_back(id);
  const std::string second = nearest_name(name, rest);
  const bool tie = !second.empty() && edit_distance(name, second) == edit_distance(name, nearest);
  return tie ? std::string{} : "'" + nearest + "'";
}

std::string rule_hint(const std::string& name, const std::vector<std::string>& known) {
  const std::string meant = meant_rules(name, known);
  return (meant.empty() ? "" : "did you mean " + meant + "? ") + "built in: " + list_of_names(known) +
         "; or the name of a rule file";
}

/// A text that is there and says something.
std::string required_text(const TomlTable& table, std::string_view key, const std::string& hint = {}) {
  const auto text = table.text(key);
  if (!text) table.fail_missing(key, hint);
  if (text->empty()) table.fail(key, "is empty", hint);
  return *text;
}

void refuse_unknown(const TomlTable& table, std::string_view key, const std::string& word,
                    std::span<const std::string> known) {
  if (has(known, word)) return;
  table.fail(key, "'" + word + "' is not one of " + list_of_names(known), hint_for_unknown(word, known));
}

Certainty read_certainty(const TomlTable& table) {
  constexpr Certainty kAll[] = {Certainty::verified, Certainty::cross_checked, Certainty::derived,
                                Certainty::unverified};
  const auto word = table.choice("certainty", {"verified", "cross-checked", "derived", "unverified"});
  if (!word) table.fail_missing("certainty", "verified, cross-checked, derived or unverified");
  return *std::find_if(std::begin(kAll), std::end(kAll),
                       [&](Certainty c) { return certainty_name(c) == *word; });
}

RuleRange read_range(const toml::node& node, const TomlTable& when, const std::string& variable) {
  const toml::table* found = node.as_table();
  if (!found) when.fail(variable, "expected a range", "for example { above = 0.75, up_to = 1.5 }");
  const TomlTable table(*found, when.file(), "figure.when." + variable, {"above", "from", "up_to", "below"});
  const RuleRange range{table.number("above"), table.number("from"), table.number("up_to"),
                        table.number("below")};
  if (found->empty()) when.fail(variable, "the range has no bound", "one of above, from, up_to and below");
  if (range.above && range.from) table.fail("from", "from excludes above");
  if (range.up_to && range.below) table.fail("below", "below excludes up_to");
  const auto lower_bound = range.above ? range.above : range.from;
  const auto upper_bound = range.up_to ? range.up_to : range.below;
  const bool one_value_will_do = range.from && range.up_to;
  if (lower_bound && upper_bound &&
      (one_value_will_do ? *lower_bound > *upper_bound : *lower_bound >= *upper_bound))
    when.fail(variable, "nothing lies in this range");
  return range;
}

void read_when(const TomlTable& figure, const RuleVocabulary& vocabulary, RuleFigure& result) {
  const toml::table* found = figure.table("when");
  if (!found) return;
  const TomlTable when(*found, figure.file(), "figure.when", vocabulary.variables);
  for (const auto& [key, node] : *found)
    result.when[std::string(key.str())] = read_range(node, when, std::string(key.str()));
}

void read_values(const TomlTable& figure, const RuleQuantity& quantity, RuleFigure& result) {
  result.value = figure.number("value");
  const toml::table* found = figure.table("values");
  std::vector<std::string> names = quantity.values;
  names.insert(names.end(), quantity.optional_values.begin(), quantity.optional_values.end());
  if (names.empty()) {
    if (found) figure.fail("values", "'" + quantity.name + "' has one value", "write value = ...");
    if (!result.value) figure.fail_missing("value", "a number in the unit given");
    return;
  }
  if (!found && (!result.value || !quantity.values.empty()))
    figure.fail_missing("values", "with " + list_of_names(names));
  if (!found) return;
  const TomlTable values(*found, figure.file(), "figure.values", names);
  for (const auto& [key, node] : *found) result.values[std::string(key.str())] = *values.number(key.str());
  for (const std::string& name : quantity.values)
    if (!values.has(name))
      figure.fail("values", "'" + name + "' is missing",
                  "'" + quantity.name + "' needs " + list_of_names(quantity.values));
}

void read_applies_to(const TomlTable& figure, const RuleVocabulary& vocabulary, RuleFigure& result) {
  const toml::node* node = figure.node("applies_to");
  if (!node) return;
  const toml::array* array = node->as_array();
  if (!array || array->empty()) figure.fail("applies_to", "expected an array of names");
  for (const toml::node& element : *array) {
    if (!element.is_string()) figure.fail("applies_to", "expected an array of names");
    result.applies_to.push_back(*element.value<std::string>());
    refuse_unknown(figure, "applies_to", result.applies_to.back(), vocabulary.applies_to);
  }
}

RuleFigure read_figure(const TomlTable& table, std::size_t line, const RuleFile& rule,
                       const RuleVocabulary& vocabulary) {
  RuleFigure figure;
  figure.line = line;
  figure.quantity = required_text(table, "quantity");
  std::vector<std::string> names;
  for (const RuleQuantity& quantity : vocabulary.quantities) names.push_back(quantity.name);
  refuse_unknown(table, "quantity", figure.quantity, names);
  const RuleQuantity& quantity = *std::find_if(vocabulary.quantities.begin(), vocabulary.quantities.end(),
                                               [&](const auto& q) { return q.name == figure.quantity; });
  figure.unit = required_text(table, "unit", list_of_names(quantity.units));
  refuse_unknown(table, "unit", figure.unit, quantity.units);
  figure.clause = required_text(table, "clause", "where the rule says so, for example \"5.2.2, table 1\"");
  figure.certainty = read_certainty(table);
  figure.source = table.has("source") ? required_text(table, "source") : rule.source;
  figure.note = table.text("note").value_or("");
  read_values(table, quantity, figure);
  read_applies_to(table, vocabulary, figure);
  read_when(table, vocabulary, figure);
  return figure;
}

bool applies(const RuleFigure& figure, std::string_view quantity, std::string_view what,
             const std::map<std::string, double>& variables) {
  if (figure.quantity != quantity) return false;
  if (!figure.applies_to.empty() && !has(figure.applies_to, what)) return false;
  return std::all_of(figure.when.begin(), figure.when.end(), [&](const auto& entry) {
    const auto found = variables.find(entry.first);
    return found != variables.end() && entry.second.contains(found->second);
  });
}

}  // namespace

std::string_view certainty_name(Certainty certainty) {
  switch (certainty) {
    case Certainty::verified:
      return "verified";
    case Certainty::cross_checked:
      return "cross-checked";
    case Certainty::derived:
      return "derived";
    default:
      return "unverified";
  }
}

bool RuleRange::contains(double x) const {
  return (!above || x > *above) && (!from || x >= *from) && (!up_to || x <= *up_to) && (!below || x < *below);
}

RuleFile read_rule_text(std::string_view text, const std::string& name, const RuleVocabulary& vocabulary) {
  const toml::table parsed = parse_toml(text, name);
  const TomlTable root(parsed, name, "",
                       {"format", "id", "kind", "title", "edition", "date", "source", "note", "figure"});
  if (!root.has("format")) root.fail_missing("format", "format = " + std::to_string(kFormat));
  if (*root.integer("format", 1, 1000000) != kFormat)
    root.fail("format", "this version of Catoptra reads format " + std::to_string(kFormat));
  RuleFile rule;
  rule.file = name;
  rule.kind = required_text(root, "kind");
  if (rule.kind != vocabulary.kind)
    root.fail("kind",
              "this is a rule for '" + rule.kind + "', and one for '" + vocabulary.kind + "' is wanted");
  rule.id = required_text(root, "id");
  rule.title = required_text(root, "title");
  rule.edition = required_text(root, "edition");
  rule.date = required_text(root, "date", "of the edition, for example \"2023-07\"");
  rule.source = required_text(root, "source", "where the figures come from");
  rule.note = root.text("note").value_or("");
  for (const toml::table* table : root.tables("figure"))
    rule.figures.push_back(read_figure({*table,
                                        name,
                                        "figure",
                                        {"quantity", "clause", "unit", "value", "values", "applies_to",
                                         "when", "source", "certainty", "note"}},
                                       table->source().begin.line, rule, vocabulary));
  if (rule.figures.empty()) root.fail_missing("figure", "a rule without figures judges nothing");
  return rule;
}

RuleFile read_rule_file(const std::filesystem::path& file, const RuleVocabulary& vocabulary) {
  std::error_code ignored;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, ignored))
    throw Error(file.string(), "", "cannot read the rule file", "does it exist and may you read it?");
  RuleFile rule =
      read_rule_text(std::string{std::istreambuf_iterator<char>(stream), {}}, file.string(), vocabulary);
  rule.path = file;
  return rule;
}

std::vector<std::string> built_in_rules(std::string_view kind) {
  std::vector<std::string> ids;
  for (const BuiltInRule& rule : built_in_rule_texts())
    if (const BuiltIn known = built_in(rule); known.kind == kind) ids.push_back(known.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

RuleFile find_rule(const std::string& name, const RuleVocabulary& vocabulary) {
  for (const BuiltInRule& rule : built_in_rule_texts())
    if (lower(std::string(rule.id)) == lower(name)) {
      if (const BuiltIn known = built_in(rule); known.kind != vocabulary.kind)
        throw UnknownRule("", "",
                          known.id + " is a rule for a " + known.kind + ", not for a " + vocabulary.kind,
                          rule_hint({}, built_in_rules(vocabulary.kind)));
      return read_rule_text(rule.text, std::string(rule.id) + " (built in)", vocabulary);
    }
  std::error_code ignored;
  if (name.find('/') != std::string::npos || name.ends_with(".toml") ||
      std::filesystem::exists(name, ignored))
    return read_rule_file(name, vocabulary);
  throw UnknownRule("", "", "unknown rule '" + name + "'", rule_hint(name, built_in_rules(vocabulary.kind)));
}

const RuleFigure* find_figure(const RuleFile& rule, std::string_view quantity, std::string_view what,
                              const std::map<std::string, double>& variables) {
  const RuleFigure* found = nullptr;
  for (const RuleFigure& figure : rule.figures) {
    if (!applies(figure, quantity, what, variables)) continue;
    if (found)
      throw Error(
          rule.file, "line " + std::to_string(figure.line) + ", figure",
          "'" + figure.quantity + "' has another value here than in line " + std::to_string(found->line),
          "let applies_to or the ranges of when tell them apart");
    found = &figure;
  }
  return found;
}

}  // namespace catoptra::app

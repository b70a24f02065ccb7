// [[prescriptions]]: lenses to order, as a grid or as a sample.
#include "app/src/batch_plan_parts.h"
#include "app/src/batch_sweep.h"
#include "app/src/lens_front.h"
#include "cad_import/error.h"
#include "cad_import/outline.h"

namespace catoptra::app {
namespace {

using cad_import::LensBlank;

/// One key of the table with what it runs through.
struct BlankSweep {
  const BlankNumber* number;
  Sweep sweep;
};

void set(LensBlank& blank, const BlankNumber& number, double value) {
  if (number.value)
    blank.*number.value = value;
  else
    blank.*number.optional_value = value;
}

/// Each key draws by itself, so that one key more or less changes no other. In a sample of this table (`own`)
/// ranges and lists have been drawn from a stream per key since version 0.1, and still are.
std::vector<LensBlank> sample_of(const PlanSample& sample, bool own, const LensBlank& base,
                                 const std::vector<BlankSweep>& sweeps) {
  std::vector<LensBlank> blanks(sample.count, base);
  for (const BlankSweep& s : sweeps) {
    SampleStream stream(sample.seed, std::uint32_t(s.number - blank_numbers().data()));
    const bool streamed = own && !s.sweep.normal;
    for (std::size_t i = 0; i < blanks.size(); ++i)
      set(blanks[i], *s.number,
          streamed ? s.sweep.at(stream.next()) : s.sweep.drawn(sample.number(i, s.number->key)));
  }
  return blanks;
}

std::vector<glm::dvec2> read_outline_key(const TomlTable& table, const PlanContext& context) {
  const std::filesystem::path file = plan_path(table, context, "outline");
  if (table.has("diameter")) table.fail("outline", "outline excludes diameter");
  try {
    auto corners = cad_import::read_outline(file);
    for (glm::dvec2& corner : corners) corner += 0.0;  // minus zero is zero
    return corners;
  } catch (const Error& error) {
    table.fail(
        "outline",
        "'" + file.string() + "': " + (error.entity().empty() ? "" : error.entity() + " ") + error.reason(),
        error.hint());
  }
}

}  // namespace

std::vector<std::string> blank_keys() {
  std::vector<std::string> keys{"sample", "front", "asphere", "outline"};
  keys.insert(keys.end(), std::begin(kMaterialKeys), std::end(kMaterialKeys));
  for (const BlankNumber& number : blank_numbers()) keys.emplace_back(number.key);
  return keys;
}

std::vector<LensBlank> read_blanks(const TomlTable& table, const PlanContext& context) {
  const auto sample = sample_of_table(table, context, "sample", "prescriptions.sample", "prescriptions");
  std::vector<BlankSweep> sweeps;
  for (const BlankNumber& number : blank_numbers())
    if (auto sweep = read_sweep(table, number.key, {}, sample.has_value()))
      sweeps.push_back({&number, std::move(*sweep)});
  LensBlank base;
  if (const auto asphere = table.numbers("asphere", 0)) base.asphere_mm = *asphere;
  if (table.has("outline")) base.outline = read_outline_key(table, context);
  const auto front = table.choice("front", {"sphere", "conic", "asphere", "freeform"});
  auto blanks =
      sample ? sample_of(*sample, !context.sample, base, sweeps)
             : grid_of(table.file(), base, sweeps, [](LensBlank& blank, const BlankSweep& s, double value) {
                 set(blank, *s.number, value);
               });
  for (LensBlank& blank : blanks) blank.front = front ? *front_from_name(*front) : needed_front(blank);
  return blanks;
}

}  // namespace catoptra::app

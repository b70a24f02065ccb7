// [[prescriptions]]: lenses to order, as a grid or as a sample.
#include <cmath>

#include "app/src/batch_plan_parts.h"
#include "app/src/batch_sweep.h"
#include "app/src/lens_front.h"
#include "cad_import/error.h"

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

struct Sample {
  std::size_t count = 0;
  std::uint64_t seed = 0;
};

std::optional<Sample> read_sample(const TomlTable& table) {
  const toml::table* found = table.table("sample");
  if (!found) return std::nullopt;
  const TomlTable sample(*found, table.file(), "prescriptions.sample", {"count", "seed"});
  const auto count = sample.integer("count", 1, int(kMostCases));
  const auto seed = sample.integer("seed", 0, std::numeric_limits<int>::max());
  if (!count) sample.fail_missing("count", "how many prescriptions to draw");
  if (!seed) sample.fail_missing("seed", "an integer: the same seed draws the same prescriptions");
  return Sample{std::size_t(*count), std::uint64_t(*seed)};
}

std::vector<LensBlank> grid_of(const std::string& plan, const LensBlank& base,
                               const std::vector<BlankSweep>& sweeps) {
  std::size_t count = 1;
  for (const BlankSweep& s : sweeps) count = case_product(plan, count, s.sweep.values.size());
  std::vector<LensBlank> blanks(count, base);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;  // the last key runs fastest
    for (auto s = sweeps.rbegin(); s != sweeps.rend(); ++s) {
      set(blanks[i], *s->number, s->sweep.values[rest % s->sweep.values.size()]);
      rest /= s->sweep.values.size();
    }
  }
  return blanks;
}

/// Each key draws from a stream of its own, so that one key more or less changes no other.
std::vector<LensBlank> sample_of(const Sample& sample, const LensBlank& base,
                                 const std::vector<BlankSweep>& sweeps) {
  std::vector<LensBlank> blanks(sample.count, base);
  for (const BlankSweep& s : sweeps) {
    SampleStream stream(sample.seed, std::uint32_t(s.number - blank_numbers().data()));
    for (LensBlank& blank : blanks) set(blank, *s.number, s.sweep.at(stream.next()));
  }
  return blanks;
}

}  // namespace

std::vector<std::string> blank_keys() {
  std::vector<std::string> keys{"sample", "front", "asphere", "material", "materials"};
  for (const BlankNumber& number : blank_numbers()) keys.emplace_back(number.key);
  return keys;
}

std::vector<LensBlank> read_blanks(const TomlTable& table) {
  const auto sample = read_sample(table);
  std::vector<BlankSweep> sweeps;
  for (const BlankNumber& number : blank_numbers())
    if (auto sweep = read_sweep(table, number.key, {}, sample.has_value()))
      sweeps.push_back({&number, std::move(*sweep)});
  LensBlank base;
  if (const auto asphere = table.numbers("asphere", 0)) base.asphere_mm = *asphere;
  const auto front = table.choice("front", {"sphere", "conic", "asphere", "freeform"});
  auto blanks = sample ? sample_of(*sample, base, sweeps) : grid_of(table.file(), base, sweeps);
  for (LensBlank& blank : blanks) blank.front = front ? *front_from_name(*front) : needed_front(blank);
  return blanks;
}

}  // namespace catoptra::app

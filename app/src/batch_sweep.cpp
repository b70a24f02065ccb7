#include "app/src/batch_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "app/src/batch_plan_parts.h"

namespace catoptra::app {
namespace {

/// Limits nearer to one another, in standard deviations, leave a range and no bell.
constexpr double kNarrowest_sd = 0.1;

double decimal(double value) {
  return std::round(1e9 * value) / 1e9 + 0.0;
}

Sweep read_normal(const TomlTable& parent, std::string_view key, const TomlTable& table, Range range) {
  for (const char* other : {"from", "to", "step"})
    if (table.has(other))
      parent.fail(key, "mean and sd exclude '" + std::string(other) + "'",
                  "{ mean = 12, sd = 1, min = 9, max = 15 }");
  Sweep sweep;
  sweep.normal.emplace();
  struct Wanted {
    const char* name;
    double* value;
    Range allowed;
  };
  for (const auto& [name, value, allowed] : {Wanted{"mean", &sweep.normal->mean, range},
                                             {"sd", &sweep.normal->sd, Range::positive()},
                                             {"min", &sweep.from, range},
                                             {"max", &sweep.to, range}}) {
    const auto read = table.number(name, allowed);
    if (!read)
      parent.fail(key, "the normal distribution has no '" + std::string(name) + "'",
                  "{ mean = 12, sd = 1, min = 9, max = 15 }: min and max are hard limits");
    *value = *read;
  }
  if (!(sweep.from <= sweep.normal->mean && sweep.normal->mean <= sweep.to))
    parent.fail(key, "the mean is not between min and max");
  if (sweep.to - sweep.from < kNarrowest_sd * sweep.normal->sd)
    parent.fail(key, "min and max are nearer to one another than a tenth of sd",
                "draw evenly: { from = ..., to = ... }");
  return sweep;
}

Sweep read_range(const TomlTable& parent, std::string_view key, const toml::table& node, Range range,
                 bool sampled) {
  const TomlTable table(node, parent.file(), std::string(key),
                        {"from", "to", "step", "mean", "sd", "min", "max"});
  Sweep sweep;
  for (const char* name : {"mean", "sd", "min", "max"}) {
    if (!table.has(name)) continue;
    if (!sampled)
      parent.fail(
          key, "only samples draw from a normal distribution",
          "put sample = { count = 100, seed = 1 } at the top of the plan, or give { from, to, step }");
    return read_normal(parent, key, table, range);
  }
  for (const auto& [name, value] : {std::pair{"from", &sweep.from}, {"to", &sweep.to}}) {
    const auto read = table.number(name, range);
    if (!read)
      parent.fail(key, "the range has no '" + std::string(name) + "'", "{ from = -4, to = 4, step = 0.5 }");
    *value = *read;
  }
  if (sweep.to < sweep.from) parent.fail(key, "the range ends before it begins", "exchange from and to");
  const auto step = table.number("step", Range::positive());
  if (!step) {
    if (!sampled) parent.fail(key, "the range has no 'step'", "only samples do without one");
    return sweep;
  }
  const double count = std::floor((sweep.to - sweep.from) / *step + 1e-9) + 1;
  if (!(count <= double(kMostValues)))
    parent.fail(key, "the range has more than " + std::to_string(kMostValues) + " values",
                "make the step larger");
  for (double i = 0; i < count; ++i) sweep.values.push_back(decimal(sweep.from + i * *step));
  return sweep;
}

}  // namespace

std::optional<PlanSample> read_plan_sample(const TomlTable& table, std::string_view key,
                                           const std::string& path, const std::string& what) {
  const toml::table* found = table.table(key);
  if (!found) return std::nullopt;
  const TomlTable sample(*found, table.file(), path, {"count", "seed"});
  const auto count = sample.integer("count", 1, int(kMostCases));
  const auto seed = sample.integer("seed", 0, std::numeric_limits<int>::max());
  if (!count) sample.fail_missing("count", "how many " + what + " to draw");
  if (!seed) sample.fail_missing("seed", "an integer: the same seed draws the same " + what);
  return PlanSample{std::size_t(*count), std::uint32_t(*seed)};
}

double Sweep::at(double share) const {
  if (continuous()) return std::clamp(decimal(from + share * (to - from)), from, to);
  return values[std::min(values.size() - 1, std::size_t(share * double(values.size())))];
}

double Sweep::drawn(const RandomNumber& random) const {
  if (!normal) return at(random.uniform());
  // At least one in thirty is within the limits (read_normal).
  for (std::uint32_t attempt = 0;; ++attempt) {
    const double value = normal->mean + normal->sd * random.normal(attempt);
    if (value >= from && value <= to) return std::clamp(decimal(value), from, to);
  }
}

std::vector<double> values_of(const Sweep& sweep, const std::optional<PlanSample>& sample,
                              std::string_view field) {
  if (!sample) return sweep.values;
  std::vector<double> values;
  for (std::size_t i = 0; i < sample->count; ++i) values.push_back(sweep.drawn(sample->number(i, field)));
  return values;
}

std::optional<Sweep> read_sweep(const TomlTable& table, std::string_view key, Range range, bool sampled) {
  const toml::node* node = table.node(key);
  if (!node) return std::nullopt;
  return sweep_of(*node, table, key, range, sampled);
}

Sweep sweep_of(const toml::node& node, const TomlTable& table, std::string_view key, Range range,
               bool sampled) {
  if (const toml::table* found = node.as_table()) return read_range(table, key, *found, range, sampled);
  if (node.is_number()) return Sweep{{table.number_of(node, key, range) + 0.0}, 0, 0, {}};
  if (!node.is_array())
    table.fail(key, "expected a number, a list or a range",
               "for example 1.5, [1, 2] or { from = 0, to = 2, step = 0.5 }");
  Sweep sweep{table.numbers_of(node, key, 0, range), 0, 0, {}};
  if (sweep.values.empty()) table.fail(key, "the list is empty");
  if (sweep.values.size() > kMostValues)
    table.fail(key, "the list has more than " + std::to_string(kMostValues) + " values");
  for (double& value : sweep.values) value += 0.0;  // minus zero is zero
  return sweep;
}

struct SampleStream::Generator {
  std::mt19937_64 engine;
};

SampleStream::SampleStream(std::uint64_t seed, std::uint32_t stream)
    : generator_(std::make_unique<Generator>()) {
  std::seed_seq sequence{std::uint32_t(seed), std::uint32_t(seed >> 32), stream};
  generator_->engine.seed(sequence);
}
SampleStream::~SampleStream() = default;
SampleStream::SampleStream(SampleStream&&) noexcept = default;

double SampleStream::next() {
  return double(generator_->engine() >> 11) * 0x1p-53;
}

}  // namespace catoptra::app

#include "app/src/batch_sweep.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace catoptra::app {
namespace {

double decimal(double value) {
  return std::round(1e9 * value) / 1e9 + 0.0;
}

Sweep read_range(const TomlTable& parent, std::string_view key, const toml::table& node, Range range,
                 bool sampled) {
  const TomlTable table(node, parent.file(), std::string(key), {"from", "to", "step"});
  Sweep sweep;
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

double Sweep::at(double share) const {
  if (continuous()) return decimal(from + share * (to - from));
  return values[std::min(values.size() - 1, std::size_t(share * double(values.size())))];
}

std::optional<Sweep> read_sweep(const TomlTable& table, std::string_view key, Range range, bool sampled) {
  const toml::node* node = table.node(key);
  if (!node) return std::nullopt;
  if (const toml::table* found = node->as_table()) return read_range(table, key, *found, range, sampled);
  if (node->is_number()) return Sweep{{*table.number(key, range) + 0.0}};
  if (!node->is_array())
    table.fail(key, "expected a number, a list or a range",
               "for example 1.5, [1, 2] or { from = 0, to = 2, step = 0.5 }");
  Sweep sweep{table.numbers_of(*node, key, 0, range)};
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

// Values that a plan runs through or draws from: a number, a list, a range, or a normal distribution.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "app/src/counter_random.h"
#include "app/src/toml_table.h"

namespace catoptra::app {

/// Most values of one key.
inline constexpr std::size_t kMostValues = 100000;

/// `count` draws. Draw i of a key is a function of the seed, i and the key alone: more draws leave the first
/// ones as they are, and so does one key more or less.
struct PlanSample {
  std::size_t count = 0;
  std::uint32_t seed = 0;

  [[nodiscard]] RandomNumber number(std::size_t draw, std::string_view field) const {
    return {seed, draw, field};
  }
};

/// The sample under `key`, { count = 200, seed = 7 }; nullopt where absent. For messages: `path` names the
/// key in the plan, `what` is drawn.
[[nodiscard]] std::optional<PlanSample> read_plan_sample(const TomlTable& table, std::string_view key,
                                                         const std::string& path, const std::string& what);

/// A normal distribution between hard limits: what falls outside is drawn again.
struct Normal {
  double mean = 0, sd = 1;
};

/// `values`; or (samples only) anything from `from` to `to`, evenly or as `normal` has it.
struct Sweep {
  std::vector<double> values;
  double from = 0, to = 0;
  std::optional<Normal> normal;

  [[nodiscard]] bool continuous() const { return values.empty(); }
  /// The value at `share` (0 <= share < 1) of the way. Not for a normal distribution.
  [[nodiscard]] double at(double share) const;
  /// The value that `random` says.
  [[nodiscard]] double drawn(const RandomNumber& random) const;
};

/// Reads `key`: 1.5, [1, 2, 4], { from = -4, to = 4, step = 0.25 }, each value within `range`; where
/// `sampled` also { from, to } and { mean, sd, min, max }. Values of a range are decimal numbers of at most
/// nine places, so that 0.3 is 0.3. Nullopt where the key is absent.
[[nodiscard]] std::optional<Sweep> read_sweep(const TomlTable& table, std::string_view key, Range range,
                                              bool sampled);

/// The same for a node that stands for `key`, such as an element of its list.
[[nodiscard]] Sweep sweep_of(const toml::node& node, const TomlTable& table, std::string_view key,
                             Range range, bool sampled);

/// All values, or those of the sample's draws; `field` names the key among all keys of plans.
[[nodiscard]] std::vector<double> values_of(const Sweep& sweep, const std::optional<PlanSample>& sample,
                                            std::string_view field);

/// Numbers from 0 to 1 (1 excluded), the same everywhere: 53 bits of the Mersenne twister MT19937-64. Each
/// `stream` of a seed is a sequence of its own. Ranges and lists in the sample of one [[prescriptions]] are
/// drawn from it since version 0.1; everything else comes from RandomNumber.
class SampleStream {
 public:
  SampleStream(std::uint64_t seed, std::uint32_t stream);
  ~SampleStream();
  SampleStream(SampleStream&&) noexcept;
  [[nodiscard]] double next();

 private:
  struct Generator;
  std::unique_ptr<Generator> generator_;
};

}  // namespace catoptra::app

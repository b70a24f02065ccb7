// Values that a plan runs through: a number, a list, or a range.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "app/src/toml_table.h"

namespace catoptra::app {

/// Most values of one key.
inline constexpr std::size_t kMostValues = 100000;

/// `values`, or anything from `from` to `to` (samples only).
struct Sweep {
  std::vector<double> values;
  double from = 0, to = 0;

  [[nodiscard]] bool continuous() const { return values.empty(); }
  /// The value at `share` (0 <= share < 1) of the way.
  [[nodiscard]] double at(double share) const;
};

/// Reads `key`: 1.5, [1, 2, 4] or { from = -4, to = 4, step = 0.25 }, each value within `range`. Without
/// `step` only where `sampled`. Values of a range are decimal numbers of at most nine places, so that 0.3 is
/// 0.3. Nullopt where the key is absent.
[[nodiscard]] std::optional<Sweep> read_sweep(const TomlTable& table, std::string_view key, Range range,
                                              bool sampled);

/// Numbers from 0 to 1 (1 excluded), the same everywhere: 53 bits of the Mersenne twister MT19937-64. Each
/// `stream` of a seed is a sequence of its own.
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

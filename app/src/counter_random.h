// Random numbers without a state: a number is a function of what it is for, so that it is the same whatever
// was drawn before it, in whichever thread, process or order.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace catoptra::app {

/// The block cipher Philox4x32 with ten rounds. Source: Salmon et al. 2011, whose known answers are tested.
[[nodiscard]] std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                      std::array<std::uint32_t, 2> key);

/// Which number: that of `field` ("panto_deg") in draw `number` (from 0) of a sample with `seed`. Fields are
/// independent of one another, as are draws and seeds.
struct RandomNumber {
  std::uint32_t seed = 0;
  std::uint64_t number = 0;
  std::string_view field;

  /// Evenly from 0 to 1 (1 excluded), in steps of 2^-53. `attempt`: further numbers of the same draw.
  [[nodiscard]] double uniform(std::uint32_t attempt = 0) const;

  /// Normally with mean 0 and standard deviation 1. Only additions, multiplications, divisions and square
  /// roots, which IEEE 754 rounds alike everywhere (the C library's logarithm is not). Source: inversion by
  /// algorithm AS 241, relative error 1e-16 (Wichura 1988).
  [[nodiscard]] double normal(std::uint32_t attempt = 0) const;
};

/// The quantile of the standard normal distribution at `p`, 0 < p < 1.
[[nodiscard]] double normal_quantile(double p);

}  // namespace catoptra::app

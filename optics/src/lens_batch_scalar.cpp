// The batch kernels one ray at a time, for any machine.
#include "optics/src/lens_batch_kernel.h"
#include "optics/src/lens_wave_kernel.h"

namespace catoptra::optics::lens_batch {
namespace {

using Real = double;
using Index = std::int64_t;
using Mask = bool;
constexpr int kLanes = 1;

inline Real splat(double x) {
  return x;
}
inline Real load(const double* from, std::size_t) {
  return *from;
}
inline void store(double* to, Real x, std::size_t) {
  *to = x;
}
inline Real root(Real x) {
  return __builtin_sqrt(x);
}
inline Real gather(const double* base, Index i) {
  return base[i];
}
inline bool all(Mask m) {
  return m;
}
template <class T>
inline T lane(T x, int) {
  return x;
}
inline void set_lane(Index& x, int, std::int64_t value) {
  x = value;
}

#include "optics/src/lens_batch_kernel.inl"

#include "optics/src/lens_wave_kernel.inl"

}  // namespace

void trace_scalar(const Lens& lens, const Rays& rays) {
  trace(lens, rays);
}

void trace_waves_scalar(const WaveLens& lens, const WaveRays& rays) {
  trace_waves(lens, rays);
}

}  // namespace catoptra::optics::lens_batch

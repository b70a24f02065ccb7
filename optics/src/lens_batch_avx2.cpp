// The batch kernels for 4 rays at once, compiled for AVX2 and FMA.
#include <immintrin.h>

#include "optics/src/lens_batch_kernel.h"
#include "optics/src/lens_wave_kernel.h"

namespace catoptra::optics::lens_batch {
namespace {

typedef double Real __attribute__((vector_size(32)));
typedef std::int64_t Index __attribute__((vector_size(32)));
using Mask = Index;
constexpr int kLanes = 4;

inline Real root(const Real& x) {
  return _mm256_sqrt_pd(x);
}
inline Real gather(const double* base, const Index& i) {
  return _mm256_i64gather_pd(base, __m256i(i), 8);
}
inline bool all(const Mask& m) {
  return _mm256_movemask_pd(__m256d(m)) == 0xf;
}

#include "optics/src/lens_batch_vector.inl"

#include "optics/src/lens_batch_kernel.inl"

#include "optics/src/lens_wave_kernel.inl"

}  // namespace

void trace_avx2(const Lens& lens, const Rays& rays) {
  trace(lens, rays);
}

void trace_waves_avx2(const WaveLens& lens, const WaveRays& rays) {
  trace_waves(lens, rays);
}

}  // namespace catoptra::optics::lens_batch

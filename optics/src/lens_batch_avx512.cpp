// The batch kernels for 8 rays at once, compiled for AVX-512 F and DQ.
#include <immintrin.h>

#include "optics/src/lens_batch_kernel.h"
#include "optics/src/lens_wave_kernel.h"

namespace catoptra::optics::lens_batch {
namespace {

typedef double Real __attribute__((vector_size(64)));
typedef std::int64_t Index __attribute__((vector_size(64)));
using Mask = Index;
constexpr int kLanes = 8;

inline Real root(const Real& x) {
  return _mm512_maskz_sqrt_pd(0xff, x);
}
inline Real gather(const double* base, const Index& i) {
  return _mm512_mask_i64gather_pd(Real{}, 0xff, __m512i(i), base, 8);
}
inline bool all(const Mask& m) {
  return _mm512_movepi64_mask(__m512i(m)) == 0xff;
}

#include "optics/src/lens_batch_vector.inl"

#include "optics/src/lens_batch_kernel.inl"

#include "optics/src/lens_wave_kernel.inl"

}  // namespace

void trace_avx512(const Lens& lens, const Rays& rays) {
  trace(lens, rays);
}

void trace_waves_avx512(const WaveLens& lens, const WaveRays& rays) {
  trace_waves(lens, rays);
}

}  // namespace catoptra::optics::lens_batch

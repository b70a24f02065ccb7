// What the compilations of the chief-ray kernel share: plain data, as in lens_batch_kernel.h.
#pragma once

#include <cstddef>
#include <cstdint>

#include "optics/src/lens_batch_kernel.h"

namespace catoptra::optics::lens_batch {

/// A lens seen from the eye, and what is asked of it.
struct WaveLens {
  Surface back, front;
  double eta = 1;               ///< index around / index of the lens
  double object_curvature = 0;  ///< of the arriving wave at the front, 1/mm
  bool along_normal = false;    ///< rays go on along the normal of the back surface
  bool coloured = false;        ///< also the directions at two other indices
  double eta_f = 1, eta_c = 1;
};

/// Arrays of `count` values each.
struct WaveRays {
  std::size_t count = 0;
  const double* ray[6];  ///< in: origin and unit direction
  double* back[3];       ///< point on the back surface
  double* eye_side[3];
  double* object_side[3];
  double* wave[6];  ///< of the light that leaves the back: xx, xy, xz, yy, yz, zz
  double* colour_f[3];
  double* colour_c[3];
  double* uv[4];          ///< on the back and on the front, for the trimming test
  double* uv_colour[4];   ///< on the front at F and at C
  std::uint8_t* outcome;  ///< kPassed, or kUnclear for every other end
};

void trace_waves_scalar(const WaveLens& lens, const WaveRays& rays);
void trace_waves_avx2(const WaveLens& lens, const WaveRays& rays);
void trace_waves_avx512(const WaveLens& lens, const WaveRays& rays);

}  // namespace catoptra::optics::lens_batch

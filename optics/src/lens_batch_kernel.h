// What the three compilations of the batch kernel share: plain data, so that no function compiled for one
// instruction set can be linked into code for another.
#pragma once

#include <cstddef>
#include <cstdint>

namespace catoptra::optics::lens_batch {

/// The spans of one parameter. The first span begins at -infinity and the last ends at infinity.
struct Axis {
  const double* low = nullptr;
  const double* high = nullptr;
  const double* middle = nullptr;
  const double* rate = nullptr;          ///< d local / d parameter
  const std::int32_t* bucket = nullptr;  ///< even buckets over the domain -> a span at or near
  double bucket_begin = 0, bucket_rate = 0;
  std::int32_t bucket_count = 1;
  double begin = 0, end = 1;  ///< the domain
};

/// One side: its polynomial pieces as BSplineSurface lays them out, and where the Newton iteration starts.
struct Surface {
  Axis u, v;
  const double* coefficients = nullptr;
  std::int32_t degree_u = 3, degree_v = 3, spans_v = 1;
  bool rational = false;
  double origin[3] = {0, 0, 0};  ///< coefficients are relative to it
  double orientation = 1;
  // The plane through its middle, relative to `origin`: point, two axes, normal; heights over it as
  // a + b x + c y + d x^2 + e x y + f y^2; u and v as a + b x + c y.
  double plane_point[3] = {0, 0, 0}, axis_x[3] = {1, 0, 0}, axis_y[3] = {0, 1, 0}, normal[3] = {0, 0, 1};
  double height[6] = {0, 0, 0, 0, 0, 0}, start_u[3] = {0, 0, 0}, start_v[3] = {0, 0, 0};
};

struct Lens {
  Surface entry, exit;
  double eta = 1;  ///< index around / index of the lens
};

/// Arrays of `count` values each.
struct Rays {
  std::size_t count = 0;
  const double *origin_x, *origin_y, *origin_z, *direction_x, *direction_y, *direction_z;
  double *exit_x, *exit_y, *exit_z, *outside_x, *outside_y, *outside_z, *transmittance;
  double *entry_u, *entry_v, *exit_u, *exit_v;  ///< for the trimming test
  std::uint8_t* outcome;                        ///< see Outcome
};

/// What the kernel found. `unclear` paths did not converge on both surfaces, or in another order than a lens
/// is passed.
enum Outcome : std::uint8_t { kPassed, kTotalReflection, kUnclear };

void trace_scalar(const Lens& lens, const Rays& rays);
void trace_avx2(const Lens& lens, const Rays& rays);
void trace_avx512(const Lens& lens, const Rays& rays);

}  // namespace catoptra::optics::lens_batch

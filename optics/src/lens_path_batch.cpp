#include "optics/lens_path_batch.h"

#include <algorithm>

#include "cad_import/bspline_surface.h"
#include "cad_import/error.h"
#include "optics/src/lens_batch_surface.h"
#include "optics/src/trim_grid.h"

namespace catoptra::optics {
namespace {

// Rays per call of the kernel: their parameters stay in the first-level cache for the trimming test.
constexpr std::size_t kChunk = 256;

bool side_supported(const LensSideView& side) {
  if (side.faces.size() != 1) return false;
  const auto* spline = side.faces[0].surface->as_bspline();
  return spline && spline->power_basis() && spline->axis_u().period() == 0 && spline->axis_v().period() == 0;
}

using Kernel = void (*)(const lens_batch::Lens&, const lens_batch::Rays&);

Kernel kernel_for(SimdLevel level) {
#ifdef CATOPTRA_X86_KERNELS
  const SimdLevel lowered = std::min(level, best_simd_level());
  if (lowered == SimdLevel::avx512) return lens_batch::trace_avx512;
  if (lowered == SimdLevel::avx2) return lens_batch::trace_avx2;
#endif
  return lens_batch::trace_scalar;
}

}  // namespace

LensRayBatch::LensRayBatch(std::size_t count) {
  for (auto* values : {&origin_x, &origin_y, &origin_z, &direction_x, &direction_y, &direction_z, &exit_x,
                       &exit_y, &exit_z, &outside_x, &outside_y, &outside_z, &transmittance})
    values->assign(count, 0.0);
  end.assign(count, LensPathEnd::missed);
}

LensRayBatch::LensRayBatch(std::span<const Ray> rays) : LensRayBatch(rays.size()) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    origin_x[i] = rays[i].origin_mm.x;
    origin_y[i] = rays[i].origin_mm.y;
    origin_z[i] = rays[i].origin_mm.z;
    direction_x[i] = rays[i].direction.x;
    direction_y[i] = rays[i].direction.y;
    direction_z[i] = rays[i].direction.z;
  }
}

std::string_view simd_level_name(SimdLevel level) {
  switch (level) {
    case SimdLevel::avx512:
      return "AVX-512";
    case SimdLevel::avx2:
      return "AVX2";
    case SimdLevel::scalar:
      break;
  }
  return "scalar";
}

SimdLevel best_simd_level() {
#ifdef CATOPTRA_X86_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) return SimdLevel::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return SimdLevel::avx2;
#endif
  return SimdLevel::scalar;
}

struct LensBatchTracer::Impl {
  LensSide entered;
  LensIndices indices;
  LensBatchSurface entry, exit;
  TrimGrid entry_trim, exit_trim;
  lens_batch::Lens lens;
  LensTracer one_by_one;

  Impl(const Optic& optic, LensSide side, const LensIndices& index)
      : entered(side),
        indices(index),
        entry(side_of(optic, side).faces[0]),
        exit(side_of(optic, other_side(side)).faces[0]),
        entry_trim(side_of(optic, side).faces[0]),
        exit_trim(side_of(optic, other_side(side)).faces[0]),
        lens{entry.surface(), exit.surface(), index.around / index.lens},
        one_by_one(optic) {}

  // Trims what the kernel found, and asks the single-ray tracer where a path does not pass.
  void finish(LensRayBatch& batch, std::size_t i, std::uint8_t outcome, const double (&uv)[4]) const {
    const bool met = outcome != lens_batch::kUnclear && entry_trim.contains(uv[0], uv[1]) &&
                     exit_trim.contains(uv[2], uv[3]);
    if (met && outcome == lens_batch::kPassed) {
      batch.end[i] = LensPathEnd::passed;
      return;
    }
    batch.transmittance[i] = 0;
    batch.end[i] = LensPathEnd::total_reflection;
    if (met) return;
    const Ray ray{{batch.origin_x[i], batch.origin_y[i], batch.origin_z[i]},
                  {batch.direction_x[i], batch.direction_y[i], batch.direction_z[i]}};
    const LensPath path = one_by_one.trace(ray, entered, indices);
    batch.end[i] = path.end;
    if (path.end != LensPathEnd::passed) return;
    batch.exit_x[i] = path.exit.position_mm.x;
    batch.exit_y[i] = path.exit.position_mm.y;
    batch.exit_z[i] = path.exit.position_mm.z;
    batch.outside_x[i] = path.outside.x;
    batch.outside_y[i] = path.outside.y;
    batch.outside_z[i] = path.outside.z;
    batch.transmittance[i] = path.transmittance;
  }

  void trace_chunk(LensRayBatch& batch, std::size_t first, std::size_t count, Kernel kernel) const {
    double uv[4][kChunk];
    std::uint8_t outcome[kChunk];
    kernel(
        lens,
        {count, batch.origin_x.data() + first, batch.origin_y.data() + first, batch.origin_z.data() + first,
         batch.direction_x.data() + first, batch.direction_y.data() + first, batch.direction_z.data() + first,
         batch.exit_x.data() + first, batch.exit_y.data() + first, batch.exit_z.data() + first,
         batch.outside_x.data() + first, batch.outside_y.data() + first, batch.outside_z.data() + first,
         batch.transmittance.data() + first, uv[0], uv[1], uv[2], uv[3], outcome});
    for (std::size_t k = 0; k < count; ++k)
      finish(batch, first + k, outcome[k], {uv[0][k], uv[1][k], uv[2][k], uv[3][k]});
  }
};

bool LensBatchTracer::supported(const Optic& lens) {
  return lens.kind == OpticKind::lens && side_supported(side_of(lens, LensSide::front)) &&
         side_supported(side_of(lens, LensSide::back));
}

LensBatchTracer::LensBatchTracer(const Optic& lens, LensSide entered, const LensIndices& indices) {
  if (!supported(lens))
    throw Error("", lens.name, "is not made of one B-spline face a side", "trace its rays one by one");
  impl_ = std::make_unique<Impl>(lens, entered, indices);
}
LensBatchTracer::~LensBatchTracer() = default;
LensBatchTracer::LensBatchTracer(LensBatchTracer&&) noexcept = default;

LensRayBatch LensBatchTracer::trace(LensRayBatch batch, SimdLevel level) const {
  const Kernel kernel = kernel_for(level);
  for (std::size_t first = 0; first < batch.size(); first += kChunk)
    impl_->trace_chunk(batch, first, std::min(kChunk, batch.size() - first), kernel);
  return batch;
}

}  // namespace catoptra::optics

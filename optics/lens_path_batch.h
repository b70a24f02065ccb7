// Many rays through a lens of two B-spline surfaces at once: for maps of a lens, whose rays count in
// millions.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "optics/lens_path.h"

namespace catoptra::optics {

/// Rays and results as structure of arrays; all vectors have size() entries.
struct LensRayBatch {
  std::vector<double> origin_x, origin_y, origin_z;           ///< in, mm
  std::vector<double> direction_x, direction_y, direction_z;  ///< in, unit
  std::vector<double> exit_x, exit_y, exit_z;                 ///< out, mm; valid where passed
  std::vector<double> outside_x, outside_y, outside_z;        ///< out, unit; valid where passed
  std::vector<double> transmittance;                          ///< out; see LensPath
  std::vector<LensPathEnd> end;                               ///< out

  explicit LensRayBatch(std::size_t count = 0);
  explicit LensRayBatch(std::span<const Ray> rays);
  [[nodiscard]] std::size_t size() const { return end.size(); }
};

/// The instruction sets that the batch is compiled for. Results agree to 1e-12 mm and 1e-12 rad.
enum class SimdLevel { scalar, avx2, avx512 };
[[nodiscard]] std::string_view simd_level_name(SimdLevel level);
/// The widest that this machine can run.
[[nodiscard]] SimdLevel best_simd_level();

/// Traces batches through a lens both sides of which are one B-spline face. The Newton iteration starts from
/// a quadric over the plane through each surface's middle, without a search in a mesh; trimming is tested.
/// Paths that do not pass so are traced again by LensTracer, which says why. Immutable, thread-safe; a batch
/// is traced on the calling thread, so many threads take a batch each.
class LensBatchTracer {
 public:
  /// Whether both sides are one B-spline face of at most degree BSplineSurface::kMaxPowerDegree, without
  /// period.
  [[nodiscard]] static bool supported(const Optic& lens);

  /// Keeps a reference to `lens`, which must outlive it. Throws catoptra::Error where it is not supported().
  LensBatchTracer(const Optic& lens, LensSide entered, const LensIndices& indices);
  ~LensBatchTracer();
  LensBatchTracer(LensBatchTracer&&) noexcept;

  /// Fills the results of `batch`. A level that the machine cannot run is lowered to the best it can.
  [[nodiscard]] LensRayBatch trace(LensRayBatch batch, SimdLevel level = best_simd_level()) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptra::optics

// Many chief rays of a lens at once, several per instruction where both sides are one B-spline face.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "optics/lens_path_batch.h"
#include "optics/src/lens_chief_ray.h"

namespace catoptra::optics {

/// Traces chief rays. Immutable after construction, thread-safe.
class ChiefRays {
 public:
  /// Rays that one call of trace() takes.
  static constexpr std::size_t kMost = 64;

  explicit ChiefRays(const Optic& lens);
  ~ChiefRays();
  ChiefRays(ChiefRays&&) noexcept;

  /// At most kMost rays, on the calling thread. The level matters only where the lens is a LensBatchTracer's
  /// too; rays that do not pass in its way are traced again, one by one. Levels agree to 1e-12 of a result's
  /// size.
  [[nodiscard]] std::vector<ChiefRay> trace(std::span<const Ray> rays, const ChiefRayTask& task,
                                            SimdLevel level = best_simd_level()) const;

  [[nodiscard]] const ChiefRayTracer& one_by_one() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptra::optics

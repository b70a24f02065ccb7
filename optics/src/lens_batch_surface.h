// A B-spline face laid out for the batch kernel.
#pragma once

#include <cstdint>
#include <vector>

#include "cad_import/bspline_surface.h"
#include "cad_import/cad_model.h"
#include "optics/src/lens_batch_kernel.h"

namespace catoptra::optics {

/// The tables that a lens_batch::Surface points into. Moves keep them valid; copies are not allowed.
class LensBatchSurface {
 public:
  /// `face` has a power-basis B-spline, which must outlive this.
  explicit LensBatchSurface(const cad_import::Face& face);
  LensBatchSurface(LensBatchSurface&&) noexcept = default;

  [[nodiscard]] const lens_batch::Surface& surface() const { return surface_; }

 private:
  struct AxisTables {
    std::vector<double> low, high, middle, rate;
    std::vector<std::int32_t> bucket;
    lens_batch::Axis axis;
  };
  static AxisTables tables_of(const cad_import::SpanAxis& axis, double begin, double end);
  void fit_start(const cad_import::Face& face);

  AxisTables u_, v_;
  lens_batch::Surface surface_;
};

}  // namespace catoptra::optics

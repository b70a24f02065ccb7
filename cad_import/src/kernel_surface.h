// Surfaces that the CAD kernel evaluates: revolution, extrusion, offset and whatever else it reads.
#pragma once

#include <Geom_Surface.hxx>

#include "cad_import/exact_surface.h"
#include "cad_import/src/affine_map.h"

namespace catoptra::cad_import {

/// Asks the Geom_Surface itself, which keeps no cache (its adaptors do), so that many threads may ask at
/// once.
class KernelSurface final : public ExactSurface {
 public:
  KernelSurface(Handle(Geom_Surface) surface, SurfaceKind kind, const AffineMap& map,
                const ParameterDomain& domain, double orientation)
      : surface_(std::move(surface)), kind_(kind), map_(map), domain_(domain), orientation_(orientation) {}

  [[nodiscard]] SurfaceKind kind() const override { return kind_; }
  [[nodiscard]] ParameterDomain domain() const override { return domain_; }
  [[nodiscard]] double orientation() const override { return orientation_; }
  [[nodiscard]] glm::dvec3 point(double u, double v) const override;
  [[nodiscard]] SurfaceFrame d1(double u, double v) const override;
  [[nodiscard]] SurfaceDerivatives d2(double u, double v) const override;

 private:
  Handle(Geom_Surface) surface_;
  SurfaceKind kind_;
  AffineMap map_;
  ParameterDomain domain_;
  double orientation_;
};

}  // namespace catoptra::cad_import

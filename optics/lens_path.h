// A ray through a lens: in at one exact surface, out at the other (or the reason why not).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>

#include "optics/exact_hit.h"
#include "optics/optic.h"
#include "optics/ray_packet.h"
#include "optics/ray_scene.h"

namespace catoptra::optics {

/// How a path ends. All but `passed` are results, not errors.
enum class LensPathEnd : std::uint8_t {
  passed,            ///< left through the other surface
  total_reflection,  ///< met the other surface beyond the critical angle (or entered a thinner medium beyond
                     ///< it)
  rim,               ///< did not meet the other surface: it left through the rim
  missed,            ///< did not meet the lens
};

/// A path from the entering surface on. `entry` is valid unless missed; `inside` too unless the light never
/// entered; `exit` where passed or totally reflected at the exit; `outside` where passed.
struct LensPath {
  LensPathEnd end = LensPathEnd::missed;
  ExactHit entry, exit;
  glm::dvec3 inside{0}, outside{0};  ///< unit directions in the lens and behind it
  double transmittance = 0;          ///< Fresnel, unpolarised, both surfaces; 0 unless passed
};

/// Which of the lens's two sides a ray enters first.
enum class LensSide : std::uint8_t { front, back };

[[nodiscard]] LensSide other_side(LensSide side);

/// The faces and mesh of one side, as a view into the lens.
struct LensSideView {
  std::span<const cad_import::Face> faces;
  const tessellate::OpticArrays* mesh = nullptr;
};
[[nodiscard]] LensSideView side_of(const Optic& lens, LensSide side);

/// Indices at one wavelength.
struct LensIndices {
  double lens = 1.5, around = 1;
};
[[nodiscard]] LensIndices lens_indices(const Optic& lens, double wavelength_nm);

/// The side of `lens` whose outward normals, weighted by area, look towards `eye_mm`.
[[nodiscard]] LensSide side_towards(const Optic& lens, const glm::dvec3& eye_mm);

/// Traces paths through one lens. Immutable after construction; thread-safe.
class LensTracer {
 public:
  /// Keeps a reference to `lens`, which must outlive it. Throws catoptra::Error where a side has no face or
  /// no mesh.
  explicit LensTracer(const Optic& lens);
  ~LensTracer();
  LensTracer(LensTracer&&) noexcept;

  /// The whole path of `ray`, which starts outside the lens.
  [[nodiscard]] LensPath trace(const Ray& ray, LensSide entered, const LensIndices& indices) const;

  /// The same where the entry is known already (a mesh vertex, or a pixel's exact hit).
  [[nodiscard]] LensPath trace_from(const Ray& ray, const ExactHit& entry, LensSide entered,
                                    const LensIndices& indices) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptra::optics

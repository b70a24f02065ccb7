// One chief ray of a lens: traced backwards from the eye, with the wave that the object sends along it.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "optics/lens_path.h"
#include "optics/wavefront.h"

namespace catoptra::optics {

/// What is known of a chief ray. Everything but `end` is valid only where passed; `back_mm` and `eye_side`
/// also where the back was met.
struct ChiefRay {
  LensPathEnd end = LensPathEnd::missed;
  glm::dvec3 back_mm{0};   ///< where it meets the back surface
  glm::dvec3 eye_side{0};  ///< unit directions from the eye to the object
  glm::dvec3 object_side{0};
  Wavefront wave;         ///< of the light that leaves the back surface along -eye_side
  bool coloured = false;  ///< the next two are there: asked for, and passed
  glm::dvec3 object_side_f{0}, object_side_c{0};
};

/// How a ray that comes from the eye's side goes on from the back surface.
enum class ChiefRayKind {
  straight,          ///< as it came: the line of sight
  along_the_normal,  ///< along the normal of the back surface: the focimeter
};

/// What is asked of every ray.
struct ChiefRayTask {
  ChiefRayKind kind = ChiefRayKind::straight;
  LensIndices indices;
  double object_distance_mm =
      kInfinity;          ///< of a point that sends the light, from the front; infinite: a plane wave
  bool coloured = false;  ///< also the object-side directions at two other indices
  LensIndices indices_f, indices_c;
};

/// Traces chief rays through one lens, one by one.
class ChiefRayTracer {
 public:
  explicit ChiefRayTracer(const Optic& lens) : lens_(lens), tracer_(lens) {}

  [[nodiscard]] ChiefRay trace(const Ray& ray, const ChiefRayTask& task) const;

  /// How the object-side direction turns when the eye-side ray turns about its origin: columns are the
  /// derivatives by turns along `x` and `y`, which are across the ray. Where the ray passes.
  struct Turning {
    glm::dvec3 object_side{0};
    glm::dvec3 by_x{0}, by_y{0};
  };
  [[nodiscard]] std::optional<Turning> turning(const Ray& ray, const glm::dvec3& x, const glm::dvec3& y,
                                               const LensIndices& indices) const;

 private:
  [[nodiscard]] cad_import::SurfaceDerivatives derivatives(LensSide side, const ExactHit& hit) const;

  const Optic& lens_;
  LensTracer tracer_;
};

}  // namespace catoptra::optics

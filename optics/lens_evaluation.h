// What a lens does to the light, in numbers: chief rays through its exact surfaces, with the wavefront's
// curvature carried along, as a focimeter sees it or as it is worn.
//
// Frames (docs/conventions.md): the lens's own has z from the back to the front (towards the object), x right
// and y up for someone who faces the wearer. The wearer's has the same sense, z straight ahead of the eye;
// the two differ by the lens's tilt. Points are in the lens's frame. Directions, powers and prism are in the
// lens's frame for a focimeter and in the wearer's for a lens as worn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cad_import/lens_faces.h"
#include "optics/dispersion.h"
#include "optics/lens_path.h"
#include "optics/lens_power.h"
#include "optics/optic.h"

namespace catoptra::optics {

/// The lens's frame in model coordinates. Right-handed, orthonormal.
struct LensFrame {
  glm::dvec3 front_vertex_mm{0}, back_vertex_mm{0};
  glm::dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

/// The frame of a recognised lens: z its axis; y the direction nearest to `up` across it (where `up` runs
/// along the axis: the model's +z, else +y).
[[nodiscard]] LensFrame lens_frame(const cad_import::LensGeometry& geometry,
                                   const glm::dvec3& up = {0, 1, 0});

enum class EvaluationMode {
  /// Parallel beam normal to the back surface at the point (focal point on axis); power at the surface there.
  lensmeter,
  /// Chief rays through the eye's rotation centre; powers on the vertex sphere.
  as_worn,
};

enum class Eye { right, left };

/// How the lens sits before the eye. The line of sight straight ahead meets the back vertex, about which the
/// lens is turned (pantoscopic angle first, then wrap), so that the distances below hold for every tilt.
struct WearingPosition {
  double rotation_centre_mm = 25;  ///< back vertex to the eye's centre of rotation, > 0
  double vertex_distance_mm = 12;  ///< back vertex to the cornea, > 0; the entrance pupil is 3 mm farther
  double pantoscopic_rad = 0;      ///< positive: the lower rim turned towards the face
  double wrap_rad = 0;             ///< positive: the temporal rim turned towards the face
  Eye eye = Eye::right;            ///< temporal is -x for the right eye, +x for the left
};

/// The wearer's axes in model coordinates, with the lens's vertices: z straight ahead, x and y as for someone
/// who faces the wearer. The lens's own axes where it is not tilted.
[[nodiscard]] LensFrame wearer_frame(const LensFrame& lens, const WearingPosition& position);

struct EvaluationOptions {
  EvaluationMode mode = EvaluationMode::lensmeter;
  WearingPosition position;
  /// As worn: from the front surface along the chief ray, > 0. Powers are then what the lens adds to that
  /// object's vergence (at the front surface) by the time the wave is at the vertex sphere.
  double object_distance_mm = std::numeric_limits<double>::infinity();
  double wavelength_nm = kLineD_nm;
  bool chromatic = true;    ///< also trace at F and C, for transverse colour
  std::size_t threads = 0;  ///< 0: all. Results do not depend on it.
};

/// One point of a lens. Unless `end` is passed, only gaze and point have a meaning, and of these the one that
/// was not asked for only where the ray met the back surface.
struct LensPoint {
  LensPathEnd end = LensPathEnd::missed;
  /// Wearer's frame, horizontal (+: towards +x) and vertical (+: up): the line from the rotation centre to
  /// the point runs along (tan h, tan v, 1). As worn it is the eye-side ray.
  glm::dvec2 gaze_rad{0};
  glm::dvec2 point_mm{0};  ///< lens's frame, x and y of the back surface's point
  /// In the axes that the shortest rotation of z into the eye-side ray makes of x and y (Listing).
  PowerMatrix power;
  double tangential_d = 0;  ///< power along the plane of z and gaze (focimeter: and the point; on z: along x)
  double sagittal_d = 0;    ///< and across it
  double mean_power_error_d = 0;  ///< mean power minus that at the reference
  /// Cylinder that is not the reference's: |J - J_ref| x 2; with the sign of tangential - sagittal where the
  /// reference has no cylinder (less than 0.005 D).
  double oblique_astigmatism_d = 0;
  glm::dvec2 prism{0};  ///< prism dioptre, base to +x and up: 100 tan of the deviation, by its components
  glm::dvec2 object_rad{0};  ///< direction of the object-side ray, as gaze_rad
  /// As worn: tan(object angle) / tan(gaze angle) over its paraxial value, minus 1, with tangents counted
  /// from straight ahead; 0 there and for a focimeter.
  double distortion = 0;
  double transverse_colour = 0;  ///< prism dioptre between F and C, >= 0, along the same eye-side ray
};

struct LensEvaluation {
  SphereCylinder reference;       ///< by the focimeter at the back vertex, minus cylinder
  glm::dvec2 reference_prism{0};  ///< there, as LensPoint::prism
  /// Of a distant object straight ahead: paraxial, at the entrance pupil, of the lens as positioned; the
  /// geometric mean of the principal meridians.
  double spectacle_magnification = 1;
  std::vector<LensPoint> points;  ///< in the order asked for
};

/// Measures one lens. Immutable after construction; thread-safe. Lenses that a LensBatchTracer takes are
/// measured several rays per instruction, others ray by ray.
class LensEvaluator {
 public:
  /// Keeps a reference to `lens`, which must outlive it. Throws catoptra::Error where a side is missing.
  LensEvaluator(const Optic& lens, const LensFrame& frame);
  ~LensEvaluator();
  LensEvaluator(LensEvaluator&&) noexcept;

  /// At gaze directions (as LensPoint::gaze_rad); with EvaluationMode::lensmeter at the points of the back
  /// surface that these directions meet from the rotation centre. Throws catoptra::Error for options out of
  /// range, and where the lens lets no light through at its back vertex.
  [[nodiscard]] LensEvaluation at_gaze(std::span<const glm::dvec2> gaze_rad,
                                       const EvaluationOptions& options) const;

  /// At points (x, y) of the back surface, mm.
  [[nodiscard]] LensEvaluation at_points(std::span<const glm::dvec2> points_mm,
                                         const EvaluationOptions& options) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The square grid of directions within a circle of `max_rad` about straight ahead, rows from the top,
/// `step_rad` > 0 apart; always with (0, 0).
[[nodiscard]] std::vector<glm::dvec2> gaze_grid(double max_rad, double step_rad);

}  // namespace catoptra::optics

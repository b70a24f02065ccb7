// Spectacle lenses to order: from a prescription to two exact surfaces and a rim, in memory or as a STEP
// solid.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "cad_import/cad_model.h"
#include "cad_import/error.h"
#include "cad_import/outline.h"

namespace catoptra::cad_import {

/// The front's profile, of curvature c = front curve / (1000 (n - 1)), falling from the vertex by
///   sphere, conic, asphere: c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + a_2 r^4 + a_3 r^6 + ...
///   freeform: an umbilical meridian x = 0 whose curvature rises from c at the vertex to c + addition at
///   `corridor_mm` along the arc below it, with circles of the same curvature across (Koeppen's elephant's
///   trunk, the curvature four times differentiable along the meridian).
enum class LensFrontForm { sphere, conic, asphere, freeform };

/// The back's form away from its vertex, where all forms have the same two curvatures.
///   toric: a circle turned about an axis in its plane, as the trade grinds and ISO 13666 defines. The
///   steeper principal section is the circle, the flatter one the way of its vertex (a tyre); a sphere where
///   both are equal, a cylinder where one is flat. biconic: z = (c1 x^2 + c2 y^2) / (1 + sqrt(1 - (1 + k)
///   (c1^2 x^2 + c2^2 y^2))), whose principal sections are circles too (conics for k != 0, which makes it
///   atoric); between them it departs from the torus with the fourth power of the distance.
enum class LensBackForm { toric, biconic };

/// A lens to order in the frame of docs/conventions.md: front vertex at the origin, front towards +z, x right
/// and y up for someone who looks at the front. Powers are back vertex powers, light coming along the axis.
/// The prescription holds exactly along the axis; with prism it refers to the deviated ray, and its axes to
/// those that the rotation from the lens's axis to that ray makes of x and y.
struct LensBlank {
  double index = 1.5;         ///< of the lens, at the reference wavelength, > 1
  double sphere_d = 0;        ///< first principal power
  double cylinder_d = 0;      ///< second minus first, either sign
  double axis_deg = 0;        ///< of the cylinder, TABO, 0..180
  double addition_d = 0;      ///< freeform only: growth of the front's power, >= 0
  double corridor_mm = 14;    ///< freeform only: over which the addition grows, > 0
  double prism_d = 0;         ///< prism dioptre at the reference point, >= 0
  double prism_base_deg = 0;  ///< 0..360, TABO
  /// Front power (n - 1) / R; left out: Vogel's rule for the mean power M, M + 6 (plus) or M / 2 + 6 (minus),
  /// at most 12 D and flat enough for the size. Source: Brooks and Borish 2007, chapter 18.
  std::optional<double> front_curve_d;
  LensFrontForm front = LensFrontForm::sphere;
  double conic = 0;                ///< k of conic and asphere: 0 sphere, -1 paraboloid
  std::vector<double> asphere_mm;  ///< asphere only: a_2 (1/mm^3), a_3 (1/mm^5), ...
  /// Left out: toric, or biconic where `back_conic` needs it.
  std::optional<LensBackForm> back;
  double back_conic = 0;  ///< biconic only: k of both principal sections, not 0 makes it atoric
  /// One of the two, or neither: then at least 2 mm (1.5 mm from index 1.6 on) at the vertex and 1 mm at the
  /// rim.
  std::optional<double> center_thickness_mm;
  std::optional<double> edge_thickness_mm;  ///< least thickness along the rim
  double diameter_mm = 65;                  ///< of a round lens
  std::vector<glm::dvec2> outline;          ///< corners of another shape, around the origin; empty: round
};

/// What came of it. Radii are 0 where flat and positive where the centre lies behind the surface (as for both
/// surfaces of the usual meniscus).
struct LensBlankReport {
  LensBackForm back = LensBackForm::toric;
  double front_curve_d = 0, front_radius_mm = 0;
  double back_radius1_mm = 0, back_radius2_mm = 0;  ///< of the principal sections at the back vertex
  double center_thickness_mm = 0, edge_thickness_min_mm = 0, edge_thickness_max_mm = 0;
};

/// The ideal surfaces of a lens. Immutable, cheap to copy, safe from many threads.
///
/// The back has its form (LensBackForm) in a frame of its own, which the prism tilts at the back vertex. Its
/// curvatures there and their axis follow from the condition that the wavefront that leaves along the
/// deviated ray has the prescribed powers: generalised Coddington equations (Landgrave and Moya-Cessa 1996).
class LensShape {
 public:
  /// Throws Error naming the value at fault: an index or thickness that is none, a radius below the lens's
  /// half diameter, surfaces that cross, values that contradict each other.
  explicit LensShape(const LensBlank& blank);

  /// Height z of the surfaces above (x, y), mm; beyond the rim a smooth continuation.
  [[nodiscard]] double front_z_mm(double x_mm, double y_mm) const;
  [[nodiscard]] double back_z_mm(double x_mm, double y_mm) const;
  [[nodiscard]] const LensBlankReport& report() const;
  [[nodiscard]] const LensBlank& blank() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// The lens as import_cad would read it: one solid with faces `front`, `back` (B-splines of degree 5 within
/// 1e-7 mm of the LensShape, 1e-6 mm at rims that stand almost upright) and `rim` (planes or quarter
/// cylinders). May be called from many threads at once. Throws Error.
[[nodiscard]] CadModel lens_model(const LensShape& shape);

/// Writes the same as a STEP solid in mm, under another name first, read again and checked before it is
/// renamed. Throws Error.
void write_lens(const LensShape& shape, const std::filesystem::path& file);

}  // namespace catoptra::cad_import

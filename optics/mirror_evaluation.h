// A mirror as the rules measure it: principal radii over the glass, spherometers, and what it does to the
// size and sharpness of what one sees in it. Everything on the exact surface. Radii in mm: positive convex,
// negative concave, infinite where straight.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "optics/mirror_glass.h"
#include "optics/ray_packet.h"

namespace catoptra::optics {

/// Radii beyond this are flatness to within what surfaces are made to (18 nm over a spherometer of 38 mm),
/// and count as infinite.
inline constexpr double kStraight_mm = 1e7;

/// Radius of curvature 1/k, with the convention above.
[[nodiscard]] double radius_of_mm(double curvature);

/// Which places of the glass count. Empty: all.
using GlassPart = std::function<bool(const GlassPoint&)>;

/// The glass on a grid over its frame.
struct RadiusMap {
  double step_mm = 0;
  std::vector<GlassPoint> points;  ///< those on the glass, row by row from below
  double min_mm = kInfinity;       ///< 1 / (greatest principal curvature)
  double max_mm = kInfinity;       ///< 1 / (least principal curvature)
  /// Median principal curvatures, 1/mm: those of the spherical part where it is more than half.
  double median_k1 = 0, median_k2 = 0;
  double spherical_share =
      1;  ///< of the points whose principal curvatures are within kSphericalPart of these
};
inline constexpr double kSphericalPart = 0.05;

/// At least `per_side` points along the shorter side.
[[nodiscard]] RadiusMap map_radii(const MirrorGlass& glass, int per_side = 21);

/// Whether a place belongs to the part of constant curvature. An absolute slack of 1 / kStraight_mm goes with
/// it.
[[nodiscard]] bool in_spherical_part(const RadiusMap& map, const GlassPoint& point);

/// What a bar spherometer reads: two feet `base_mm` apart on the surface, in the plane of the surface's
/// normal at `point` and `direction` (any length, made tangential), and a pin half-way that moves square to
/// the bar. With the half distance of the feet c and the pin's travel h, r = (c^2 + h^2) / (2 h). Nullopt
/// where a foot or the pin stands off the glass.
[[nodiscard]] std::optional<double> spherometer_radius_mm(const MirrorGlass& glass, const GlassPoint& point,
                                                          const glm::dvec3& direction, double base_mm);

/// A place where the radius was read.
struct RadiusReading {
  glm::dvec2 xy_mm{0};                   ///< in the glass's frame
  double along_mm = 0;                   ///< r_i: along the arc (R46), or level (FMVSS)
  double across_mm = 0;                  ///< r'_i: across it
  [[nodiscard]] double mean_mm() const;  ///< r_p: (r_i + r'_i) / 2; infinite where either is
};

struct RadiusReadings {
  std::vector<RadiusReading> readings;
  double base_mm = 0;           ///< of the spherometer that fitted
  bool along_upright = true;    ///< direction of the arc (R46)
  double mean_mm = kInfinity;   ///< mean of the readings
  double worst_difference = 0;  ///< greatest |r_i - r'_i| / mean
  double worst_deviation = 0;   ///< greatest |reading - mean| / mean
};

/// UN R46: at 1/3, 1/2 and 2/3 of the arc through the glass's centre parallel to segment b (upright), or of
/// the arc across it where that is longer; within `part`. The base is halved until the feet fit, four times
/// at most; throws catoptra::Error where they never do.
[[nodiscard]] RadiusReadings readings_r46(const MirrorGlass& glass, double base_mm,
                                          const GlassPart& part = {});

/// FMVSS 111, S12: ten readings. Their places are not in the sources at hand: five along the level line
/// through the centre and five along the upright one, evenly spaced over what the instrument can reach, each
/// along its line. Only `along_mm` is read; `across_mm` repeats it.
[[nodiscard]] RadiusReadings readings_fmvss(const MirrorGlass& glass, double base_mm);

/// What an eye sees at a place of the mirror. Magnifications are angular, relative to direct view from the
/// same distance along the ray. Source: the wave of the eye's pencil is reflected (optics/wavefront.h); on a
/// sphere these are 1 / (1 + 2 a / (r cos b)) and 1 / (1 + 2 a cos b / r) for far objects.
struct MirrorView {
  double eye_distance_mm = 0;
  double incidence_rad = 0;
  double tangential = 1, sagittal = 1;  ///< in the plane of incidence, and across it
  double greatest = 1, least = 1;       ///< principal magnifications
  double anisotropy = 1;                ///< greatest / least
  double astigmatism_d =
      0;  ///< difference of the vergences in which an object point's light reaches the eye, dioptre
};
/// Nullopt where the place does not face the eye. `object_distance_mm` is from the mirror to what is seen.
[[nodiscard]] std::optional<MirrorView> mirror_view(const GlassPoint& point, const glm::dvec3& eye_mm,
                                                    double object_distance_mm = kInfinity);

/// Least and greatest of the views over a map.
struct ViewSummary {
  MirrorView center;  ///< at the glass's centre
  double least_magnification = 1, greatest_magnification = 1, mean_magnification = 1;
  double greatest_anisotropy = 1, greatest_astigmatism_d = 0;
};
/// Throws catoptra::Error where the glass's centre does not face the eye.
[[nodiscard]] ViewSummary summarize_view(const MirrorGlass& glass, const RadiusMap& map,
                                         const glm::dvec3& eye_mm, double object_distance_mm = kInfinity);

}  // namespace catoptra::optics

// Mirror glasses to order: a reflecting B-spline face with its outline and thickness, written as a STEP
// solid.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "cad_import/error.h"
#include "cad_import/outline.h"

namespace catoptra::cad_import {

/// The outer strip of a door mirror. From x = boundary_mm to the glass's edge the curvature of the horizontal
/// section through the pole grows from 1/radius linearly with x (a clothoid, for the shallow slopes of a
/// mirror), so that slope and curvature are continuous at the line. UN R46 asks for radii of at least 150 mm
/// there.
struct AsphericPart {
  double boundary_mm = 40;       ///< where the strip begins, measured from the pole; >= 0
  double edge_radius_mm = 300;   ///< horizontal radius of curvature at the edge, in (0, radius)
  bool towards_minus_x = false;  ///< the strip lies on the -x side
};

enum class MirrorOutline { rectangle, rounded, polygon };

/// A mirror glass in its own frame: the pole is the origin, the reflecting side looks to +z, width runs along
/// x and height along y, all in mm. The outline is the glass's projection along z; its side walls run along
/// z, and its back is the front moved by the thickness.
struct MirrorBlank {
  /// Radius of curvature at the pole of the section y = 0: positive for a convex mirror, negative for a
  /// concave one, 0 for straight. Equal radii make a sphere, both 0 a plane, others the biconic surface z =
  /// -(x^2/Rh + y^2/Rv) / (1 + sqrt(1 - x^2/Rh^2 - y^2/Rv^2)).
  double radius_h_mm = 1200;
  double radius_v_mm = 1200;             ///< ... of the section x = 0
  std::optional<AsphericPart> aspheric;  ///< needs a convex sphere inside: radius_h_mm == radius_v_mm > 0
  MirrorOutline outline = MirrorOutline::rectangle;
  double width_mm = 170;         ///< ignored for a polygon
  double height_mm = 110;        ///< ignored for a polygon
  double corner_radius_mm = 20;  ///< rounded only; half of the smaller side makes a round end
  std::vector<glm::dvec2>
      polygon;  ///< polygon only: corners in either sense, not closed, not crossing itself
  double thickness_mm = 2;
};

/// Height z of the ideal reflecting surface above (x, y). Defined where x^2/Rh^2 + y^2/Rv^2 < 1; throws Error
/// elsewhere and for a blank whose description contradicts itself.
[[nodiscard]] double mirror_sag_mm(const MirrorBlank& blank, double x_mm, double y_mm);

/// Writes `blank` as one STEP solid in mm with the faces `Glass` (bicubic B-spline, within 1e-6 mm of
/// mirror_sag_mm), `Back` and `Edge` (every side wall). The file is written under another name in the same
/// folder, read again, checked, and only then renamed. Throws Error, naming the value at fault, for a blank
/// that cannot be made and where the file cannot be written.
void write_mirror_blank(const MirrorBlank& blank, const std::filesystem::path& file);

}  // namespace catoptra::cad_import

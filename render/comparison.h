// How far a picture is from the reference: object-side angle, screen pixels, PSNR, FLIP.
#pragma once

#include <cstddef>
#include <vector>

#include "render/frame.h"
#include "render/scene.h"

namespace catoptra::render {

struct ErrorQuantiles {
  double median = 0, p99 = 0, p999 = 0, max = 0;
};

/// Error of one optic over the pixels where both pictures show it.
struct OpticError {
  std::size_t pixels = 0;          ///< compared
  std::size_t outline_pixels = 0;  ///< shown by one picture only: left out
  /// Left out because both pictures show what touches the optic there (the rim around a glass): so near to
  /// it that the coordinates, which frames keep as floats, do not tell the direction to an arcminute.
  std::size_t touching_pixels = 0;
  /// Wrong: both pictures show the optic first, but then by another sequence of optics (a mirror as a plain
  /// body, a lens left out, another one of two mirrors). No angle tells how wrong: left out of the quantiles.
  std::size_t other_path_pixels = 0;
  /// Angle at the exact last surface point of the path (of the last optic along it) between the exact last
  /// direction and what is shown.
  ErrorQuantiles arcmin;
  /// The same in pixels, through the local derivative of the exact last ray by pixel, among pixels of the
  /// same path. Towards caustics, where that derivative vanishes in one direction or both and no picture
  /// tells one pixel from the next, the optic counts as if it magnified 20 times against the direct view of
  /// the scene's camera.
  ErrorQuantiles screen_px;
  /// Of the pixels compared, those whose picture shows another surface than the exact ray meets: what is
  /// shown lies off the plane of the exact point by more than its angle explains, or one of the two is the
  /// sky.
  std::size_t occlusion_pixels = 0;
  ErrorQuantiles visible_px;  ///< screen_px of the others
};

struct ImageError {
  double psnr_db = 0;         ///< of sRGB-encoded, clamped values; infinite where nothing differs
  double psnr_linear_db = 0;  ///< of linear values, clamped to [0, 1]
  double flip_mean = 0;       ///< LDR-FLIP, Andersson et al. 2020, 67 px/deg
};

struct Comparison {
  std::vector<OpticError> optics;  ///< one per optic of the scene
  ImageError image;
};

/// `reference` must be a raytrace frame with geometry; `frame` one of another mode with geometry, same size:
/// else throws catoptra::Error. Quantiles are nearest-rank; an optic that shows nowhere has 0 pixels and
/// zeros.
[[nodiscard]] Comparison compare(const Frame& reference, const Frame& frame, const Scene& scene);

/// Of pixels whose path is another one in error_map_arcmin(): half a turn, the largest angle there is.
inline constexpr float kOtherPath_arcmin = 180 * 60;

/// Per-pixel error in arcmin (-1 where there is none), for error pictures.
[[nodiscard]] std::vector<float> error_map_arcmin(const Frame& reference, const Frame& frame);

/// Of colour alone. Throws catoptra::Error where the sizes differ.
[[nodiscard]] ImageError image_error(const Frame& reference, const Frame& frame);

}  // namespace catoptra::render

// Scenes that the tests of lenses share: a lens about the origin, front towards +z, the eye at z < 0, a room
// at z > 0; and the exact paths through such a lens, independent of the renderer.
#pragma once

#include <optional>
#include <vector>

#include "optics/lens_path.h"
#include "render/renderer.h"
#include "render/src/sampling.h"
#include "tests/render/raster_test_scene.h"
#include "tests/support/analytic_lens.h"

namespace catoptra::test {

/// A spherical lens in air by its radii (see spherical_lens), of index 1.5 without dispersion, or of
/// `medium`.
inline optics::Optic lens_of(double front_radius_mm, double back_radius_mm, double thickness_mm,
                             double width_mm, int per_side, int wavelengths = 1,
                             const optics::Medium& medium = optics::constant_medium(1.5)) {
  auto lens = spherical_lens(front_radius_mm, back_radius_mm, thickness_mm, width_mm, per_side);
  lens.medium = medium;
  lens.wavelengths = wavelengths;
  return lens;
}

/// The room of raster_test_scene.h seen along +z from `distance_mm` before the origin: +x is at the left.
inline render::Scene room_behind_lens(double distance_mm, double fov_rad) {
  render::Scene scene = room();
  scene.camera = {{0, 0, -distance_mm}, {0, 0, 0}, {0, 1, 0}, fov_rad, {320, 240}};
  return scene;
}

/// One evenly lit wall at z = `depth_mm`, 20 m wide.
inline render::Scene wall_behind_lens(double distance_mm, double fov_rad, float depth_mm) {
  render::Scene scene = room_behind_lens(distance_mm, fov_rad);
  cad_import::TriangleMesh mesh;
  add_quad(mesh, {10000, -10000, depth_mm}, {-20000, 0, 0}, {0, 20000, 0}, glm::vec3(0.5f));
  scene.surroundings = {mesh};
  scene.lights.clear();
  scene.environment.ambient = 1;
  return scene;
}

/// Exact paths of the camera's rays through the scene's lens `optic`.
class ExactPaths {
 public:
  explicit ExactPaths(const render::Scene& scene, std::size_t optic = 0)
      : lens_(scene.optics[optic]),
        tracer_(lens_),
        entered_(optics::side_towards(lens_, scene.camera.eye_mm)),
        rays_(render::camera_rays(scene.camera, scene.camera.resolution.x, scene.camera.resolution.y)) {}

  /// At pixel coordinates (column, row), centres at whole numbers.
  optics::LensPath path(double column, double row, double wavelength_nm = 587.56) const {
    const glm::dvec3 d = glm::normalize(rays_.corner + column * rays_.dx + row * rays_.dy);
    return tracer_.trace({rays_.eye_mm, d}, entered_, optics::lens_indices(lens_, wavelength_nm));
  }

  /// Where the path meets the plane z = `depth_mm`; nullopt where it does not pass.
  std::optional<glm::dvec3> on_wall(double column, double row, double depth_mm,
                                    double wavelength_nm = 587.56) const {
    const auto p = path(column, row, wavelength_nm);
    if (p.end != optics::LensPathEnd::passed) return std::nullopt;
    return p.exit.position_mm + (depth_mm - p.exit.position_mm.z) / p.outside.z * p.outside;
  }

 private:
  const optics::Optic& lens_;
  optics::LensTracer tracer_;
  optics::LensSide entered_;
  render::CameraRays rays_;
};

/// By how many pixels what `frame` shows on the wall is displaced from the exact, through the exact path's
/// own derivative by pixel, for every `step`-th pixel in which both see the wall; ascending.
inline std::vector<double> wall_errors_px(const render::Scene& scene, const render::Frame& frame,
                                          double depth_mm, int step = 1) {
  const ExactPaths exact(scene);
  std::vector<double> errors;
  for (int row = 0; row < frame.height; row += step)
    for (int column = 0; column < frame.width; column += step) {
      const auto i = std::size_t(row) * std::size_t(frame.width) + std::size_t(column);
      const auto at = exact.on_wall(column, row, depth_mm),
                 right = exact.on_wall(column + 0.01, row, depth_mm),
                 down = exact.on_wall(column, row + 0.01, depth_mm);
      if (frame.optic_id[i] != 0 || !at || !right || !down) continue;
      const glm::dmat2 by_pixel{glm::dvec2(*right - *at) / 0.01, glm::dvec2(*down - *at) / 0.01};
      const glm::dvec2 wrong = glm::dvec2(glm::dvec3(glm::vec3(frame.position[i])) - *at);
      errors.push_back(glm::length(glm::inverse(by_pixel) * wrong));
    }
  std::sort(errors.begin(), errors.end());
  return errors;
}

}  // namespace catoptra::test

// Irradiance of lit points: what of each light is seen, directly and by way of planar optics, as the ray
// tracer finds it (docs/decisions/0015, section "Light").
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "optics/ray_scene.h"
#include "render/scene.h"
#include "render/src/scene_lights.h"

namespace catoptra::render {

/// Up to 16 points to be lit, structure of arrays, and their irradiance.
struct alignas(64) LitLanes {
  static constexpr int kLanes = 16;
  // In. All values must be ordinary numbers in every lane, lit or not.
  bool lit[kLanes];
  float x[kLanes], y[kLanes], z[kLanes];     ///< mm
  float nx[kLanes], ny[kLanes], nz[kLanes];  ///< unit, shading
  // In, where some light casts shadows: where shadow rays start. The point on its flat triangle, that
  // triangle's unit normal (of either sense), and the distance along it, mm, that rounding cannot bridge.
  glm::dvec3 start[kLanes], flat_normal[kLanes];
  double margin[kLanes];
  // In and out: linear RGB; irradiance is added.
  float red[kLanes], green[kLanes], blue[kLanes];
};

class Lighting {
 public:
  /// Keeps references to both, which must outlive it. `rays` holds every object in its mask (see
  /// mask_for_rays()), and is asked from the first add() on.
  Lighting(const Scene& scene, const optics::RayScene& rays);

  /// Takes an optic over that has changed.
  void optic_changed(const Scene& scene);

  [[nodiscard]] bool any_shadows() const { return any_shadows_; }

  void add(LitLanes& lanes) const;

 private:
  struct Virtual;
  /// A light's point with its virtual lights.
  struct Source {
    optics::LightPlace place;
    glm::vec3 power;
    bool shadows;
    std::vector<Virtual> virtual_lights;
  };

  void set_lights(const Scene& scene);
  void hide(const Source& source, const LitLanes& lanes, float (&share)[LitLanes::kLanes]) const;
  void add_virtual(const Source& source, std::size_t index, LitLanes& lanes) const;

  const optics::RayScene& rays_;
  std::vector<optics::LightFace> faces_;
  std::vector<double> face_margins_;  ///< as LitLanes::margin
  std::vector<Source> sources_;
  bool any_shadows_ = false;
};

/// A virtual light with the planes of its light volumes.
struct Lighting::Virtual {
  optics::VirtualLight light;
  std::vector<std::vector<glm::dvec4>> volumes;
};

/// Distance in mm along the normal of a triangle or polygon whose coordinates are at most `largest_mm`, that
/// rounding in float cannot bridge: Embree's distances to a plane are right to about 4e-7 of the coordinates,
/// points stored as float to 6e-8.
[[nodiscard]] constexpr double shadow_margin_mm(double largest_mm) {
  return 2e-6 * largest_mm;
}

}  // namespace catoptra::render

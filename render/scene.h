// Everything that a picture is made of, in mm and linear RGB: what `app` builds from a scene file.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "cad_import/triangle_mesh.h"
#include "optics/optic.h"

namespace catoptra::render {

struct Camera {
  glm::dvec3 eye_mm{0, -700, 150};
  glm::dvec3 target_mm{0};
  glm::dvec3 up{0, 0, 1};
  double fov_rad = 0.698;  ///< vertical
  glm::ivec2 resolution{1280, 720};

  /// Diameter of the eye's pupil: each sample of a picture then has its own place in it, and only what lies
  /// in the plane at `focus_mm` before the eye, at right angles to the view, stays sharp. 0: a point. A
  /// picture of one sample shows nothing of it.
  double pupil_mm = 0;
  double focus_mm = 0;  ///< 0: the distance of the target

  // Of one sample; Renderer sets them (see sample_camera in src/sampling.h).
  glm::dvec2 offset_px{0,
                       0};  ///< of the place in every pixel that is shown from its centre; +x right, +y down
  glm::dvec2 shift{0, 0};   ///< of the picture's middle from the axis, as tangents; +x right, +y up
  int sample = 0;           ///< its number in the picture: by it rough optics are tilted

  bool operator==(const Camera&) const = default;
};

enum class LightKind { directional, point, area };

struct Light {
  LightKind kind = LightKind::directional;
  glm::dvec3 direction{0, 0, -1};  ///< unit, in which the light travels (directional)
  glm::dvec3 position_mm{0};       ///< point, area
  glm::vec3 color{1};
  float intensity = 1;   ///< irradiance on a facing surface; for point and area lights, at 1 m
  double radius_mm = 0;  ///< of the soft-shadow disc
  bool shadows = true;
};

struct Environment {
  glm::vec3 color{0.45f, 0.6f, 0.85f};  ///< linear radiance where no `sky` is given
  std::string sky;       ///< path of an equirectangular image; empty: none. +z is up, centre is +y
  float ambient = 0.3f;  ///< irradiance from everywhere, white
};

/// What the raster modes make of a light's disc (the 1994 paper has both): every point a light of its own, or
/// all points shading from the centre, so that shadows have as many levels of darkness as points.
enum class SoftShadows { points, levels };

struct RenderSettings {
  std::string mode = "pvrr";
  double max_error_px = 0;       ///< mode pvrr: refine the mesh until it is kept; 0: the mesh as tessellated
  double patch_fov_rad = 1.047;  ///< modes pvrr and exact: cut optics into patches that see no more
  int max_patches = 16;          ///< ... and no optic into more
  int depth = 3;                 ///< greatest number of optics along a path, at least 1
  double chord_mm = 0.01;
  double angle_rad = 0.0873;
  double texels_per_pixel = 1.5;
  int soft_shadow_samples = 16;
  SoftShadows soft_shadows = SoftShadows::points;
};

struct Scene {
  std::string file;  ///< for messages
  Camera camera;
  Environment environment;
  std::vector<Light> lights;
  std::vector<cad_import::TriangleMesh> surroundings;
  std::vector<optics::Optic> optics;
  RenderSettings settings;
  std::vector<std::string> warnings;
};

}  // namespace catoptra::render

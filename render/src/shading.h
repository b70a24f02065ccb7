// The one shading model of all modes (docs/decisions/0001), as the ray tracer computes it.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "optics/ray_scene.h"
#include "render/scene.h"
#include "render/src/lighting.h"
#include "render/src/textures.h"
#include "render/src/textures_linear.h"

namespace catoptra::render {

/// Diffuse albedo of the side of an optic that does not reflect, seen directly or in another optic. The
/// reflecting side of an optic seen in another one is diffuse with the optic's reflectance as albedo (no
/// optic appears in itself).
inline constexpr float kOpticBackAlbedo = 0.05f;

/// Whether a point of `mesh` is there: its alpha (material x texture, finest level, bilinear) reaches the
/// material's cutoff. The finest level in every mode, because a ray query knows no footprint. Empty where
/// nothing is cut. `textures` are those of `mesh`; both must outlive the function.
[[nodiscard]] optics::AlphaTest make_alpha_test(const cad_import::TriangleMesh& mesh,
                                                const std::vector<MipTexture>& textures);

/// Radiance of the sky in `direction` (any length): bilinear in the equirectangular picture, whose centre is
/// +y, top row +z and right half +x; or the environment's colour where there is no picture.
[[nodiscard]] glm::vec3 sky_radiance(const SkyImage& sky, const Environment& environment,
                                     const glm::vec3& direction);

/// What shading needs of a triangle, in one cache line.
struct alignas(64) ShadeTriangle {
  glm::vec3 normal[3];  ///< of the corners
  glm::vec2 st[3];      ///< texture coordinates of the corners
  std::uint32_t material;
};

struct ShadeMaterial {
  Float4 base, emissive;
  const LinearTexture* texture = nullptr;
  cad_import::TextureWrap wrap = cad_import::TextureWrap::repeat;
};

/// Up to 16 hits to be shaded, structure of arrays.
struct alignas(64) ShadeLanes {
  static constexpr int kLanes = 16;
  // In. Lanes whose object is optics::kNoHit get the sky.
  float direction_x[kLanes], direction_y[kLanes], direction_z[kLanes];  ///< of the ray; any length
  float position_x[kLanes], position_y[kLanes], position_z[kLanes];     ///< of the hit, mm
  float normal_x[kLanes], normal_y[kLanes], normal_z[kLanes];           ///< geometric, not normalised
  float u[kLanes], v[kLanes];
  float footprint[kLanes];  ///< see shade()
  std::uint32_t object[kLanes], triangle[kLanes];
  bool active[kLanes];
  // Out: linear radiance towards the eye, RGB and nothing.
  Float4 radiance[kLanes];
};

/// The surroundings and optics of a scene, packed for shading.
class ShadingScene {
 public:
  /// Keeps references to all three, which must outlive it; `rays` holds the scene as it is (see
  /// mask_for_rays()).
  ShadingScene(const Scene& scene, const SceneTextures& textures, const optics::RayScene& rays);

  /// Takes the changed mesh of optic `index` over.
  void optic_changed(std::size_t index);

  /// Shades the active lanes. The footprint is the area (mm^2) of the pixel's beam across the ray's direction
  /// at the hit, times the length of `direction`: divided by |n . direction| (n the unit geometric normal) it
  /// is the area on the surface.
  void shade(ShadeLanes& lanes) const;

 private:
  struct Object {
    std::vector<ShadeTriangle> triangles;
    bool optic = false, flip = false;
  };
  struct Gathered;

  void add_surroundings(const cad_import::TriangleMesh& mesh, const std::vector<MipTexture>& textures);
  void pack_optic(std::size_t index);
  void gather(const ShadeLanes& lanes, Gathered& g) const;
  void set_starts(const ShadeLanes& lanes, LitLanes& lit) const;
  void corners(std::uint32_t object, std::uint32_t triangle, glm::dvec3 (&corner)[3]) const;
  void add_lights(const ShadeLanes& lanes, Gathered& g) const;
  static void set_detail(const ShadeLanes& lanes, Gathered& g);
  void show_sky(const Gathered& g, ShadeLanes& lanes) const;

  const Scene& scene_;
  const SceneTextures& textures_;
  Lighting lighting_;
  std::vector<Object> objects_;
  std::vector<ShadeMaterial> materials_;
  std::vector<std::vector<LinearTexture>> linear_;
  std::vector<std::uint32_t> optic_material_;  ///< of the reflecting side; the other side's follows it
};

}  // namespace catoptra::render

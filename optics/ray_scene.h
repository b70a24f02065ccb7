// The acceleration structure: nearest hits among the surroundings and the optics (Embree).
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "cad_import/triangle_mesh.h"
#include "optics/ray_packet.h"
#include "tessellate/optic_arrays.h"

namespace catoptra::optics {

/// Decides whether a surface point is there (alpha-tested foliage): triangle index, weights of the second and
/// third vertex. Called from many threads. Empty: always there.
using AlphaTest = std::function<bool(std::uint32_t triangle, float u, float v)>;

/// A two-level scene: surroundings are built once (quality MEDIUM), optics may move and are refitted, and
/// committing a moved optic rebuilds nothing of the surroundings. Queries are const and thread-safe after
/// commit().
class RayScene {
 public:
  RayScene();
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// Both return the object number that hits carry: 0, 1, 2, ... in order of addition. The data are copied.
  /// Only the triangles that some material makes alpha-tested cost a call of `alpha_test`.
  std::uint32_t add_surroundings(const cad_import::TriangleMesh& mesh, AlphaTest alpha_test = {});
  /// `mask`: what the optic is to queries.
  std::uint32_t add_optic(const tessellate::OpticArrays& mesh, std::uint32_t mask = kOptics | kCasters);

  /// Replaces an optic's mesh (moved, or refined). Takes effect at the next commit().
  void update_optic(std::uint32_t object, const tessellate::OpticArrays& mesh);

  /// Builds what is new or changed.
  void commit();

  [[nodiscard]] Hit intersect(const Ray& ray, std::uint32_t mask = kEverything) const;

  /// Nearest hits of many coherent rays, by packets of 16; `hits` in the order of `rays`.
  [[nodiscard]] std::vector<Hit> intersect(std::span<const Ray> rays, std::uint32_t mask = kEverything) const;

  /// The bare packet query: rays with t_max < t_min are inactive (lane skipped, object set to kNoHit).
  void intersect16(RayPacket16& packet, std::uint32_t mask, bool coherent) const;

  /// The bare packet query for shadows: bit i of the result is set where lane i meets something between its
  /// t_min and t_max. Changes the packet.
  [[nodiscard]] std::uint32_t occluded16(ShadowPacket16& packet, std::uint32_t mask, bool coherent) const;

  [[nodiscard]] bool occluded(const Ray& ray, std::uint32_t mask = kEverything) const;

  /// Number of objects, and of triangles in all of them.
  [[nodiscard]] std::size_t object_count() const;
  [[nodiscard]] std::size_t triangle_count() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catoptra::optics

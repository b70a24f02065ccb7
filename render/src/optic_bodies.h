// What rays that leave one optic meet of the others, each where it is now.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "optics/placement.h"
#include "optics/ray_scene.h"
#include "optics/vertex_hits.h"
#include "render/scene.h"

namespace catoptra::render {

/// The meshes of all optics, of lenses those of both sides, apart from the surroundings. Not for several
/// threads at once until commit().
class OpticBodies {
 public:
  /// Keeps a reference to `scene`.
  explicit OpticBodies(const Scene& scene);

  void optic_changed(std::size_t index);
  /// Of optic `index`, from now on.
  void place(std::size_t index, const optics::Placement& placement);
  /// Takes over what has changed.
  void commit();

  /// Gives every ray (in the world) that shows something its nearest hit among the optics where that is
  /// nearer than the hit it has. Optic `own`, which the rays leave, is not there, nor are lenses and
  /// refractors unless `with_lenses`, nor panes. Where the others show something themselves (`with_lenses`) a
  /// ray goes on from a planar mirror, by as many of them as `scene` has depth for, and its hit is where that
  /// is met on the straight continuation: unfolded, the place that the map shows there.
  void add_hits(std::vector<optics::VertexHit>& rays, std::size_t own, bool with_lenses,
                const optics::RayScene& surroundings) const;

  /// The box of optic `index`, in the world.
  [[nodiscard]] cad_import::BoundingBox box(std::size_t index) const;

 private:
  /// Moves the ray's start past what is not there.
  [[nodiscard]] optics::Hit nearest(optics::Ray& ray, std::size_t own, bool with_lenses) const;

  const Scene& scene_;
  std::vector<optics::Placement> placements_;
  std::vector<cad_import::BoundingBox> boxes_;          ///< in the optics' own frames
  std::vector<std::vector<std::uint32_t>> objects_of_;  ///< numbers in rays_, by optic
  std::vector<std::size_t> optic_of_;                   ///< the other way round
  optics::RayScene rays_;
  std::vector<bool> stale_;
};

}  // namespace catoptra::render

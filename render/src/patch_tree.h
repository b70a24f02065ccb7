// Where an optic is cut into patches (paper 4.1, Fig. 6; design 2.8).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <map>
#include <span>
#include <vector>

#include "cad_import/cad_model.h"
#include "optics/optic.h"
#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"

namespace catoptra::render {

/// Parallax above which a patch is cut, pixels; see PatchMeasure.
inline constexpr double kMostParallax_px = 1.0;

/// How far one viewpoint is from serving a patch.
struct PatchMeasure {
  glm::dvec2 fov_rad{0};  ///< of the view volume, also where it is wider than a map can be
  /// By how much what stands before something else is displaced against it at its outline: the distance of a
  /// ray from the viewpoint, as an angle seen from the nearer of what the two ends of an edge meet less that
  /// from the farther, in pixels. The largest over the patch's edges. 0 where all is equally far: then the
  /// viewpoint does not matter.
  double parallax_px = 0;
  double parallax_squares = 0;  ///< the sum of its squares over the triangles' edges, px^2
};

struct PatchRequest {
  const optics::Optic& optic;
  const tessellate::OpticArrays& mesh;  ///< of the mirror, or of the side at which a lens is entered
  std::span<const optics::VertexHit>
      hits;  ///< one per vertex; of a lens at the reference wavelength, `faces_eye` where light passes
  cad_import::BoundingBox bounds;  ///< of everything in the scene, in the optic's frame
  double most_fov_rad = 1.047;
  double px_per_rad = 1000;  ///< of the picture at its centre
  std::size_t most_patches = 16;
  bool remember = true;  ///< cuts of last time stay while anything like a reason for them does
};

/// The patch of each triangle.
struct PatchLabels {
  std::vector<std::uint32_t> of_triangle;
  std::size_t count = 1;
  [[nodiscard]] bool operator==(const PatchLabels&) const = default;
};

/// A binary tree of cuts. Each halves the area of a patch, across one of the patch's two principal
/// directions, which are those of the surface alone: so cuts do not move with the eye, they come and go.
class PatchTree {
 public:
  /// Cuts the worst patch again and again while one is above its limits and a cut helps, up to
  /// `most_patches`. A cut helps where it lowers what is above its limit: by how much the sides of the view
  /// volume are above it, in the worse half, or the parallax, as root mean square over both. The one that
  /// helps more of the two is taken. What was cut last time stays so down to kKeepPatch of the limits (see
  /// the source), and by the same cut.
  [[nodiscard]] PatchLabels choose(const PatchRequest& request);
  /// The optic has changed.
  void forget() { cut_last_.clear(); }

 private:
  std::map<std::uint64_t, int>
      cut_last_;  ///< by number of the node (root 1, halves 2 n and 2 n + 1): axis of its cut
};

/// Of the part of an optic whose vertices `hits` belong to.
[[nodiscard]] PatchMeasure measure_patch(const tessellate::OpticArrays& mesh,
                                         std::span<const optics::VertexHit> hits,
                                         const optics::VirtualView& view, double px_per_rad);

}  // namespace catoptra::render

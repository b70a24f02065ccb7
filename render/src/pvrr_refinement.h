// Error-driven refinement of an optic's mesh in mode pvrr (design 2.7; docs/decisions/0008-refinement.md): an
// edge is split where, at its middle, what interpolation shows is off the exact ray by too many pixels.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "optics/lens_path.h"
#include "optics/vertex_hits.h"
#include "optics/virtual_view.h"
#include "render/src/lens_rays.h"
#include "render/src/raster_view.h"
#include "tessellate/refined_mesh.h"

namespace catoptra::render {

/// The mesh of an optic is never refined beyond so many vertices (one that has more is left as it is).
inline constexpr std::size_t kMostRefinedVertices = 20000;

/// What is known at the vertices of the mesh as tessellated. Everything in the optic's own frame.
struct RefinementRequest {
  const optics::Optic& optic;
  const tessellate::OpticArrays& mesh;  ///< of the mirror, or of the side entered, cut into patches
  optics::LensSide entered = optics::LensSide::front;  ///< of a lens
  const optics::LensTracer* tracer = nullptr;          ///< of a lens
  std::span<const optics::VertexHit> hits;             ///< of a lens at the reference wavelength
  std::span<const float> open;                         ///< of a lens: LensRays::open at it
  std::span<const glm::dvec3> coordinates;             ///< homogeneous map coordinates
  std::span<const optics::VirtualView> views;          ///< per patch
  std::span<const std::uint32_t> patch;                ///< per vertex; empty: all belong to the first
  glm::dvec3 eye_mm{0};  ///< where the rays were traced from: the camera's place but for rounding
  ArrivalAt arrival;     ///< how light comes from there
  const RasterView& camera;
  double max_error_px = 0.5;
  bool remember =
      true;  ///< keep what still holds of the last refinement: rays, and splits while they are needed
  std::function<std::vector<optics::VertexHit>(std::vector<optics::VertexHit>)> with_scene_hits;
};

class PvrrRefinement {
 public:
  /// Refines anew from the mesh as tessellated. Edges are split above `max_error_px` (less a margin, see
  /// kSplit in the source), and those that were split last time stay so down to half of that.
  void refine(const RefinementRequest& request);
  /// The optic has changed: nothing is known of it any more.
  void forget() { mesh_.reset(); }

  /// Whether any edge is split now; whether the mesh is another one than before the last refine().
  [[nodiscard]] bool is_refined() const { return mesh_ && !mesh_->parents().empty(); }
  [[nodiscard]] bool mesh_changed() const { return changed_; }
  [[nodiscard]] const tessellate::OpticArrays& mesh() const { return mesh_->mesh(); }
  /// One per vertex of mesh(): those given, and the same of the new ones.
  [[nodiscard]] std::span<const optics::VertexHit> hits() const { return hits_; }
  [[nodiscard]] std::span<const glm::dvec3> coordinates() const { return coordinates_; }
  [[nodiscard]] std::span<const std::uint32_t> patch() const { return patch_; }
  /// Of a lens: LensRays::open at the reference wavelength.
  [[nodiscard]] std::span<const float> open() const { return open_; }
  /// Of a lens: homogeneous map coordinates, each in the map of `patch`, of exact rays close to the border of
  /// what light passes, for which there are no vertices.
  struct BorderRay {
    std::uint32_t patch = 0;
    glm::dvec3 coordinates{0};
  };
  [[nodiscard]] std::span<const BorderRay> border_rays() const { return border_coordinates_; }

  /// What the last refine() has cost: rays reflected or refracted at the middles of edges and in search of
  /// borders, rays sent into the scene from those that became vertices.
  [[nodiscard]] std::size_t traced_rays() const { return traced_rays_; }
  [[nodiscard]] std::size_t scene_rays() const { return scene_rays_; }
  /// The largest error of an edge that had to be left whole to keep kMostRefinedVertices; 0: of none.
  [[nodiscard]] double error_left_px() const { return error_left_px_; }

 private:
  /// Where the ends of an edge lie: both where light passes (or a mirror reflects); one; neither, but each in
  /// a triangle with a corner where it does; anywhere else, or off the picture.
  enum class EdgePlace : std::uint8_t { inside, border, beyond, elsewhere };

  [[nodiscard]] static bool is_lens(const RefinementRequest& request) {
    return request.optic.kind == optics::OpticKind::lens;
  }
  void prepare(const RefinementRequest& request);
  [[nodiscard]] std::vector<double> edge_errors(const RefinementRequest& request);
  [[nodiscard]] double inside_error_px(const RefinementRequest& request,
                                       const tessellate::EdgeMiddle& edge) const;
  void find_twins();
  void trace_middles(const RefinementRequest& request, std::span<const char> asked);
  [[nodiscard]] std::vector<EdgePlace> edge_places(const RefinementRequest& request,
                                                   std::span<const glm::dvec3> pixels) const;
  void add_border_errors(const RefinementRequest& request, std::span<const EdgePlace> places,
                         std::span<const glm::dvec3> pixels, std::vector<double>& errors);
  void find_borders(const RefinementRequest& request, std::span<const EdgePlace> places);
  [[nodiscard]] double border_error_px(const RefinementRequest& request, const tessellate::EdgeMiddle& edge,
                                       double length_px);
  [[nodiscard]] std::vector<char> whole_groups(std::span<const char> wanted) const;
  void continue_rays(const RefinementRequest& request);
  [[nodiscard]] std::vector<char> choose(const RefinementRequest& request, std::span<const double> errors);
  void keep_to_limit(std::vector<std::size_t>& chosen, std::span<const double> errors);
  void add_vertices(const RefinementRequest& request);

  std::optional<tessellate::RefinedMesh> mesh_;
  optics::LensSide side_ = optics::LensSide::front;
  std::vector<std::uint32_t> nodes_;  ///< of the last mesh
  bool changed_ = false;

  glm::dvec3 eye_mm_{0};
  std::vector<optics::VertexHit> rays_;  ///< per node; for this eye, where known_
  std::vector<char> known_, was_split_;  ///< per node
  /// Per node, the first at the same place of the surface: patches that share an edge share the ray at its
  /// middle, and rays_ and known_ are those of that node.
  std::vector<std::uint32_t> twin_;

  /// By node, of edges across the border of what light passes, from the end where it does; for this eye.
  std::unordered_map<std::uint32_t, LensBorder> borders_;

  std::vector<optics::VertexHit> hits_;
  std::vector<float> open_;
  std::vector<BorderRay> border_coordinates_;
  std::vector<glm::dvec3> coordinates_;
  std::vector<std::uint32_t> patch_;
  std::size_t traced_rays_ = 0, scene_rays_ = 0;
  double error_left_px_ = 0;
};

}  // namespace catoptra::render

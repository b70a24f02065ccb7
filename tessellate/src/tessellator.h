// One optic on its way to a mesh: size the faces, cut the edges, mesh the faces, and again where a limit was
// missed.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cad_import/cad_model.h"
#include "tessellate/src/border.h"
#include "tessellate/src/face_grid.h"
#include "tessellate/src/mesh_draft.h"
#include "tessellate/src/sizing.h"

namespace catoptra::tessellate {

/// A mesh of all faces that were not skipped.
struct Attempt {
  MeshDraft draft;
  std::vector<std::string> failure;  ///< per face: why it is not in the draft; empty where it is
};

class Tessellator {
 public:
  /// Faces without a surface or a border that encloses something are skipped at once.
  explicit Tessellator(std::span<const cad_import::Face> faces);

  [[nodiscard]] const std::vector<cad_import::Face>& faces() const { return faces_; }

  /// Leaves a face out from now on.
  void skip(std::size_t face, std::string reason);
  /// Per face: why it is left out; empty where it is not.
  [[nodiscard]] const std::vector<std::string>& skipped() const { return skipped_; }
  [[nodiscard]] std::size_t remaining() const;

  /// The sides of the only remaining face, if it is a rectangle in (u, v).
  [[nodiscard]] bool is_single_grid() const;

  /// Grid cells that the limits ask for, over all faces.
  [[nodiscard]] double estimated_cells(const StepLimits& limits) const;
  /// Mean width and height of the only remaining face, mm.
  [[nodiscard]] glm::dvec2 single_size_mm() const;
  /// Area of the parameter rectangles of all faces, mm^2: an upper bound of what the borders leave of them.
  [[nodiscard]] double rectangle_area_mm2() const;

  [[nodiscard]] Attempt mesh(const StepLimits& limits) const;

 private:
  using Grids = std::vector<std::optional<GridSides>>;

  [[nodiscard]] std::vector<FaceSizing> size_all(const StepLimits& limits) const;
  [[nodiscard]] static std::vector<std::size_t> grid_classes(const Borders& borders, const Grids& grids);
  [[nodiscard]] std::vector<int> even_cuts(const Borders& borders, Grids& grids,
                                           std::span<const FaceSizing> sizing,
                                           const StepLimits& limits) const;
  void cut(Borders& borders, const Grids& grids, std::span<const int> even,
           std::span<const FaceSizing> sizing, const StepLimits& limits,
           std::span<const double> fineness) const;

  std::vector<cad_import::Face> faces_;
  std::vector<UvBox> boxes_;
  Grids sides_;  ///< of the faces that are rectangles in (u, v)
  std::vector<std::string> skipped_;
};

}  // namespace catoptra::tessellate

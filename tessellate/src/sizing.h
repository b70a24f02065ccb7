// How far apart the grid lines of a face may stand in u and in v.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "cad_import/cad_model.h"
#include "tessellate/optic_mesh.h"

namespace catoptra::tessellate {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// What a mesh edge may do at most.
struct StepLimits {
  double chord_mm = kUnlimited;
  double angle_rad = kUnlimited;
  double length_mm = kUnlimited;
  std::optional<GridRequest> grid;  ///< overrides the others inside a face
};

struct UvBox {
  glm::dvec2 min{1e300}, max{-1e300};
  void add(const glm::dvec2& p) {
    min = glm::dvec2(p.x < min.x ? p.x : min.x, p.y < min.y ? p.y : min.y);
    max = glm::dvec2(p.x > max.x ? p.x : max.x, p.y > max.y ? p.y : max.y);
  }
  [[nodiscard]] glm::dvec2 extent() const { return max - min; }
};

/// A monotone map from one surface parameter to a count of grid cells: linear between evenly spaced nodes.
class CellCount {
 public:
  CellCount() = default;
  /// `density`: cells per unit of parameter in each of its equal intervals of [begin, end].
  CellCount(double begin, double end, const std::vector<double>& density);

  [[nodiscard]] double cells() const { return nodes_.back(); }
  /// Cells if they all had the size of the smallest.
  [[nodiscard]] double even_cells() const { return even_cells_; }
  [[nodiscard]] double to_cells(double parameter) const;
  [[nodiscard]] double to_parameter(double cells) const;

 private:
  double begin_ = 0, end_ = 1, even_cells_ = 1;
  std::vector<double> nodes_{0, 1};  ///< cells counted up to each node
};

/// A face's sizing: in (u.to_cells, v.to_cells) coordinates every mesh edge may have length 1.
struct FaceSizing {
  UvBox box;
  CellCount u, v;
  [[nodiscard]] glm::dvec2 to_cells(const glm::dvec2& uv) const {
    return {u.to_cells(uv.x), v.to_cells(uv.y)};
  }
};

/// Sizes the cells from the surface's second fundamental form (chord) and the derivative of its normal
/// (angle).
[[nodiscard]] FaceSizing size_face(const cad_import::ExactSurface& surface, const UvBox& box,
                                   const StepLimits& limits);

}  // namespace catoptra::tessellate

// One side of a lens: the faces that light passes, measured along an axis.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cad_import/cad_model.h"
#include "cad_import/lens_faces.h"

namespace catoptra::cad_import {

/// A point of a side.
struct SidePoint {
  const Face* face = nullptr;
  glm::dvec2 uv{0};
  glm::dvec3 position{0};
};

/// The faces of one side. Keeps the span.
class LensSide {
 public:
  explicit LensSide(std::span<const Face> faces);

  [[nodiscard]] const glm::dvec3& area_vector() const { return area_vector_; }
  [[nodiscard]] const glm::dvec3& middle() const { return middle_; }  // of the boundary
  /// Mean of points spread over the faces, by parameter.
  [[nodiscard]] glm::dvec3 inner_point() const;
  [[nodiscard]] const std::vector<glm::dvec3>& boundary() const { return boundary_; }
  [[nodiscard]] double extent_mm() const { return extent_; }  // largest distance of boundary and middle

  /// Where the line through `point` along the unit `axis` meets the side.
  [[nodiscard]] std::optional<SidePoint> on_line(const glm::dvec3& point, const glm::dvec3& axis) const;
  /// The point nearest to `from` by Newton's method whose normal is along `axis`, within a quarter of the
  /// extent; nullopt on planes.
  [[nodiscard]] std::optional<SidePoint> vertex(const SidePoint& from, const glm::dvec3& axis) const;

 private:
  [[nodiscard]] std::optional<SidePoint> on_face(const Face& face, const glm::dvec3& point,
                                                 const glm::dvec3& axis) const;
  std::span<const Face> faces_;
  glm::dvec3 area_vector_{0}, middle_{0};
  std::vector<glm::dvec3> boundary_;
  double extent_ = 0;
};

/// Moves both points, by Newton's method, to where the line between them is normal to both surfaces; nullopt
/// where that is further away than `reach_mm`, or everywhere (parallel surfaces).
struct CommonNormal {
  SidePoint front, back;
};
[[nodiscard]] std::optional<CommonNormal> common_normal(SidePoint front, SidePoint back, double reach_mm);

}  // namespace catoptra::cad_import

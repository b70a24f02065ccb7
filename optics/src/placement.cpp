#include "optics/placement.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "cad_import/error.h"

namespace catoptra::optics {
namespace {

// How far a matrix's rotation may be from orthogonal. Beyond it the caller meant something else than a
// motion.
constexpr double kOrthogonality = 1e-6;

class PlacedSurface final : public cad_import::ExactSurface {
 public:
  PlacedSurface(std::shared_ptr<const cad_import::ExactSurface> own, const Placement& placement)
      : own_(std::move(own)), placement_(placement) {}

  [[nodiscard]] cad_import::SurfaceKind kind() const override { return own_->kind(); }
  [[nodiscard]] cad_import::ParameterDomain domain() const override { return own_->domain(); }
  [[nodiscard]] double orientation() const override { return own_->orientation(); }
  [[nodiscard]] glm::dvec3 point(double u, double v) const override {
    return placement_.point(own_->point(u, v));
  }
  [[nodiscard]] cad_import::SurfaceFrame d1(double u, double v) const override {
    const auto d = own_->d1(u, v);
    return {placement_.point(d.point), placement_.direction(d.du), placement_.direction(d.dv)};
  }
  [[nodiscard]] cad_import::SurfaceDerivatives d2(double u, double v) const override {
    const auto d = own_->d2(u, v);
    return {placement_.point(d.point),   placement_.direction(d.du),  placement_.direction(d.dv),
            placement_.direction(d.duu), placement_.direction(d.duv), placement_.direction(d.dvv)};
  }

 private:
  std::shared_ptr<const cad_import::ExactSurface> own_;
  Placement placement_;
};

template <typename Map>
cad_import::BoundingBox mapped(const cad_import::BoundingBox& box, const Map& map) {
  cad_import::BoundingBox out;
  if (box.empty()) return out;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p =
        map(glm::dvec3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                       corner & 4 ? box.max.z : box.min.z));
    out.min = glm::min(out.min, p);
    out.max = glm::max(out.max, p);
  }
  return out;
}

void place(std::vector<cad_import::Face>& faces, tessellate::OpticArrays& mesh, const Placement& placement) {
  for (cad_import::Face& face : faces) {
    face.surface = std::make_shared<PlacedSurface>(face.surface, placement);
    face.bounds = placed(face.bounds, placement);
  }
  for (tessellate::OpticVertex& vertex : mesh.vertices) {
    vertex.position_mm = placement.point(vertex.position_mm);
    vertex.normal = placement.direction(vertex.normal);
    vertex.direction1 = placement.direction(vertex.direction1);
  }
}

}  // namespace

Placement placement_from_matrix(const glm::dmat4& matrix, const std::string& optic) {
  Placement placement{glm::dmat3(matrix), glm::dvec3(matrix[3])};
  glm::dmat3& r = placement.rotation;
  bool rigid = glm::determinant(r) > 0 && matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 &&
               matrix[3][3] == 1;
  const glm::dmat3 products = glm::transpose(r) * r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rigid = rigid && std::abs(products[i][j] - (i == j)) < kOrthogonality;
  for (int i = 0; i < 3; ++i) rigid = rigid && std::isfinite(placement.translation_mm[i]);
  if (!rigid)
    throw Error({}, optic, "cannot be placed by a matrix that is no rotation with translation",
                "an optic may be turned and moved, but not scaled, sheared or mirrored");
  // Gram and Schmidt; a rotation that is exact to the last bit comes out as it was where its axes are whole
  // numbers.
  r[0] = glm::normalize(r[0]);
  r[1] = glm::normalize(r[1] - glm::dot(r[0], r[1]) * r[0]);
  r[2] = glm::cross(r[0], r[1]);
  return placement;
}

cad_import::BoundingBox placed(const cad_import::BoundingBox& own, const Placement& placement) {
  return mapped(own, [&](const glm::dvec3& p) { return placement.point(p); });
}

cad_import::BoundingBox in_own_frame(const cad_import::BoundingBox& world, const Placement& placement) {
  return mapped(world, [&](const glm::dvec3& p) { return placement.own_point(p); });
}

Optic placed(const Optic& own, const Placement& placement) {
  Optic optic = own;
  if (placement == Placement()) return optic;
  place(optic.faces, optic.mesh, placement);
  place(optic.back.faces, optic.back.mesh, placement);
  optic.material.first_edge = placement.direction(own.material.first_edge);
  return optic;
}

}  // namespace catoptra::optics

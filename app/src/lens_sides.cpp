#include "app/src/lens_sides.h"

#include <algorithm>
#include <cctype>
#include <glm/geometric.hpp>
#include <memory>
#include <string>

#include "cad_import/error.h"
#include "optics/exact_hit.h"
#include "optics/ray_scene.h"

namespace catoptra::app {
namespace {

using cad_import::CadModel;
using cad_import::Face;

/// A surface whose outward side is the other one.
class TurnedOver final : public cad_import::ExactSurface {
 public:
  explicit TurnedOver(std::shared_ptr<const cad_import::ExactSurface> surface)
      : surface_(std::move(surface)) {}
  cad_import::SurfaceKind kind() const override { return surface_->kind(); }
  cad_import::ParameterDomain domain() const override { return surface_->domain(); }
  glm::dvec3 point(double u, double v) const override { return surface_->point(u, v); }
  cad_import::SurfaceFrame d1(double u, double v) const override { return surface_->d1(u, v); }
  cad_import::SurfaceDerivatives d2(double u, double v) const override { return surface_->d2(u, v); }
  double orientation() const override { return -surface_->orientation(); }

 private:
  std::shared_ptr<const cad_import::ExactSurface> surface_;
};

bool is_closed(const CadModel& model, std::span<const int> faces) {
  return std::all_of(faces.begin(), faces.end(), [&](int face) {
    return model.bodies[std::size_t(model.faces[std::size_t(face)].body)].solid;
  });
}

glm::dvec3 area_vector(std::span<const Face> faces) {
  glm::dvec3 sum(0);
  for (const Face& face : faces) sum += cad_import::area_vector(face);
  return sum;
}

bool called(std::span<const Face> faces, const std::string& name) {
  return std::any_of(faces.begin(), faces.end(), [&](const Face& face) {
    std::string text = face.name;
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text.find(name) != std::string::npos;
  });
}

void turn_over(std::vector<Face>& faces) {
  for (Face& face : faces) face.surface = std::make_shared<TurnedOver>(face.surface);
}

glm::dvec3 mean_normal(const tessellate::OpticArrays& mesh) {
  glm::dvec3 sum(0);
  for (const auto& triangle : mesh.triangles) {
    const auto at = [&](int k) { return mesh.vertices[triangle.vertices[std::size_t(k)]].position_mm; };
    sum += glm::cross(at(1) - at(0), at(2) - at(0));
  }
  return sum;
}

}  // namespace

LensFaceIndices lens_faces_of(const CadModel& model, std::span<const FaceSelector> front,
                              std::span<const FaceSelector> back) {
  LensFaceIndices chosen;
  if (!front.empty()) chosen.front = select_faces(model, front);
  if (!back.empty()) chosen.back = select_faces(model, back);
  const cad_import::LensFaces lens = cad_import::recognise_lens(model, chosen.front, chosen.back);
  return {lens.front, lens.back};
}

std::vector<int> lens_side_of(const CadModel& model, std::span<const FaceSelector> selectors) {
  if (!selectors.empty()) return select_faces(model, selectors);
  std::vector<int> all;
  for (const Face& face : model.faces) all.push_back(face.index);
  if (is_closed(model, all))
    throw Error(model.file, "body", "is a solid, not one surface",
                "give it as file, or name its face with front_faces or back_faces");
  return all;
}

std::vector<Face> faces_at(const CadModel& model, std::span<const int> indices) {
  std::vector<Face> faces;
  for (const int index : indices) faces.push_back(model.faces[std::size_t(index)]);
  return faces;
}

bool is_mirror_glass(const CadModel& model) {
  const auto has = [&](const char* name) {
    return std::any_of(model.faces.begin(), model.faces.end(),
                       [&](const Face& face) { return face.name == name; });
  };
  return has("Glass") && has("Back") && has("Edge");
}

std::optional<std::string> exchanged_sides(std::span<const Face> front, std::span<const Face> back,
                                           const cad_import::LensGeometry& geometry) {
  const bool front_right = called(front, "front"), back_right = called(back, "back");
  if (called(front, "back") && !front_right) return "the front is called 'back' in the file";
  if (called(back, "front") && !back_right) return "the back is called 'front' in the file";
  if (front_right || back_right) return std::nullopt;
  // Flatter than a radius of 1 km is flat.
  constexpr double kFlat = 1e-6;
  const auto mean = [](const cad_import::PrincipalCurvatures& k) { return 0.5 * (k.k1 + k.k2); };
  if (mean(geometry.front_curvature) < -kFlat && mean(geometry.back_curvature) > kFlat)
    return "the front is concave and the back convex";
  return std::nullopt;
}

cad_import::LensGeometry turn_normals_outwards(std::vector<Face>& front, std::vector<Face>& back,
                                               const std::string& file) {
  const cad_import::LensGeometry geometry = cad_import::measure_lens(front, back, file);
  if (glm::dot(area_vector(front), geometry.axis) < 0) turn_over(front);
  if (glm::dot(area_vector(back), geometry.axis) > 0) turn_over(back);
  return geometry;
}

std::optional<glm::dvec3> lens_axis(const optics::Optic& lens) {
  const glm::dvec3 along = mean_normal(lens.mesh) - mean_normal(lens.back.mesh);
  if (glm::length(along) == 0) return std::nullopt;
  return glm::normalize(along);
}

std::optional<LensThickness> lens_thickness(const optics::Optic& lens) {
  const auto direction = lens_axis(lens);
  if (!direction) return std::nullopt;
  const glm::dvec3 axis = *direction;
  double most = 0;
  for (const auto& vertex : lens.mesh.vertices)
    for (const auto& other : {lens.mesh.vertices.front(), lens.back.mesh.vertices.front()})
      most = std::max(most, glm::distance(vertex.position_mm, other.position_mm));
  const double reach = 2 * most + 1;  // every ray starts before both sides

  optics::RayScene scene;
  (void)scene.add_optic(lens.back.mesh);
  scene.commit();
  std::optional<LensThickness> result;
  for (const auto& vertex : lens.mesh.vertices) {
    const optics::Ray ray{vertex.position_mm + reach * axis, -axis};
    const optics::Hit hit = scene.intersect(ray);
    if (!hit) continue;
    const auto exact = optics::exact_hit(lens.back.faces, lens.back.mesh, ray, hit);
    if (!exact) continue;
    const double thickness = exact->t_mm - reach;
    if (!result) result = {thickness, thickness};
    result->min_mm = std::min(result->min_mm, thickness);
    result->max_mm = std::max(result->max_mm, thickness);
  }
  return result;
}

}  // namespace catoptra::app

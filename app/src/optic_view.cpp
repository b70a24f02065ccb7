#include "app/src/optic_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "app/src/lens_sides.h"
#include "cad_import/error.h"
#include "optics/lens_path.h"
#include "optics/ray_scene.h"

namespace catoptra::app {
namespace {

using optics::Optic;
using optics::Ray;

/// Rays to as many vertices a side, and a grid of rays over the picture for optics larger than it.
constexpr std::size_t kMostVertices = 2000;
constexpr int kGrid = 24;

/// The pyramid that a picture shows.
class Pyramid {
 public:
  explicit Pyramid(const render::Camera& camera) : eye_(camera.eye_mm) {
    ahead_ = glm::normalize(camera.target_mm - camera.eye_mm);
    right_ = glm::normalize(glm::cross(ahead_, camera.up));
    up_ = glm::cross(right_, ahead_);
    tan_y_ = std::tan(camera.fov_rad / 2);
    tan_x_ = tan_y_ * camera.resolution.x / camera.resolution.y;
  }
  [[nodiscard]] bool holds(const glm::dvec3& point) const {
    const glm::dvec3 to = point - eye_;
    const double depth = glm::dot(to, ahead_);
    return depth > 0 && std::abs(glm::dot(to, right_)) <= depth * tan_x_ &&
           std::abs(glm::dot(to, up_)) <= depth * tan_y_;
  }
  /// `x` and `y` from -1 to 1.
  [[nodiscard]] Ray ray(double x, double y) const {
    return {eye_, glm::normalize(ahead_ + x * tan_x_ * right_ + y * tan_y_ * up_)};
  }
  [[nodiscard]] const glm::dvec3& eye() const { return eye_; }

 private:
  glm::dvec3 eye_, ahead_, right_, up_;
  double tan_x_ = 1, tan_y_ = 1;
};

/// A ray of the picture that goes to the optic, and the normal of its mesh there.
struct Sight {
  Ray ray;
  glm::dvec3 normal;
};

void add_vertices(const tessellate::OpticArrays& mesh, const Pyramid& picture, std::vector<Sight>& sights) {
  const std::size_t stride = mesh.vertices.size() / kMostVertices + 1;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += stride) {
    const auto& vertex = mesh.vertices[i];
    if (picture.holds(vertex.position_mm))
      sights.push_back({{picture.eye(), glm::normalize(vertex.position_mm - picture.eye())}, vertex.normal});
  }
}

std::vector<Sight> sights_of(const Optic& optic, const Pyramid& picture) {
  std::vector<Sight> sights;
  std::vector<const tessellate::OpticArrays*> meshes{&optic.mesh};
  if (optic.kind == optics::OpticKind::lens) meshes.push_back(&optic.back.mesh);
  optics::RayScene scene;
  for (const auto* mesh : meshes) {
    add_vertices(*mesh, picture, sights);
    (void)scene.add_optic(*mesh);
  }
  scene.commit();
  for (int row = 0; row < kGrid; ++row)
    for (int column = 0; column < kGrid; ++column) {
      const Ray ray = picture.ray((2 * column + 1.0) / kGrid - 1, (2 * row + 1.0) / kGrid - 1);
      const optics::Hit hit = scene.intersect(ray);
      if (!hit) continue;
      const auto& mesh = *meshes[hit.object];
      sights.push_back({ray, mesh.vertices[mesh.triangles[hit.triangle].vertices[0]].normal});
    }
  return sights;
}

/// Whether it works from both sides, so that no eye is behind it.
bool works_from_both_sides(const Optic& optic) {
  return optic.two_sided || (optics::is_planar_glass(optic) && !optic.one_sided);
}

std::string side_warning(const Optic& optic, const std::vector<Sight>& sights) {
  if (works_from_both_sides(optic)) return {};
  const double side = optic.flip ? -1 : 1;
  const bool faces_eye = std::any_of(sights.begin(), sights.end(), [&](const Sight& sight) {
    return side * glm::dot(sight.normal, sight.ray.direction) < 0;
  });
  if (faces_eye) return {};
  const std::string name = std::string(optics::kind_name(optic.kind)) + " '" + optic.name + "'";
  if (optics::is_planar_glass(optic))
    return name +
           " turns its back to the eye and is not there (one_sided = false makes it work from both sides)";
  return name + " turns its back to the eye and reflects nothing (" +
         (optic.planar ? "one_sided = false reflects on both sides)"
                       : "rotate_deg turns it; flip = true reflects on the other side)");
}

std::string lens_warning(const Optic& lens, const Pyramid& picture, const std::vector<Sight>& sights) {
  const optics::LensTracer tracer(lens);
  const optics::LensSide side = optics::side_towards(lens, picture.eye());
  const optics::LensIndices indices = optics::lens_indices(lens, optics::kLineD_nm);
  const bool any_passes = std::any_of(sights.begin(), sights.end(), [&](const Sight& sight) {
    return tracer.trace(sight.ray, side, indices).end == optics::LensPathEnd::passed;
  });
  if (any_passes) return {};
  return "lens '" + lens.name +
         "': no ray from the eye passes: it is seen from its edge, or all light is totally reflected or "
         "leaves "
         "through the rim (rotate_deg turns the lens, camera.eye moves the eye)";
}

/// Whether `by` may show `other`: what works from one side alone shows only what reaches before its surface.
bool can_show(const Optic& by, const Optic& other) {
  if (by.kind == optics::OpticKind::lens || works_from_both_sides(by)) return true;
  const double side = by.flip ? -1 : 1;
  const auto& of = other.mesh.vertices;
  const std::size_t stride = by.mesh.vertices.size() / kMostVertices + 1,
                    other_stride = of.size() / kMostVertices + 1;
  for (std::size_t i = 0; i < by.mesh.vertices.size(); i += stride)
    for (std::size_t j = 0; j < of.size(); j += other_stride)
      if (side * glm::dot(by.mesh.vertices[i].normal, of[j].position_mm - by.mesh.vertices[i].position_mm) >
          0)
        return true;
  return false;
}

/// Which optics may be shown by another one that shows itself: `seen` are those in the picture that work
/// towards the eye. A path has at most `depth` optics.
std::vector<bool> shown_by_others(const std::vector<Optic>& optics, const std::vector<bool>& seen,
                                  int depth) {
  std::vector<bool> shown(optics.size()), last = seen;
  for (int k = 1; k < depth; ++k) {
    std::vector<bool> next(optics.size());
    for (std::size_t i = 0; i < optics.size(); ++i)
      for (std::size_t j = 0; j < optics.size() && !shown[i] && !next[i]; ++j)
        next[i] = i != j && last[j] && can_show(optics[j], optics[i]);
    if (std::none_of(next.begin(), next.end(), [](bool any) { return any; })) break;
    for (std::size_t i = 0; i < optics.size(); ++i) shown[i] = shown[i] || next[i];
    last = std::move(next);
  }
  return shown;
}

std::string view_warning(const Optic& optic, const Pyramid& picture) {
  const std::vector<Sight> sights = sights_of(optic, picture);
  if (sights.empty())
    return std::string(optics::kind_name(optic.kind)) + " '" + optic.name +
           "' lies outside the picture (see camera.eye, camera.target, camera.fov_deg and " +
           (optic.planar ? "the place of its corners or file)" : "its translate)");
  return optic.kind == optics::OpticKind::lens ? lens_warning(optic, picture, sights)
                                               : side_warning(optic, sights);
}

}  // namespace

bool inside_lens(const Optic& lens, const glm::dvec3& point_mm) {
  const auto axis = lens_axis(lens);
  if (!axis) return false;
  optics::RayScene scene;
  const std::array<const tessellate::OpticArrays*, 2> sides{&lens.mesh, &lens.back.mesh};
  for (const auto* side : sides) (void)scene.add_optic(*side);
  scene.commit();
  /// Whether the next surface along `direction` is `side`, met from within.
  const auto leaves_through = [&](const glm::dvec3& direction, std::uint32_t side) {
    const optics::Hit hit = scene.intersect({point_mm, direction});
    if (!hit || hit.object != side) return false;
    const auto& vertices = sides[side]->triangles[hit.triangle].vertices;
    return glm::dot(sides[side]->vertices[vertices[0]].normal, direction) > 0;
  };
  return leaves_through(*axis, 0) && leaves_through(-*axis, 1);
}

std::vector<std::string> optic_view_warnings(const render::Scene& scene) {
  const Pyramid picture(scene.camera);
  std::vector<std::string> of_optic;
  std::vector<bool> seen;
  for (const Optic& optic : scene.optics) {
    if (optic.kind == optics::OpticKind::lens && inside_lens(optic, picture.eye()))
      throw Error(scene.file, "lens '" + optic.name + "'", "the eye lies inside the glass",
                  "move camera.eye out of it, or the lens by translate");
    of_optic.push_back(view_warning(optic, picture));
    seen.push_back(of_optic.back().empty());
  }
  const std::vector<bool> shown = shown_by_others(scene.optics, seen, scene.settings.depth);
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < of_optic.size(); ++i)
    if (!of_optic[i].empty() && !shown[i]) warnings.push_back(std::move(of_optic[i]));
  return warnings;
}

}  // namespace catoptra::app

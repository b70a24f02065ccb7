#include "render/src/optic_bodies.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace catoptra::render {
namespace {

using optics::VertexHit;

constexpr std::size_t kRaysPerTask = 256;
// Surfaces of the own optic, and of lenses that are not there, that a ray passes at most: past so many it
// counts as met by nothing else.
constexpr int kMostPassed = 16;

std::vector<const tessellate::OpticArrays*> meshes_of(const optics::Optic& optic) {
  if (optic.kind != optics::OpticKind::lens) return {&optic.mesh};
  return {&optic.mesh, &optic.back.mesh};
}

tessellate::OpticArrays placed_mesh(tessellate::OpticArrays mesh, const optics::Placement& placement) {
  for (auto& vertex : mesh.vertices) vertex.position_mm = placement.point(vertex.position_mm);
  return mesh;
}

cad_import::BoundingBox box_of(const optics::Optic& optic) {
  cad_import::BoundingBox box;
  for (const auto* mesh : meshes_of(optic))
    for (const auto& vertex : mesh->vertices) {
      box.min = glm::min(box.min, vertex.position_mm);
      box.max = glm::max(box.max, vertex.position_mm);
    }
  return box;
}

}  // namespace

OpticBodies::OpticBodies(const Scene& scene)
    : scene_(scene), placements_(scene.optics.size()), stale_(scene.optics.size(), false) {
  for (std::size_t i = 0; i < scene.optics.size(); ++i) {
    boxes_.push_back(box_of(scene.optics[i]));
    auto& objects = objects_of_.emplace_back();
    for (const auto* mesh : meshes_of(scene.optics[i])) {
      objects.push_back(rays_.add_optic(*mesh));
      optic_of_.push_back(i);
    }
  }
  rays_.commit();
}

void OpticBodies::optic_changed(std::size_t index) {
  boxes_[index] = box_of(scene_.optics[index]);
  stale_[index] = true;
}

void OpticBodies::place(std::size_t index, const optics::Placement& placement) {
  if (placement == placements_[index]) return;
  placements_[index] = placement;
  stale_[index] = true;
}

void OpticBodies::commit() {
  if (std::find(stale_.begin(), stale_.end(), true) == stale_.end()) return;
  for (std::size_t i = 0; i < stale_.size(); ++i) {
    if (!stale_[i]) continue;
    const auto meshes = meshes_of(scene_.optics[i]);
    for (std::size_t m = 0; m < meshes.size(); ++m)
      rays_.update_optic(objects_of_[i][m], placed_mesh(*meshes[m], placements_[i]));
    stale_[i] = false;
  }
  rays_.commit();
}

cad_import::BoundingBox OpticBodies::box(std::size_t index) const {
  return optics::placed(boxes_[index], placements_[index]);
}

void OpticBodies::add_hits(std::vector<VertexHit>& rays, std::size_t own, bool with_lenses) const {
  const auto there = [&](std::size_t optic) {
    return optic != own && (with_lenses || scene_.optics[optic].kind == optics::OpticKind::mirror);
  };
  const auto add = [&](VertexHit& hit) {
    if (!hit.faces_eye) return;
    optics::Ray ray{hit.surface_point_mm, hit.direction, optics::kSelfHitDistance_mm};
    if (hit.scene_hit) ray.t_max_mm = hit.scene_hit.t_mm;
    for (int passed = 0; passed < kMostPassed; ++passed) {
      const optics::Hit found = rays_.intersect(ray);
      if (!found) return;
      if (there(optic_of_[found.object])) {
        hit.scene_hit = found;
        hit.hit_point_mm = ray.origin_mm + found.t_mm * ray.direction;
        return;
      }
      ray.t_min_mm = found.t_mm + optics::kSelfHitDistance_mm;
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), kRaysPerTask), [&](const auto& some) {
    for (std::size_t i = some.begin(); i < some.end(); ++i) add(rays[i]);
  });
}

}  // namespace catoptra::render

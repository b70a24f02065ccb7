#include "render/src/pvrr_stack.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "render/src/raster_chunks.h"

namespace catoptra::render {
namespace {

// Optics that all see each other make a tree that grows with the power of the depth. Curved ones trace rays
// and have maps of their own resolution; the maps of planar ones together show each pixel about once a level.
constexpr std::size_t kMostCurved = 256, kMostPlanar = 4096;

// Where the eye of a map of parallel rays is put: over an optic of 1 m they turn by less than 1e-6 rad.
constexpr double kFarEye_mm = 1e9;

/// The eye from which the light of a map seems to come.
RasterView with_eye(RasterView map) {
  if (map.projection[2][3] == 0) map.origin_mm += kFarEye_mm * glm::transpose(map.rotation)[2];
  return map;
}

std::vector<glm::dvec3> corners_of(const cad_import::BoundingBox& box) {
  std::vector<glm::dvec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                         k & 4 ? box.max.z : box.min.z);
  return corners;
}

/// Whether anything of the box lies on the side of the optic to which light leaves it, as far as the planes
/// across its vertex rays can tell.
bool reaches_light(const PvrrOptic& drawn, const cad_import::BoundingBox& box) {
  const std::vector<glm::dvec3> corners = corners_of(box);
  return std::any_of(drawn.hits().begin(), drawn.hits().end(), [&](const optics::VertexHit& hit) {
    if (!passes(hit)) return false;
    const glm::dvec3 from = drawn.placement().point(hit.surface_point_mm),
                     along = drawn.placement().direction(hit.direction);
    return std::any_of(corners.begin(), corners.end(),
                       [&](const glm::dvec3& corner) { return glm::dot(corner - from, along) > 0; });
  });
}

}  // namespace

PvrrStack::PvrrStack(const Scene& scene, RasterScene& raster, const optics::RayScene& rays,
                     const cad_import::BoundingBox& bounds)
    : scene_(scene),
      raster_(raster),
      rays_(rays),
      bounds_(bounds),
      bodies_(scene),
      placements_(scene.optics.size()),
      draw_(scene, raster),
      planar_draw_(scene, raster) {
  for (std::size_t i = 0; i < scene.optics.size(); ++i) roots_.push_back(make_node(i, 1, 0));
}

std::unique_ptr<PvrrStack::Node> PvrrStack::make_node(std::size_t index, int level, std::size_t patch) const {
  auto node = std::make_unique<Node>();
  node->index = index;
  node->level = level;
  node->patch = patch;
  if (scene_.optics[index].planar) {
    auto planar = std::make_unique<PlanarOptic>(scene_, index, raster_);
    node->planar = planar.get();
    node->optic = std::move(planar);
  } else {
    OpticPlace place;
    place.bodies = scene_.optics.size() > 1 && scene_.settings.depth > 1 ? &bodies_ : nullptr;
    place.shows_lenses = level < scene_.settings.depth;
    place.nested = level > 1;
    auto curved = std::make_unique<PvrrOptic>(scene_, index, raster_, rays_, bounds_, place);
    node->curved = curved.get();
    node->optic = std::move(curved);
  }
  node->optic->place(placements_[index]);
  return node;
}

template <typename Visit>
void PvrrStack::visit(const Visit& each) {
  std::vector<Node*> nodes;
  for (const auto& root : roots_) nodes.push_back(root.get());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    each(*nodes[i]);
    for (const auto& child : nodes[i]->children) nodes.push_back(child.get());
  }
}

void PvrrStack::optic_changed(std::size_t index, const cad_import::BoundingBox& bounds) {
  bodies_.optic_changed(index);
  visit([&](Node& node) {
    if (node.index == index) node.optic->optic_changed();
  });
  bounds_changed(bounds);
}

void PvrrStack::place_optic(std::size_t index, const optics::Placement& placement,
                            const cad_import::BoundingBox& bounds) {
  placements_[index] = placement;
  bodies_.place(index, placement);
  visit([&](Node& node) {
    if (node.index == index) node.optic->place(placement);
  });
  bounds_changed(bounds);
}

void PvrrStack::bounds_changed(const cad_import::BoundingBox& bounds) {
  bounds_ = bounds;
  const bool several = scene_.optics.size() > 1;
  visit([&](Node& node) {
    node.optic->set_bounds(bounds);
    node.optic->map_changed();
    if (several) node.optic->others_changed();
  });
}

void PvrrStack::update(const RasterView& camera, int sample, const FrameOptions& options, int levels,
                       MapUse use) {
  levels_ = levels;
  sample_ = sample;
  camera_ = camera;
  bodies_.commit();
  left_out_ = pruned_ = curved_nodes_ = planar_nodes_ = 0;
  std::vector<Node*> queue;
  for (std::size_t i = 0; i < roots_.size(); ++i) {
    Node& root = *roots_[i];
    ++(root.planar ? planar_nodes_ : curved_nodes_);
    const bool seen = update_node(root, options, {camera, 1, nullptr, {}, use});
    // What an optic shows that the picture does not is of no interest.
    if (seen && (root.planar || box_in_view(camera, bodies_.box(i)).seen))
      queue.push_back(&root);
    else
      set_children(root, {});
  }
  // Level by level, so that a limit cuts the deepest.
  for (std::size_t i = 0; i < queue.size(); ++i) update_children(*queue[i], options, queue);
}

bool PvrrStack::update_node(Node& node, const FrameOptions& options, const Sight& sight) const {
  if (node.planar)
    return node.planar->update(
        sight.camera, options,
        {sight.above, sight.texels_before, sight.aperture, options.check_visibility, sample_});
  node.curved->update(sight.camera, options, sight.texels_before, sight.above, sight.use);
  return true;
}

bool PvrrStack::has_room(std::size_t index) const {
  return scene_.optics[index].planar ? planar_nodes_ < kMostPlanar : curved_nodes_ < kMostCurved;
}

void PvrrStack::update_children(Node& node, const FrameOptions& options, std::vector<Node*>& next) {
  std::vector<std::unique_ptr<Node>> former = std::exchange(node.children, {}), children;
  if (node.level < levels_ && node.optic->faces_eye())
    for (std::size_t patch = 0; patch < node.optic->patch_count(); ++patch)
      if (node.optic->has_map(patch)) update_patch(node, patch, options, former, children);
  for (const auto& child : children) next.push_back(child.get());
  set_children(node, std::move(children));
}

void PvrrStack::update_patch(Node& node, std::size_t patch, const FrameOptions& options,
                             std::vector<std::unique_ptr<Node>>& former,
                             std::vector<std::unique_ptr<Node>>& children) {
  const RasterView map = node.optic->map_camera(patch);
  Sight sight{with_eye(map), node.optic->texels_per_pixel(patch), node.optic->light(patch), {}, MapUse::picture};
  if (node.planar) sight.aperture = node.planar->aperture(patch);
  for (std::size_t index = 0; index < scene_.optics.size(); ++index) {
    if (index == node.index) continue;
    if ((options.check_visibility || !scene_.optics[index].planar) && !may_show(node, map, index)) {
      ++pruned_;
      continue;
    }
    if (!has_room(index)) {
      ++left_out_;
      continue;
    }
    const auto known = std::find_if(former.begin(), former.end(), [&](const auto& child) {
      return child && child->index == index && child->patch == patch;
    });
    auto child = known != former.end() ? std::move(*known) : make_node(index, node.level + 1, patch);
    if (!update_node(*child, options, sight)) {
      ++pruned_;
      continue;
    }
    ++(child->planar ? planar_nodes_ : curved_nodes_);
    children.push_back(std::move(child));
  }
}

void PvrrStack::set_children(Node& node, std::vector<std::unique_ptr<Node>> children) {
  std::vector<std::vector<std::size_t>> shown(node.optic->patch_count()), before;
  for (const auto& child : children) shown[child->patch].push_back(child->index);
  for (const NestedOptics& nested : node.nested) before.push_back(nested.optics);
  if (shown != before) {
    node.optic->map_changed();
    node.nested.resize(shown.size());
    for (std::size_t patch = 0; patch < shown.size(); ++patch) node.nested[patch].optics = shown[patch];
  }
  node.children = std::move(children);
}

bool PvrrStack::may_show(const Node& node, const RasterView& map, std::size_t index) const {
  const cad_import::BoundingBox box = bodies_.box(index);
  return box_in_view(map, box).seen && (!node.curved || reaches_light(*node.curved, box));
}

void PvrrStack::draw_maps(glm::dvec2 offset_px, bool geometry, Overlay* overlay) {
  const RasterView camera = with_sample_offset(camera_, offset_px);
  for (const auto& root : roots_) draw_map(*root, camera, offset_px, geometry, overlay);
}

bool PvrrStack::draw_map(Node& node, const RasterView& above, glm::dvec2 offset_px, bool geometry,
                         Overlay* overlay) {
  const glm::dvec2 in_map = node.optic->map_offset(offset_px);
  bool changed = false;
  for (const auto& child : node.children) {
    const RasterView map = node.planar ? node.planar->map_view(child->patch, above)
                                       : with_sample_offset(node.curved->map_camera(child->patch), in_map);
    changed = draw_map(*child, map, in_map, geometry, nullptr) || changed;
  }
  if (changed) node.optic->map_changed();
  for (std::size_t patch = 0; patch < node.nested.size(); ++patch)
    node.nested[patch].draw = [&, patch](const RasterView& view, const RasterPass& pass,
                                         const RasterTarget& target) {
      for (const auto& child : node.children)
        if (child->patch == patch)
          draw_node(*child, target, view, in_map, {pass.geometry, true, pass.clip_depth != nullptr});
    };
  const std::size_t before = raster_.draws();
  node.drawn = node.planar ? node.planar->draw_maps(above, geometry, overlay, node.nested) > 0
                           : node.curved->draw_map(offset_px, geometry, overlay, node.nested);
  node.draws = raster_.draws() - before;
  return node.drawn;
}

void PvrrStack::draw_node(const Node& node, const RasterTarget& target, const RasterView& view,
                          glm::dvec2 offset_px, const PvrrDraw::Look& look) {
  if (node.planar)
    planar_draw_.draw(*node.planar, view, look);
  else
    draw_.draw(*node.curved, node.index, target, view, offset_px, look);
}

void PvrrStack::draw(std::size_t index, const RasterTarget& target, const RasterView& camera,
                     glm::dvec2 offset_px, bool geometry) {
  draw_node(*roots_[index], target, camera, offset_px, {geometry, false, false});
}

std::vector<MapStats> PvrrStack::statistics() const {
  std::vector<MapStats> maps;
  std::vector<std::pair<const Node*, std::string>> nodes;
  for (const auto& root : roots_) nodes.emplace_back(root.get(), scene_.optics[root->index].name);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto [node, way] = nodes[i];
    for (const auto& child : node->children)
      nodes.emplace_back(child.get(), way + " > " + scene_.optics[child->index].name);
    if (!node->optic->faces_eye()) continue;
    const OpticStats optic = node->optic->statistics();
    maps.push_back({way, node->level, node->drawn, node->optic->map_texels(), optic.rays, optic.scene_rays,
                    node->draws});
  }
  return maps;
}

std::vector<std::string> PvrrStack::warnings() const {
  if (left_out_ == 0) return {};
  return {"optics in optics: at least " + std::to_string(left_out_) + " maps beyond the limit of " +
          std::to_string(kMostCurved) + " of curved and " + std::to_string(kMostPlanar) +
          " of planar ones were left out; their optics show as plain bodies (a smaller " +
          "render.depth needs fewer)"};
}

}  // namespace catoptra::render

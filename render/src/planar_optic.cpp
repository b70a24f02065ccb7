#include "render/src/planar_optic.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/planar_glass.h"
#include "optics/reflection.h"
#include "optics/refraction.h"
#include "render/src/sampling.h"

namespace catoptra::render {
namespace {

using optics::OpticKind;

// Light that is less than that share of what is seen gets no map: a quarter of a step of 8 bits at full
// white.
constexpr double kLeastShare = 1e-3;
// What lies in the plane itself, as the wall on which a mirror hangs, is not seen in it: as for rays
// (optics/vertex_hits.h), and what floats leave uncertain so far from the eye.
constexpr double kPlaneRoom_mm = optics::kSelfHitDistance_mm, kPlaneRoomByDistance = 1e-6;
// The map's near distance over the least w of the face in the view: what is seen lies behind the face.
constexpr double kNear = 0.5;
// Textures grow in steps, so that a moving camera does not ask for new ones in every frame.
constexpr int kStep = 32;
// Room for sample offsets within pixels where one outline is clipped by another.
constexpr double kOffsetRoom_px = 1;

bool same_view(const RasterView& a, const RasterView& b) {
  return a.origin_mm == b.origin_mm && a.rotation == b.rotation && a.projection == b.projection &&
         a.size == b.size && a.keep == b.keep;
}

glm::ivec2 stepped(glm::ivec2 size) {
  return (size + kStep - 1) / kStep * kStep;
}

double reflectance(OpticKind kind, double cos_theta_i, double index_ratio) {
  const double r = optics::fresnel_dielectric(cos_theta_i, 1, index_ratio).unpolarised;
  return kind == OpticKind::pane ? optics::plate_reflectance(r) : r;
}

}  // namespace

void PlanarOptic::MirroredLight::set(const LightWay* above, const optics::Plane& plane) {
  if (above == above_ && plane.point_mm == plane_.point_mm && plane.normal == plane_.normal) return;
  above_ = above;
  plane_ = plane;
  ++changes_;
}

std::optional<optics::Arrival> PlanarOptic::MirroredLight::light_to(const glm::dvec3& point_mm) const {
  // Unfolded, the light goes on to the mirror image of the point.
  const auto light = above_->light_to(point_mm - 2 * plane_.height_mm(point_mm) * plane_.normal);
  if (!light) return std::nullopt;
  const double slope = glm::dot(light->direction, plane_.normal);
  if (slope == 0) return std::nullopt;
  const glm::dmat3 reflection = glm::dmat3(1) - 2.0 * glm::outerProduct(plane_.normal, plane_.normal);
  return optics::Arrival{light->origin_mm - plane_.height_mm(light->origin_mm) / slope * light->direction,
                         reflection * light->direction, reflection * light->turn * reflection};
}

PlanarOptic::PlanarOptic(const Scene& scene, std::size_t optic, RasterScene& raster)
    : scene_(scene), optic_(scene.optics[optic]), index_(optic), raster_(raster) {
  maps_.resize(optics::is_planar_glass(optic_) ? 2 : 1);
  optic_changed();
}

void PlanarOptic::optic_changed() {
  face_ = optics::planar_face(optic_);
  map_changed();
}

void PlanarOptic::map_changed() {
  for (Map& map : maps_) map.drawn.reset();
}

void PlanarOptic::place(const optics::Placement& placement) {
  if (placement == placement_) return;
  placement_ = placement;
  map_changed();
}

void PlanarOptic::set_plane() {
  std::vector<glm::dvec3> points;
  for (const auto& vertex : optic_.mesh.vertices) points.push_back(placement_.point(vertex.position_mm));
  plane_ = {placement_.point(raster_.optic(index_).center_mm()),
            placement_.direction(optic_.mesh.vertices.at(0).normal)};
  outline_ = convex_hull(points, plane_.normal);
}

bool PlanarOptic::update(const RasterView& camera, const FrameOptions& options, const PlanarSight& sight) {
  multisample_ = options.multisample;
  texels_before_ = sight.texels_before;
  if (!options.reuse_static) map_changed();
  set_plane();
  const double height = plane_.height_mm(camera.origin_mm);
  const bool front = height > 0, glass = optics::is_planar_glass(optic_);
  works_ = height != 0 && (glass ? front || !optic_.one_sided : front != optic_.flip || optic_.two_sided);
  index_ratio_ =
      optic_.kind == OpticKind::refractor && !front ? 1 / optic_.material.ior : optic_.material.ior;
  if (!front) plane_.normal = -plane_.normal;
  for (Map& map : maps_) map.turn.reset();
  if (!see(camera, sight)) return false;
  if (works_) set_turns(camera, sight);
  const auto& turn = maps_[kReflected].turn;
  light_.set(sight.above, turn ? turn->plane : plane_);
  return true;
}

bool PlanarOptic::see(const RasterView& camera, const PlanarSight& sight) {
  seen_ = seen_part(camera, outline_);
  in_view_ = in_pixels(camera, seen_);
  if (!sight.checks) {
    rect_ = {{0, 0}, camera.size};
    return true;
  }
  if (seen_.empty()) return false;
  if (!sight.aperture.empty())
    in_view_ = clipped(in_view_, {sight.aperture.begin(), sight.aperture.end()}, kOffsetRoom_px);
  if (in_view_.size() < 3) return false;
  rect_ = pixel_rect(in_view_, camera.size);
  return rect_.size().x > 0 && rect_.size().y > 0;
}

void PlanarOptic::set_turns(const RasterView& camera, const PlanarSight& sight) {
  // A surface that covers everything hides both maps.
  if (optic_.material.material_alpha > 1 - kLeastShare) return;
  if (optic_.kind != OpticKind::mirror) maps_[kPassed].turn = passed_turn(camera);
  if (optic_.kind == OpticKind::mirror || !maps_[kPassed].turn || reflection_matters(camera))
    maps_[kReflected].turn = PlanarTurn{PlanarWay::reflected, tilted(camera.origin_mm, sight.sample), {}, {}};
  for (std::size_t k = 0; k < maps_.size(); ++k) {
    Map& map = maps_[k];
    if (!map.turn) continue;
    map.near = kNear * least_w(camera, *map.turn);
    if (map.turn->way == PlanarWay::displaced) {
      // w is that of the view less the part by which the eye is nearer to the plane.
      const double nearer = plane_.height_mm(map.turn->eye_mm) / plane_.height_mm(camera.origin_mm);
      map.near *= std::max(nearer, 1e-3);
    }
    map.camera = map_view(k, camera);
    map.aperture.clear();
    if (!sight.checks) continue;
    for (const glm::dvec2& p : in_view_) {
      const glm::dvec2 at = p - glm::dvec2(rect_.begin);
      map.aperture.push_back(k == kReflected ? glm::dvec2(rect_.size().x - at.x, at.y) : at);
    }
  }
}

std::optional<PlanarTurn> PlanarOptic::passed_turn(const RasterView& camera) const {
  if (glm::dot(optic_.material.tint, optic_.material.tint) == 0) return std::nullopt;
  const glm::dvec3& eye = camera.origin_mm;
  if (optics::totally_reflected(eye, plane_.point_mm, plane_, 1 / index_ratio_)) return std::nullopt;
  // The point of the face that is seen nearest to the view's axis: where the axis meets it, if it does.
  glm::dvec3 at = plane_.point_mm;
  if (in_view_.size() >= 3) {
    const glm::dvec3 axis = eye - glm::transpose(camera.rotation)[2];
    at = point_on_plane(camera, plane_, nearest_point(in_view_, glm::dvec2(camera.pixel(axis))));
    if (optics::totally_reflected(eye, at, plane_, 1 / index_ratio_)) at = plane_.point_mm;
  }
  PlanarTurn turn{PlanarWay::displaced, plane_, eye, glm::normalize(at - eye)};
  if (optic_.kind == OpticKind::pane) {
    const double cosine = -glm::dot(turn.ahead, plane_.normal);
    turn.eye_mm -= optics::plate_shift_mm(optic_.material.thickness_mm, index_ratio_, cosine) * plane_.normal;
    return turn;
  }
  const auto refracted = optics::refracted_eye(eye, at, plane_, 1 / index_ratio_);
  if (!refracted) return std::nullopt;
  return PlanarTurn{PlanarWay::refracted, plane_, *refracted, glm::normalize(at - *refracted)};
}

bool PlanarOptic::reflection_matters(const RasterView& camera) const {
  // Reflectance grows with the angle of incidence, and that is largest at a corner.
  return std::any_of(seen_.begin(), seen_.end(), [&](const glm::dvec3& corner) {
    const glm::dvec3 along = glm::normalize(corner - camera.origin_mm);
    const double cosine = std::clamp(-glm::dot(along, plane_.normal), 0.0, 1.0);
    return reflectance(optic_.kind, cosine, index_ratio_) > kLeastShare;
  });
}

optics::Plane PlanarOptic::tilted(const glm::dvec3& eye_mm, int sample) const {
  if (sample == 0 || optic_.material.roughness_rad == glm::dvec2(0)) return plane_;
  const glm::dvec3 front =
      placement_.direction(optics::tilted_normal(face_, rough_tilt(optic_.material.roughness_rad, sample)));
  optics::Plane plane = plane_;
  plane.normal = glm::dot(plane_.normal, placement_.direction(face_.normal)) > 0 ? front : -front;
  // One map has one plane: where the other side would turn to any ray of it, none is tilted.
  const bool same_side =
      plane.height_mm(eye_mm) > 0 && std::all_of(seen_.begin(), seen_.end(), [&](const glm::dvec3& corner) {
        return glm::dot(plane.normal, corner - eye_mm) < 0;
      });
  return same_side ? plane : plane_;
}

double PlanarOptic::least_w(const RasterView& camera, const PlanarTurn& turn) const {
  double least = optics::kInfinity;
  for (const glm::dvec3& p : seen_) {
    // Where the line of sight meets the plane, which for rough faces is not that of the outline.
    const double way =
        turn.plane.height_mm(camera.origin_mm) / glm::dot(camera.origin_mm - p, turn.plane.normal);
    least = std::min(least, way * camera.pixel(p).z);
  }
  return seen_.empty() ? 1 : least;
}

optics::Plane PlanarOptic::keep_plane(const PlanarTurn& turn) const {
  const optics::Plane& plane = turn.plane;
  double farthest = 0;
  for (const glm::dvec3& p : outline_) farthest = std::max(farthest, glm::distance(p, plane_.point_mm));
  farthest += std::abs(plane_.height_mm(turn.eye_mm)) + glm::distance(turn.eye_mm, plane_.point_mm);
  const glm::dvec3 out = turn.way == PlanarWay::reflected ? plane.normal : -plane.normal;
  return {plane.point_mm + (kPlaneRoom_mm + kPlaneRoomByDistance * farthest) * out, out};
}

RasterView PlanarOptic::map_view(std::size_t map, const RasterView& above) const {
  const PlanarTurn& turn = *maps_[map].turn;
  return planar_map_view(above, turn, rect_, maps_[map].near, keep_plane(turn));
}

glm::dvec2 PlanarOptic::map_offset(glm::dvec2 offset_px) const {
  return {-offset_px.x, offset_px.y};
}

const LightWay* PlanarOptic::light(std::size_t map) const {
  return map == kReflected && light_.known() ? &light_ : nullptr;
}

std::size_t PlanarOptic::draw_maps(const RasterView& above, bool geometry, Overlay* overlay,
                                   std::span<const NestedOptics> nested) {
  std::size_t drawn = 0;
  const int multisample = overlay ? 1 : available_multisamples(multisample_);
  for (std::size_t k = 0; k < maps_.size(); ++k) {
    Map& map = maps_[k];
    if (!map.turn) continue;
    const RasterView view = map_view(k, above);
    const bool kept = !overlay && map.drawn && same_view(map.drawn->view, view) &&
                      map.drawn->geometry == geometry && map.drawn->multisample == multisample;
    if (kept) continue;
    RasterTarget::fit(map.target, stepped(view.size), geometry);
    if (multisample > 1)
      RasterTarget::fit(map.smooth, map.target->size(), false, multisample);
    else
      map.smooth.reset();
    draw_map(map, view, geometry, overlay, k < nested.size() ? &nested[k] : nullptr);
    map.drawn = Drawn{view, geometry, multisample};
    if (overlay) map.drawn.reset();
    ++drawn;
  }
  return drawn;
}

void PlanarOptic::draw_map(Map& map, const RasterView& view, bool geometry, Overlay* overlay,
                           const NestedOptics* nested) {
  RasterPass pass;
  pass.draw_optics = true;
  pass.except = index_;
  const auto draw = [&](const RasterTarget& target, bool with_geometry) {
    pass.geometry = with_geometry;
    pass.multisample = target.multisample();
    target.bind(with_geometry);
    raster_.clear(view, pass);
    if (nested && !nested->optics.empty()) {
      pass.nested = nested->optics;
      nested->draw(view, pass, target);
    }
    raster_.draw_all(view, pass);
    pass.nested = {};
    if (!overlay) return;
    target.bind(false);
    overlay->draw_in_scene(view, nullptr);
  };
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, view.size.x, view.size.y);
  if (!map.smooth || geometry) draw(*map.target, geometry);
  if (map.smooth) {
    draw(*map.smooth, false);
    map.smooth->resolve_into(*map.target, !geometry);
  }
  glDisable(GL_SCISSOR_TEST);
}

void PlanarOptic::copy_maps(MapColors& maps) const {
  for (const Map& map : maps_)
    if (map.turn && map.drawn && map.turn->way != PlanarWay::refracted)
      maps.add(index_, std::span(&map.drawn->view, 1), *map.target);
}

OpticStats PlanarOptic::statistics() const {
  OpticStats stats{optic_.name, optics::kind_name(optic_.kind), optic_.mesh.vertices.size(), 0, 0, {}, 0};
  for (const Map& map : maps_) {
    if (!map.turn) continue;
    const glm::dmat4& p = map.camera.projection;
    const glm::dvec2 tangents = 2.0 / glm::dvec2(p[0][0], p[1][1]);
    stats.patches.push_back({map.camera.origin_mm,
                             0,
                             {std::atan(tangents.x), std::atan(tangents.y)},
                             {map.camera.size.x, map.camera.size.y}});
  }
  return stats;
}

std::size_t PlanarOptic::map_texels() const {
  std::size_t texels = 0;
  for (const Map& map : maps_)
    if (map.turn) texels += std::size_t(map.camera.size.x) * std::size_t(map.camera.size.y);
  return texels;
}

}  // namespace catoptra::render

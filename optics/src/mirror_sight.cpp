// What an eye sees of a place on the road through the mirror: reflection point, outline, obstructions.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "cad_import/error.h"
#include "optics/mirror_field.h"
#include "optics/src/reflection_point.h"
#include "optics/vertex_hits.h"

namespace catoptra::optics {
namespace {

/// The glass's own mesh and the rim around it are this close to where the eye's ray ends.
constexpr double kBeforeGlass_mm = 0.5;

/// Farther beside the glass than any reflection point on its continuation.
constexpr double kBesideAny_mm = 1e4;

}  // namespace

glm::dvec3 RoadFrame::coordinates(const glm::dvec3& point_mm) const {
  const glm::dvec3 offset = point_mm - origin_mm;
  return {-glm::dot(offset, forward), glm::dot(offset, left), glm::dot(offset, up)};
}

RoadFrame make_road_frame(const glm::dvec3& forward, const glm::dvec3& up, const glm::dvec3& ground_mm,
                          const glm::dvec3& eye_mm) {
  const double up_length = glm::length(up);
  if (!(up_length > 0)) throw Error("", "up", "must not be the zero vector");
  RoadFrame road;
  road.up = up / up_length;
  const glm::dvec3 level = forward - glm::dot(forward, road.up) * road.up;
  if (!(glm::length(level) > 1e-6 * glm::length(forward)))
    throw Error("", "forward", "runs along the up direction, or is the zero vector");
  road.forward = glm::normalize(level);
  road.left = glm::cross(road.up, road.forward);
  road.origin_mm = eye_mm - glm::dot(eye_mm - ground_mm, road.up) * road.up;
  return road;
}

MirrorSight::MirrorSight(const MirrorGlass& glass, SightOptions options)
    : glass_(&glass), options_(std::move(options)) {
  if (options_.eyes_mm.empty() || options_.eyes_mm.size() > 2)
    throw Error("", glass.optic().name, "a mirror is looked at with one eye or two");
  for (const glm::dvec3& eye : options_.eyes_mm) finders_.emplace_back(glass, options_.pose.to_glass(eye));
}

MirrorSight::~MirrorSight() = default;
MirrorSight::MirrorSight(MirrorSight&&) noexcept = default;

bool MirrorSight::blocked(const glm::dvec3& from, const glm::dvec3& to, double share) const {
  const auto meets = [&](const RayScene* scene, const glm::dvec3& a, const glm::dvec3& b) {
    if (!scene) return false;
    const double length = glm::distance(a, b);
    return scene->occluded({a, (b - a) / length, kSelfHitDistance_mm, share * length}, kSurroundings);
  };
  return meets(options_.vehicle, from, to) ||
         meets(options_.attached, options_.pose.to_glass(from), options_.pose.to_glass(to));
}

std::uint8_t MirrorSight::state_of(std::size_t eye, const glm::dvec3& target, bool far) const {
  const MirrorPose& pose = options_.pose;
  const SightTarget turned{far ? glm::transpose(pose.rotation) * target : pose.to_glass(target), far};
  const auto found = finders_[eye].find(turned);
  if (!found || !found->on_glass) return 0;
  if (options_.part && !options_.part(glass_->place(found->face, found->uv))) return 0;
  const glm::dvec3 on_mirror = pose.to_world(found->position_mm);
  const glm::dvec3& eye_mm = options_.eyes_mm[eye];
  const double to_mirror = glm::distance(eye_mm, on_mirror);
  if (blocked(eye_mm, on_mirror, 1 - kBeforeGlass_mm / to_mirror)) return kReflected[eye];
  // A far target stands for a point so far that nothing of the scene is beyond it.
  constexpr double kFar_mm = 1e7;
  const glm::dvec3 end = far ? on_mirror + kFar_mm * target : target;
  const double height = glm::dot(on_mirror - end, options_.road.up);
  const double low = std::max(0.0, options_.clearance_mm - options_.height_mm);
  const double share = far ? 1 : height > 0 ? std::clamp(1 - low / height, 0.0, 1.0) : 1;
  if (blocked(on_mirror, end, share)) return kReflected[eye];
  return std::uint8_t(kReflected[eye] | kSeen[eye]);
}

bool MirrorSight::sees_directly(const glm::dvec3& target) const {
  glm::dvec3 middle{0};
  for (const glm::dvec3& eye : options_.eyes_mm) middle += eye / double(options_.eyes_mm.size());
  const glm::dvec3 way = target - middle;
  const double ahead = glm::dot(way, options_.road.forward), aside = glm::dot(way, options_.road.left);
  if (std::abs(std::atan2(aside, ahead)) > options_.direct_limit_rad) return false;
  return std::any_of(options_.eyes_mm.begin(), options_.eyes_mm.end(), [&](const glm::dvec3& eye) {
    const double height = glm::dot(eye - target, options_.road.up);
    const double low = std::max(0.0, options_.clearance_mm - options_.height_mm);
    return !blocked(eye, target, height > 0 ? std::clamp(1 - low / height, 0.0, 1.0) : 1);
  });
}

std::uint8_t MirrorSight::state(const glm::dvec2& ground_mm) const {
  const glm::dvec3 target = options_.road.point(ground_mm, options_.height_mm);
  std::uint8_t bits = 0;
  for (std::size_t eye = 0; eye < finders_.size(); ++eye) bits |= state_of(eye, target, false);
  if (options_.direct_limit_rad > 0 && sees_directly(target)) bits |= kDirect;
  return bits;
}

std::uint8_t MirrorSight::state_far(const glm::dvec3& direction) const {
  std::uint8_t bits = 0;
  for (std::size_t eye = 0; eye < finders_.size(); ++eye) bits |= state_of(eye, direction, true);
  return bits;
}

double MirrorSight::inside_glass_mm(const glm::dvec2& ground_mm) const {
  const glm::dvec3 target = options_.pose.to_glass(options_.road.point(ground_mm, options_.height_mm));
  double best = -kInfinity;
  for (const ReflectionFinder& finder : finders_) {
    const auto found = finder.find({target, false});
    if (!found) {
      best = std::max(best, -kBesideAny_mm * (1 + finder.miss_angle({target, false})));
      continue;
    }
    const glm::dvec3 offset = found->position_mm - glass_->frame().center_mm;
    best = std::max(best, distance_inside_mm(glass_->outlines(), {glm::dot(offset, glass_->frame().across),
                                                                  glm::dot(offset, glass_->frame().upward)}));
  }
  return best;
}

}  // namespace catoptra::optics

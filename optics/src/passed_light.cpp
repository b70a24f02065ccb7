#include "optics/passed_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "optics/exact_hit.h"

namespace catoptra::optics {
namespace {

// Newton's method needs a start in the right region, not the nearest of all vertices.
constexpr std::size_t kStarts = 256;
constexpr int kMostSteps = 8;
// A step below this is done by the differentials alone: what they leave out is its square over the radii of
// curvature.
constexpr double kLinear_mm = 0.05;
// Steps past the optic's own size lead nowhere.
constexpr double kLongestStep = 1.0;
// Where light does not pass as far as a step leads, it is followed to the border within this share of the
// step: what goes on from there by differentials alone errs with the square of the distance, and by how much
// must not depend on where the search began.
constexpr double kLeastShare = 1.0 / 32;

struct Basis {
  glm::dvec3 a, b;  // unit, across the direction and each other
};

Basis across(const glm::dvec3& direction) {
  const glm::dvec3 other = std::abs(direction.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 a = glm::normalize(glm::cross(direction, other));
  return {a, glm::cross(direction, a)};
}

/// How the ray's miss of a point changes with its place on the optic.
struct Miss {
  Basis in, out;          // across the arriving and the leaving ray
  glm::dvec2 at{0};       // of the point from the ray
  glm::dmat2 by_step{0};  // per mm across the arriving ray
};

std::optional<Miss> miss_of(const VertexHit& ray, const glm::dvec3& point_mm) {
  const glm::dvec3 to = point_mm - ray.surface_point_mm;
  const double along = glm::dot(to, ray.direction);
  if (!(along > 0)) return std::nullopt;
  Miss miss{across(ray.from_eye), across(ray.direction), {}, {}};
  miss.at = {glm::dot(to, miss.out.a), glm::dot(to, miss.out.b)};
  const auto change = [&](const glm::dvec3& step) {
    const glm::dvec3 moved = ray.differential.point * step + along * (ray.differential.direction * step);
    return glm::dvec2(glm::dot(moved, miss.out.a), glm::dot(moved, miss.out.b));
  };
  miss.by_step = glm::dmat2(change(miss.in.a), change(miss.in.b));
  const double determinant = glm::determinant(miss.by_step);
  if (!(std::abs(determinant) > 1e-12)) return std::nullopt;  // a caustic, or not a number
  return miss;
}

/// The surface beyond its border: that of second order which touches it at `vertex`, met along `along` from a
/// place `step_mm` beside.
tessellate::OpticVertex continued(const tessellate::OpticVertex& vertex, const glm::dvec3& along,
                                  const glm::dvec3& step_mm) {
  tessellate::OpticVertex beyond = vertex;
  const glm::dvec3& n = vertex.normal;
  const glm::dvec3 in_plane = step_mm - along * (glm::dot(step_mm, n) / glm::dot(along, n));
  const glm::dvec3 direction2 = glm::cross(n, vertex.direction1);
  const double x = glm::dot(in_plane, vertex.direction1), y = glm::dot(in_plane, direction2);
  beyond.position_mm += in_plane - 0.5 * (vertex.k1 * x * x + vertex.k2 * y * y) * n;
  beyond.normal = glm::normalize(n + vertex.k1 * x * vertex.direction1 + vertex.k2 * y * direction2);
  return beyond;
}

/// The point of the exact surface that a ray along `along` meets from a place `step_mm` beside the vertex.
tessellate::OpticVertex moved_vertex(const LensSideView& side, const tessellate::OpticVertex& vertex,
                                     const glm::dvec3& along, const glm::dvec3& step_mm) {
  const cad_import::ExactSurface& surface = *side.faces[std::size_t(vertex.face)].surface;
  const double back = 10 + 10 * glm::length(step_mm);
  const auto hit = newton_hit(surface, {vertex.position_mm + step_mm - back * along, along}, vertex.uv);
  if (!hit) return continued(vertex, along, step_mm);
  const auto curvature = surface.principal_curvatures(hit->uv.x, hit->uv.y);
  return {hit->position_mm,     hit->normal, curvature.k1, curvature.k2,
          curvature.direction1, vertex.face, hit->uv};
}

/// The ray through the point, by the differentials of one near it.
Arrival arrival_by(const VertexHit& ray, const Miss& miss, const glm::dvec3& step_mm,
                   const glm::dvec3& point_mm) {
  Arrival arrival;
  arrival.origin_mm = ray.surface_point_mm + ray.differential.point * step_mm;
  arrival.direction = glm::normalize(point_mm - arrival.origin_mm);
  const glm::dmat2 step_by_miss = glm::inverse(miss.by_step);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec2 step = step_by_miss * glm::dvec2(miss.out.a[axis], miss.out.b[axis]);
    arrival.turn[axis] = ray.differential.direction * (step.x * miss.in.a + step.y * miss.in.b);
  }
  return arrival;
}

}  // namespace

PassedLight::PassedLight(const Optic& optic, LensSide entered, const LensTracer* tracer,
                         const LensIndices& indices, std::span<const VertexHit> rays, ArrivalAt arrival)
    : optic_(&optic),
      entered_(entered),
      tracer_(tracer),
      indices_(indices),
      side_(optic.kind == OpticKind::lens ? side_of(optic, entered) : LensSideView{optic.faces, &optic.mesh}),
      rays_(rays),
      arrival_(std::move(arrival)) {
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays[i].faces_eye && rays[i].end == LensPathEnd::passed) open.push_back(i);
  const std::size_t count = std::min(kStarts, open.size());
  for (std::size_t k = 0; k < count; ++k) starts_.push_back(open[k * open.size() / count]);
  for (const std::size_t i : open)
    reach_mm_ = std::max(reach_mm_, glm::distance(side_.mesh->vertices[i].position_mm,
                                                  side_.mesh->vertices[open[0]].position_mm));
}

std::optional<std::size_t> PassedLight::nearest(const glm::dvec3& point_mm) const {
  std::optional<std::size_t> best;
  double best_cosine = 0;
  for (const std::size_t i : starts_) {
    const glm::dvec3 to = point_mm - rays_[i].surface_point_mm;
    const double cosine = glm::dot(to, rays_[i].direction) / glm::length(to);
    if (cosine > best_cosine) {
      best = i;
      best_cosine = cosine;
    }
  }
  return best;
}

std::optional<PassedLight::Place> PassedLight::moved(const Place& from, const glm::dvec3& step_mm) const {
  Place place{moved_vertex(side_, from.vertex, from.ray.from_eye, step_mm), {}};
  const Arrival arrival = arrival_(place.vertex.position_mm);
  place.ray = optic_->kind == OpticKind::lens
                  ? refract_vertex(place.vertex, *optic_, *tracer_, entered_, indices_, arrival)
                  : reflect_vertex(place.vertex, *optic_, arrival);
  if (!place.ray.faces_eye) return std::nullopt;
  return place;
}

std::optional<Arrival> PassedLight::to(const glm::dvec3& point_mm) const {
  const auto start = nearest(point_mm);
  if (!start) return std::nullopt;
  Place place{side_.mesh->vertices[*start], rays_[*start]};
  double share = 1;
  for (int step = 0;;) {
    const auto miss = miss_of(place.ray, point_mm);
    if (!miss) return std::nullopt;
    const glm::dvec2 across_mm = glm::inverse(miss->by_step) * miss->at;
    const double length = glm::length(across_mm);
    if (!(length < kLongestStep * reach_mm_)) return std::nullopt;
    const glm::dvec3 step_mm = across_mm.x * miss->in.a + across_mm.y * miss->in.b;
    std::optional<Place> next;
    if (step < kMostSteps)
      for (; !next && share * length >= kLinear_mm && share >= kLeastShare; share *= next ? 1 : 0.5)
        next = moved(place, share * step_mm);
    if (!next) {
      Arrival arrival = arrival_by(place.ray, *miss, step_mm, point_mm);
      arrival.beyond_mm = std::max(length < kLinear_mm ? 0 : length, place.ray.beyond_mm);
      return arrival;
    }
    place = *next;
    ++step;
  }
}

}  // namespace catoptra::optics

#include "render/src/ray_tracer_planar.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "optics/refraction.h"
#include "render/src/ray_tracer_chain_query.h"
#include "render/src/sampling.h"

namespace catoptra::render {
namespace {

constexpr int kLanes = TracedPlanars::kLanes;

/// Cosine of incidence below which nothing passes a pane: its displaced line would start 1e6 thicknesses off.
constexpr double kGrazing = 1e-6;

/// Slab of index n: the change of g = 1 / c - 1 / sqrt(n^2 - 1 + c^2) by the cosine c of incidence.
double shift_slope(double cosine, double ior) {
  const double inside = ior * ior - 1 + cosine * cosine;
  return -1 / (cosine * cosine) + cosine / (inside * std::sqrt(inside));
}

void meet_plane(const glm::dvec3& on_plane, const glm::dvec3& normal, const BeamLanes& beams, int i,
                MetLanes& at) {
  const glm::dvec3 from = beams.point.at(i), d = beams.direction.at(i);
  const double cosine = glm::dot(normal, d), way = glm::dot(normal, on_plane - from) / cosine;
  const auto in_plane = [&](const glm::dvec3& point, const glm::dvec3& direction) {
    const glm::dvec3 moved = point + way * direction;
    return moved - glm::dot(normal, moved) / cosine * d;
  };
  at.distance[i] = way;
  at.point.set(i, from + way * d);
  at.normal.set(i, normal);
  at.point_right.set(i, in_plane(beams.point_right.at(i), beams.direction_right.at(i)));
  at.point_down.set(i, in_plane(beams.point_down.at(i), beams.direction_down.at(i)));
  at.normal_right.set(i, glm::dvec3(0));
  at.normal_down.set(i, glm::dvec3(0));
}

/// The line behind a plate, with its differentials: of Q - t g(c) (d - (d . n) n), see plate_shift().
void pass_plate(const optics::PlanarMaterial& plate, const BeamLanes& beams, const MetLanes& at, int i,
                BeamLanes& out) {
  const glm::dvec3 d = beams.direction.at(i), n = at.normal.at(i);
  const double along_n = glm::dot(d, n), cosine = std::abs(along_n), sense = along_n < 0 ? -1 : 1;
  const double g = 1 / cosine - 1 / std::sqrt(plate.ior * plate.ior - 1 + cosine * cosine);
  const double slope = shift_slope(cosine, plate.ior);
  const glm::dvec3 along = d - along_n * n;
  const auto shifted = [&](const glm::dvec3& point, const glm::dvec3& turn) {
    const double cosine_turn = sense * glm::dot(turn, n);
    return point - plate.thickness_mm * (g * (turn - glm::dot(turn, n) * n) + slope * cosine_turn * along);
  };
  out.point.set(i, at.point.at(i) + optics::plate_shift(d, n, plate.ior, plate.thickness_mm));
  out.direction.set(i, d);
  out.direction_right.set(i, beams.direction_right.at(i));
  out.direction_down.set(i, beams.direction_down.at(i));
  out.point_right.set(i, shifted(at.point_right.at(i), beams.direction_right.at(i)));
  out.point_down.set(i, shifted(at.point_down.at(i), beams.direction_down.at(i)));
}

void copy_beam(const BeamLanes& from, int i, BeamLanes& to) {
  to.point.set(i, from.point.at(i));
  to.direction.set(i, from.direction.at(i));
  to.point_right.set(i, from.point_right.at(i));
  to.point_down.set(i, from.point_down.at(i));
  to.direction_right.set(i, from.direction_right.at(i));
  to.direction_down.set(i, from.direction_down.at(i));
}

bool is_rough(const optics::Optic& optic) {
  return optic.planar && optic.material.roughness_rad != glm::dvec2(0);
}

}  // namespace

TracedPlanars::TracedPlanars(const Scene& scene)
    : scene_(scene), faces_(scene.optics.size()), special_(scene.optics.size(), 0) {
  for (std::size_t i = 0; i < scene.optics.size(); ++i) {
    const optics::Optic& optic = scene.optics[i];
    if (!optic.planar) continue;
    faces_[i] = optics::planar_face(optic);
    const bool surface = optic.material.material_alpha > 0;
    any_surface_ = any_surface_ || surface;
    special_[i] = optics::is_planar_glass(optic) || surface || is_rough(optic);
    any_special_ = any_special_ || special_[i];
    if (!optics::is_planar_glass(optic)) continue;
    glass_.push_back(i);
    rays_.add_optic(optic.mesh);
  }
  rays_.commit();
}

void TracedPlanars::optic_changed(std::size_t index) {
  const optics::Optic& optic = scene_.optics[index];
  if (!optic.planar) return;
  faces_[index] = optics::planar_face(optic);
  const auto object = std::ranges::find(glass_, index);
  if (object == glass_.end()) return;
  rays_.update_optic(std::uint32_t(object - glass_.begin()), optic.mesh);
  rays_.commit();
}

bool TracedPlanars::find_next(const optics::RayPacket16& rays, const LeftOptics& left, MetOptics& met) const {
  if (glass_.empty()) return false;
  optics::RayPacket16 query = rays;
  float limit[kLanes];
  bool waiting = false, found = false;
  for (int i = 0; i < kLanes; ++i) {
    limit[i] = met.optic[i] >= 0 ? std::min(rays.t_max[i], met.distance[i]) : rays.t_max[i];
    query.t_max[i] = left.active[i] ? limit[i] : query.t_min[i] - 1;
    waiting |= left.active[i];
  }
  // A ray passes every plane once at most, so this ends.
  while (waiting) {
    rays_.intersect16(query, optics::kOptics, true);
    waiting = false;
    for (int i = 0; i < kLanes; ++i) {
      if (query.t_max[i] < query.t_min[i]) continue;
      if (query.object[i] == optics::kNoHit) {
        query.t_max[i] = query.t_min[i] - 1;
        continue;
      }
      const std::size_t optic = glass_[query.object[i]];
      const glm::dvec3 d(query.direction_x[i], query.direction_y[i], query.direction_z[i]);
      const bool from_behind = glm::dot(faces_[optic].normal, d) > 0;
      if (left.optic[i] == int(optic) || (from_behind && scene_.optics[optic].one_sided)) {
        query.t_min[i] = query.t_max[i] * (1 + 1e-6f) + 1e-3f;
        query.t_max[i] = limit[i];
        waiting |= query.t_max[i] >= query.t_min[i];
        continue;
      }
      found = true;
      set_met(query, i, int(optic), optics::LensSide::front, met);
      query.t_max[i] = query.t_min[i] - 1;
    }
  }
  return found;
}

void TracedPlanars::meet(const BeamLanes& beams, const int (&optic)[kLanes], MetLanes& at) const {
  for (int i = 0; i < kLanes; ++i) {
    if (optic[i] < 0 || !scene_.optics[std::size_t(optic[i])].planar) continue;
    const optics::PlanarFace& face = faces_[std::size_t(optic[i])];
    meet_plane(face.centre_mm, face.normal, beams, i, at);
  }
}

void TracedPlanars::meet_tilted(const BeamLanes& beams, const int (&optic)[kLanes], int sample,
                                MetLanes& at) const {
  meet(beams, optic, at);
  if (sample == 0 || !any_special_) return;
  for (int i = 0; i < kLanes; ++i) {
    if (optic[i] < 0 || !is_rough(scene_.optics[std::size_t(optic[i])])) continue;
    const optics::PlanarFace& face = faces_[std::size_t(optic[i])];
    const glm::dvec2 tilt = rough_tilt(scene_.optics[std::size_t(optic[i])].material.roughness_rad, sample);
    const glm::dvec3 normal = optics::tilted_normal(face, tilt);
    const glm::dvec3 d = beams.direction.at(i), from = beams.point.at(i);
    // The ray, if need be beyond where it starts, has to come from the same side.
    const bool same_side = glm::dot(normal, d) * glm::dot(face.normal, d) > 0 &&
                           glm::dot(normal, face.centre_mm - from) * glm::dot(normal, d) > 0;
    if (same_side) meet_plane(face.centre_mm, normal, beams, i, at);
  }
}

void TracedPlanars::pass(const BeamLanes& beams, const MetLanes& at, const int (&optic)[kLanes],
                         PassedBeams& out) const {
  double eta[kLanes];
  double border[kLanes];
  bool any_refractor = false;
  for (int i = 0; i < kLanes; ++i) {
    eta[i] = 1;
    out.reflected[i] = 1;
    if (optic[i] < 0) continue;
    const optics::Optic& glass = scene_.optics[std::size_t(optic[i])];
    const bool plate = glass.kind == optics::OpticKind::pane;
    const double along = glm::dot(beams.direction.at(i), at.normal.at(i)),
                 cosine = std::min(1.0, std::abs(along));
    const bool leaves = !plate && along > 0;  // from behind a refractor: out of the glass
    const double from = leaves ? glass.material.ior : 1, to = leaves ? 1 : glass.material.ior;
    border[i] = optics::fresnel_dielectric(cosine, from, to).unpolarised;
    eta[i] = from / to;
    any_refractor |= !plate;
    if (!plate) continue;
    out.reflected[i] = cosine > kGrazing ? optics::plate_reflectance(border[i]) : 1;
    if (out.reflected[i] < 1) pass_plate(glass.material, beams, at, i, out.beams);
  }
  if (!any_refractor) return;
  RefractedBeams refracted;
  refract_beams(beams, at, eta, refracted);
  for (int i = 0; i < kLanes; ++i) {
    if (optic[i] < 0 || scene_.optics[std::size_t(optic[i])].kind != optics::OpticKind::refractor) continue;
    if (!refracted.possible[i] || border[i] >= 1) continue;
    out.reflected[i] = border[i];
    copy_beam(refracted.beams, i, out.beams);
  }
}

}  // namespace catoptra::render

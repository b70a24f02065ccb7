#include "cad_import/lens_faces.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <set>

#include "cad_import/face_groups.h"
#include "cad_import/src/lens_side.h"

namespace catoptra::cad_import {
namespace {

/// Share of a group's area that its area vector keeps: 1 for a plane, 0.5 for a half ball, 0 around a rim.
constexpr double kFlatEnough = 0.5;
/// Directions in which front and back of a strong prism (30 prism dioptre) or a wrapped lens look.
const double kOpposite = -std::cos(glm::radians(35.0));
/// A pair is the lens where it holds this share of what the body shows along the axis, from both ends.
constexpr double kMostOfView = 0.6;
constexpr std::size_t kMostFaces = 64;

std::vector<Face> faces_at(const CadModel& model, std::span<const int> indices) {
  std::vector<Face> faces;
  for (const int index : indices) faces.push_back(model.faces[std::size_t(index)]);
  return faces;
}

/// The coordinate axis within `degrees`, where there is one.
std::optional<glm::dvec3> coordinate_axis(const glm::dvec3& axis, double degrees) {
  for (int i = 0; i < 3; ++i)
    if (std::abs(axis[i]) > std::cos(glm::radians(degrees))) {
      glm::dvec3 exact{0};
      exact[i] = std::copysign(1.0, axis[i]);
      return exact;
    }
  return std::nullopt;
}

/// The axis of measure_lens, and a point on it.
struct Axis {
  glm::dvec3 direction{0, 0, 1}, point{0};
};

[[noreturn]] void refuse_sides(const std::string& file) {
  throw Error(file, "lens", "front and back do not lie behind one another",
              "name the faces of both sides; catoptra info lists them");
}

/// From the back to the front, roughly. The borders of both may be one and the same: a knife's edge.
glm::dvec3 from_back_to_front(const LensSide& front, const LensSide& back) {
  const glm::dvec3 apart = front.middle() - back.middle();
  if (glm::length(apart) > 1e-6 * (1 + front.extent_mm())) return apart;
  return front.inner_point() - back.inner_point();
}

Axis find_axis(const LensSide& front, const LensSide& back, const std::string& file) {
  const glm::dvec3 apart = from_back_to_front(front, back);
  if (!(glm::length(apart) > 1e-9 * (1 + front.extent_mm())))
    throw Error(file, "lens", "front and back coincide: there is no glass between them",
                "give two different surfaces");
  const auto along = [&](const glm::dvec3& area) { return glm::dot(area, apart) < 0 ? -area : area; };
  const glm::dvec3 first = along(front.area_vector()), sum = first + along(back.area_vector());
  if (!(glm::length(first) > 0 && glm::length(sum) > 0)) refuse_sides(file);
  const auto drawn = coordinate_axis(glm::normalize(first), 2);
  Axis axis{drawn.value_or(glm::normalize(sum)), front.middle()};
  const auto at_front = front.on_line(axis.point, axis.direction);
  const auto at_back = back.on_line(axis.point, axis.direction);
  if (!drawn && at_front && at_back)
    if (const auto normal = common_normal(*at_front, *at_back, 0.5 * front.extent_mm())) {
      const glm::dvec3 line = glm::normalize(normal->front.position - normal->back.position);
      return {coordinate_axis(line, 0.01).value_or(line), normal->front.position};
    }
  std::optional<SidePoint> vertex = at_front ? front.vertex(*at_front, axis.direction) : std::nullopt;
  if (!vertex && at_back) vertex = back.vertex(*at_back, axis.direction);
  if (vertex) axis.point = vertex->position;
  return axis;
}

/// Curvatures at a point as seen from the side to which `outwards` points.
PrincipalCurvatures curvatures(const SidePoint& at, const glm::dvec3& outwards) {
  PrincipalCurvatures k = at.face->surface->principal_curvatures(at.uv.x, at.uv.y);
  if (glm::dot(at.face->surface->unit_normal(at.uv.x, at.uv.y), outwards) >= 0) return k;
  // From the other side the signs change, and with them the order; direction2 = normal x direction1.
  return {-k.k2, -k.k1, k.direction2, k.direction1};
}

struct Group {
  std::vector<int> faces;
  glm::dvec3 area{0};
  double area_mm2 = 0;
  bool planar = true;
};

std::vector<Group> groups_of_body(const CadModel& model, int body, const std::vector<std::vector<int>>& all) {
  std::vector<Group> groups;
  for (const std::vector<int>& faces : all) {
    if (model.faces[std::size_t(faces.front())].body != body) continue;
    Group group{faces};
    for (const int index : faces) {
      const Face& face = model.faces[std::size_t(index)];
      group.area += area_vector(face);
      group.area_mm2 += face.area_mm2;
      group.planar = group.planar && face.planar;
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

struct Pair {
  const Group* first = nullptr;
  const Group* second = nullptr;
  double size = 0;  // the smaller of both area vectors' lengths, mm^2
};

Pair largest_pair(const std::vector<Group>& groups) {
  Pair best;
  const auto candidate = [](const Group& g) { return glm::length(g.area) > kFlatEnough * g.area_mm2; };
  for (std::size_t i = 0; i < groups.size(); ++i)
    for (std::size_t k = i + 1; k < groups.size(); ++k) {
      const Group &a = groups[i], &b = groups[k];
      if ((a.planar && b.planar) || !candidate(a) || !candidate(b)) continue;
      const double la = glm::length(a.area), lb = glm::length(b.area);
      if (glm::dot(a.area, b.area) > kOpposite * la * lb) continue;
      if (const double size = std::min(la, lb); size > best.size) best = {&a, &b, size};
    }
  return best;
}

bool any_called(const CadModel& model, const std::vector<int>& faces, const std::string& name) {
  return std::any_of(faces.begin(), faces.end(), [&](int index) {
    std::string text = model.faces[std::size_t(index)].name;
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text.find(name) != std::string::npos;
  });
}

LensFaces measured(const CadModel& model, std::vector<int> front, std::vector<int> back) {
  LensFaces lens{std::move(front), std::move(back), {}, {}};
  const std::vector<Face> front_faces = faces_at(model, lens.front), back_faces = faces_at(model, lens.back);
  lens.geometry = measure_lens(front_faces, back_faces, model.file);
  return lens;
}

/// Puts the two sides of a pair in order and measures them.
LensFaces oriented(const CadModel& model, const std::vector<int>& a, const std::vector<int>& b) {
  if (any_called(model, a, "front") || any_called(model, b, "back")) return measured(model, a, b);
  if (any_called(model, b, "front") || any_called(model, a, "back")) return measured(model, b, a);
  LensFaces lens = measured(model, a, b);
  const auto mean = [](const PrincipalCurvatures& k) { return 0.5 * (k.k1 + k.k2); };
  const double more = mean(lens.geometry.front_curvature) - mean(lens.geometry.back_curvature);
  const glm::dvec3& axis = lens.geometry.axis;
  const bool upwards = axis.x + axis.y + axis.z > 0;
  // Curvatures that differ by less than a radius of 1 km does from flat are equal.
  const bool keep = std::abs(more) > 1e-6 ? more > 0 : upwards;
  return keep ? lens : measured(model, b, a);
}

void add_rim(const CadModel& model, LensFaces& lens) {
  const int body = model.faces[std::size_t(lens.front.front())].body;
  if (!model.bodies[std::size_t(body)].solid) return;
  std::set<int> optical(lens.front.begin(), lens.front.end());
  optical.insert(lens.back.begin(), lens.back.end());
  for (const int index : model.bodies[std::size_t(body)].faces)
    if (!optical.contains(index)) lens.rim.push_back(index);
}

/// The group that looks most against `side`, in the same body and apart from it.
std::vector<int> facing(const CadModel& model, const std::vector<int>& side) {
  const int body = model.faces[std::size_t(side.front())].body;
  glm::dvec3 area{0};
  for (const int index : side) area += area_vector(model.faces[std::size_t(index)]);
  const std::vector<Group> groups = groups_of_body(model, body, smooth_face_groups(model, {.planar = true}));
  const Group* best = nullptr;
  double most = 0;
  for (const Group& group : groups) {
    if (std::any_of(group.faces.begin(), group.faces.end(),
                    [&](int face) { return std::find(side.begin(), side.end(), face) != side.end(); }))
      continue;
    const double against = -glm::dot(group.area, glm::normalize(area));
    if (against > most && against > kFlatEnough * group.area_mm2) {
      most = against;
      best = &group;
    }
  }
  if (!best) throw Error(model.file, "lens", "has only one surface along its axis", "name both sides");
  return best->faces;
}

LensFaces from_given(const CadModel& model, std::vector<int> front, std::vector<int> back) {
  for (std::vector<int>* side : {&front, &back}) {
    for (const int index : *side)
      if (index < 0 || std::size_t(index) >= model.faces.size())
        throw Error(model.file, "face " + std::to_string(index),
                    "the file has only " + std::to_string(model.faces.size()) + " faces, numbered from 0");
    std::sort(side->begin(), side->end());
  }
  if (front.empty()) front = facing(model, back);
  if (back.empty()) back = facing(model, front);
  for (const int face : front)
    if (std::binary_search(back.begin(), back.end(), face))
      throw Error(model.file, "face " + std::to_string(face), "is on the front and on the back",
                  "name different faces for both sides");
  LensFaces lens = measured(model, std::move(front), std::move(back));
  add_rim(model, lens);
  return lens;
}

}  // namespace

LensGeometry measure_lens(std::span<const Face> front, std::span<const Face> back, const std::string& file) {
  if (front.empty() || back.empty())
    throw Error(file, "lens", "has only one surface", "a lens needs a front and a back");
  const LensSide front_side(front), back_side(back);
  const Axis axis = find_axis(front_side, back_side, file);
  const glm::dvec3 through = axis.point;
  LensGeometry lens;
  lens.axis = axis.direction;
  const auto at_front = front_side.on_line(through, lens.axis),
             at_back = back_side.on_line(through, lens.axis);
  if (!at_front || !at_back) refuse_sides(file);
  lens.front_vertex_mm = at_front->position;
  lens.back_vertex_mm = at_back->position;
  lens.center_thickness_mm = glm::dot(at_front->position - at_back->position, lens.axis);
  lens.front_curvature = curvatures(*at_front, lens.axis);
  lens.back_curvature = curvatures(*at_back, -lens.axis);

  // Between the vertex and the rim. The rim itself may be a knife's edge.
  const std::size_t stride = std::max<std::size_t>(1, front_side.boundary().size() / 16);
  for (std::size_t i = 0; i < front_side.boundary().size(); i += stride)
    for (const double share : {0.0, 0.5, 0.9}) {
      const glm::dvec3 p = through + share * (front_side.boundary()[i] - through);
      const auto f = front_side.on_line(p, lens.axis), b = back_side.on_line(p, lens.axis);
      if (!f || !b) continue;
      const double thickness = glm::dot(f->position - b->position, lens.axis);
      if (!(thickness > 0))
        throw Error(file, "lens",
                    "front and back cross: the thickness " + std::to_string(glm::distance(p, through)) +
                        " mm from the axis is " + std::to_string(thickness) + " mm",
                    "make the lens thicker or smaller");
    }
  return lens;
}

LensFaces recognise_lens(const CadModel& model, std::span<const int> front, std::span<const int> back) {
  if (!front.empty() || !back.empty())
    return from_given(model, {front.begin(), front.end()}, {back.begin(), back.end()});
  const auto all = smooth_face_groups(model, {.planar = true});
  bool any_solid = false;
  std::vector<int> a, b;
  double size = 0;
  for (std::size_t body = 0; body < model.bodies.size(); ++body) {
    if (!model.bodies[body].solid) continue;
    any_solid = true;
    const std::vector<Group> groups = groups_of_body(model, int(body), all);
    const Pair pair = largest_pair(groups);
    if (pair.size <= size) continue;
    size = pair.size;
    a = pair.first->faces;
    b = pair.second->faces;
  }
  if (!any_solid)
    throw Error(model.file, "lens", "is an open shell, not a closed solid",
                "close it in the CAD system, or name the faces of both sides");
  if (a.empty())
    throw Error(model.file, "lens", "no two curved sides face away from each other along an axis",
                "name the faces of both sides");
  LensFaces lens = oriented(model, a, b);
  add_rim(model, lens);
  return lens;
}

std::optional<LensFaces> lens_in_body(const CadModel& model, int body) {
  const Body& solid = model.bodies[std::size_t(body)];
  if (!solid.solid || solid.faces.size() > kMostFaces) return std::nullopt;
  const auto has = [&](const char* name) {
    return std::any_of(solid.faces.begin(), solid.faces.end(),
                       [&](int face) { return model.faces[std::size_t(face)].name == name; });
  };
  if (has("Glass") && has("Back")) return std::nullopt;  // by shape, it could be a lens without power
  const std::vector<Group> groups = groups_of_body(model, body, smooth_face_groups(model, {.planar = true}));
  const Pair pair = largest_pair(groups);
  if (!pair.first) return std::nullopt;
  const glm::dvec3 axis = glm::normalize(pair.first->area - pair.second->area);
  double shown = 0;  // by both ends: all faces' areas along the axis, which closedness makes equal both ways
  for (const Group& group : groups) shown += std::abs(glm::dot(group.area, axis));
  const double pair_shown = glm::dot(pair.first->area - pair.second->area, axis);
  if (pair_shown < kMostOfView * shown) return std::nullopt;
  try {
    LensFaces lens = oriented(model, pair.first->faces, pair.second->faces);
    if (lens.geometry.center_thickness_mm > std::sqrt(pair.size)) return std::nullopt;
    add_rim(model, lens);
    return lens;
  } catch (const Error&) {
    return std::nullopt;  // crossing sides and the like: not a lens
  }
}

}  // namespace catoptra::cad_import

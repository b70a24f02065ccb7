#include "cad_import/face_groups.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <numeric>
#include <string>

namespace catoptra::cad_import {
namespace {

/// Normals of two faces that differ by less than 1 degree at their edge make one surface: CAD patches of one
/// designed surface join to 0.1 degree or so, while the bevel of a glass turns by tens of degrees.
const double kSmoothJoinCosine = std::cos(glm::radians(1.0));

/// Disjoint sets over face indices.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[std::size_t(i)] != i)
      i = parent_[std::size_t(i)] = parent_[std::size_t(parent_[std::size_t(i)])];
    return i;
  }
  void join(int a, int b) { parent_[std::size_t(find(a))] = find(b); }

 private:
  std::vector<int> parent_;
};

struct FaceAtEdge {
  int face;
  const EdgeUse* use;
};

glm::dvec3 normal_at_middle(const CadModel& model, const FaceAtEdge& side) {
  const glm::dvec2 uv = side.use->curve->uv(0.5 * (side.use->t_begin + side.use->t_end));
  return model.faces[std::size_t(side.face)].surface->unit_normal(uv.x, uv.y);
}

bool takes_part(const Face& face, const FaceGrouping& grouping) {
  return face.surface && (grouping.planar || !face.planar);
}

void join_smooth_neighbours(const CadModel& model, const FaceGrouping& grouping, Groups& groups) {
  std::map<int, std::vector<FaceAtEdge>> sides;
  for (const Face& face : model.faces) {
    if (!takes_part(face, grouping)) continue;
    for (const auto& loop : face.loops)
      for (const EdgeUse& use : loop.edges)
        if (!use.degenerate && use.curve) sides[use.edge].push_back({face.index, &use});
  }
  for (const auto& [edge, faces] : sides)
    for (std::size_t i = 1; i < faces.size(); ++i)
      if (faces[i].face != faces[0].face &&
          glm::dot(normal_at_middle(model, faces[0]), normal_at_middle(model, faces[i])) > kSmoothJoinCosine)
        groups.join(faces[0].face, faces[i].face);
}

void join_same_names(const CadModel& model, const FaceGrouping& grouping, Groups& groups) {
  std::map<std::string, int> first;
  for (const Face& face : model.faces) {
    if (!takes_part(face, grouping) || face.name.empty()) continue;
    const auto [found, is_new] = first.emplace(face.name, face.index);
    if (!is_new) groups.join(found->second, face.index);
  }
}

}  // namespace

std::vector<std::vector<int>> smooth_face_groups(const CadModel& model, const FaceGrouping& grouping) {
  Groups sets(model.faces.size());
  join_smooth_neighbours(model, grouping, sets);
  if (grouping.same_names) join_same_names(model, grouping, sets);
  std::map<int, std::vector<int>> by_root;
  for (const Face& face : model.faces)
    if (takes_part(face, grouping)) by_root[sets.find(face.index)].push_back(face.index);
  std::vector<std::vector<int>> groups;
  for (auto& [root, group] : by_root) groups.push_back(std::move(group));
  return groups;
}

}  // namespace catoptra::cad_import

#include "app/src/mirror_faces.h"

#include <algorithm>
#include <cstdint>
#include <set>

#include "app/src/nearest_name.h"
#include "cad_import/error.h"
#include "cad_import/face_groups.h"

namespace catoptra::app {
namespace {

using cad_import::CadModel;
using cad_import::Face;

/// Groups within this share of the largest are equally large: front and back of a bent sheet differ by less,
/// and which is larger by rounding must not decide.
constexpr double kEquallyLarge = 0.99;

/// A second group above this share of the largest may be meant as well: front and back of a glass differ by 1
/// or 2 %.
constexpr double kNearlyAsLarge = 0.9;

std::vector<std::string> names_to_suggest(const CadModel& model) {
  std::set<std::string> names;
  for (const Face& face : model.faces) names.insert(face.name.empty() ? face.id : face.name);
  for (const auto& body : model.bodies)
    if (!body.name.empty()) names.insert(body.name);
  return {names.begin(), names.end()};
}

std::vector<int> faces_called(const CadModel& model, const std::string& text) {
  std::vector<int> found;
  for (const Face& face : model.faces)
    if (face.name == text) found.push_back(face.index);
  if (found.empty())
    for (const Face& face : model.faces)
      if (face.id == text) found.push_back(face.index);
  if (found.empty())
    for (const auto& body : model.bodies)
      if (body.name == text) found.insert(found.end(), body.faces.begin(), body.faces.end());
  if (found.empty())
    throw Error(model.file, "face '" + text + "'", "no face or body has this name or id",
                hint_for_unknown(text, names_to_suggest(model)));
  return found;
}

}  // namespace

std::vector<FaceSelector> read_face_selectors(const TomlTable& table, std::string_view key) {
  const toml::node* node = table.node(key);
  if (!node) return {};
  const toml::array* array = node->as_array();
  if (!array) table.fail(key, "expected an array of names, ids or indices", "[\"Glass\"]");
  std::vector<FaceSelector> selectors;
  for (const toml::node& element : *array) {
    if (const auto text = element.as_string()) {
      selectors.emplace_back(text->get());
    } else if (const auto index = element.as_integer();
               index && index->get() >= 0 && index->get() <= INT32_MAX) {
      selectors.emplace_back(static_cast<int>(index->get()));
    } else {
      table.fail(key, "expected names or ids (strings) or indices (integers from 0)");
    }
  }
  return selectors;
}

std::vector<int> select_faces(const CadModel& model, std::span<const FaceSelector> selectors) {
  std::set<int> chosen;
  for (const FaceSelector& selector : selectors) {
    if (const int* index = std::get_if<int>(&selector)) {
      if (*index >= static_cast<int>(model.faces.size()))
        throw Error(model.file, "face " + std::to_string(*index),
                    "the file has only " + std::to_string(model.faces.size()) + " faces, numbered from 0",
                    "see 'catoptra info'");
      chosen.insert(*index);
    } else {
      const auto found = faces_called(model, std::get<std::string>(selector));
      chosen.insert(found.begin(), found.end());
    }
  }
  return {chosen.begin(), chosen.end()};
}

std::vector<FaceGroup> curved_face_groups(const CadModel& model) {
  std::vector<FaceGroup> groups;
  for (const std::vector<int>& faces : cad_import::smooth_face_groups(model, {.same_names = true})) {
    FaceGroup group{faces, 0, ""};
    for (const int index : faces) {
      const Face& face = model.faces[std::size_t(index)];
      group.area_mm2 += face.area_mm2;
      if (group.label.empty()) group.label = face.name.empty() ? face.id : face.name;
    }
    groups.push_back(std::move(group));
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const FaceGroup& a, const FaceGroup& b) { return a.area_mm2 > b.area_mm2; });
  return groups;
}

DefaultFaces default_mirror_faces(const CadModel& model) {
  const auto groups = curved_face_groups(model);
  if (groups.empty()) {
    const auto largest =
        std::max_element(model.faces.begin(), model.faces.end(),
                         [](const Face& a, const Face& b) { return a.area_mm2 < b.area_mm2; });
    if (largest == model.faces.end()) return {};
    return {{largest->index}, ""};
  }
  const FaceGroup* chosen = &groups[0];
  for (const FaceGroup& group : groups)
    if (group.area_mm2 > kEquallyLarge * groups[0].area_mm2 && group.faces[0] < chosen->faces[0])
      chosen = &group;
  DefaultFaces result{chosen->faces, ""};
  for (const FaceGroup& other : groups) {
    if (&other == chosen || other.area_mm2 <= kNearlyAsLarge * groups[0].area_mm2) continue;
    result.warning = model.file + ": '" + chosen->label + "' taken as the mirror, but '" + other.label +
                     "' is nearly as large: choose with faces = [...]";
    break;
  }
  return result;
}

}  // namespace catoptra::app

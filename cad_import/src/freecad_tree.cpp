#include "cad_import/src/freecad_tree.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "cad_import/error.h"
#include "cad_import/src/freecad_cycles.h"

namespace catoptra::cad_import {
namespace {

constexpr std::size_t kMostShapes = 100'000;
constexpr std::size_t kMostVisits = 1'000'000;  // arrays of arrays of nothing
constexpr int kMostNested = 200;                // no person nests so deep; it keeps the stack in bounds

bool starts_with(std::string_view text, std::string_view begin) {
  return text.substr(0, begin.size()) == begin;
}

/// Help geometry that FreeCAD draws but that is no part of the model.
bool is_datum(std::string_view type) {
  for (const std::string_view name :
       {"App::Origin", "App::Plane", "App::Line", "App::Point", "App::LocalCoordinateSystem",
        "App::DatumElement", "PartDesign::Plane", "PartDesign::Line", "PartDesign::Point",
        "PartDesign::CoordinateSystem", "Part::Datum", "Part::LocalCoordinateSystem", "Sketcher::"})
    if (starts_with(type, name)) return true;
  return false;
}

/// How an object comes to be shown.
struct Context {
  glm::dmat4 to_world{1};
  bool own_placement = true;  ///< else a link's stands in its place
  bool visible = false;       ///< shown by a link or group of links, whatever the object's own visibility
  std::optional<std::string> label;
  std::optional<glm::dvec3> color;
  int depth = 0;
};

class Walker {
 public:
  Walker(const FreecadDocument& document, const std::string& file) : document_(document), file_(file) {
    for (const FreecadObject& object : document.objects) {
      if (object.link)
        for (const std::string& name : object.link->elements) shown_by_links_.insert(name);
      if (object.group && object.own_axes)
        for (const std::size_t member : members(object)) held_.insert(member);
      if (!object.shape_entry.empty() && !object.link)
        for (const std::string& name : object.made_from) used_.insert(name);
    }
  }

  FreecadScene walk() {
    by_use_ = !document_.has_gui;
    show_roots();
    if (scene_.shapes.empty() && !by_use_) {
      const std::vector<std::string> warnings = std::exchange(scene_.warnings, {});
      by_use_ = hidden_too_ = true;
      show_roots();
      if (!scene_.shapes.empty())
        scene_.warnings.emplace_back(
            "every shape is hidden in the document: those that no other is made from were taken");
      else
        scene_.warnings = warnings;
    }
    return std::move(scene_);
  }

 private:
  void show_roots() {
    for (std::size_t i = 0; i < document_.objects.size(); ++i)
      if (!held_.contains(i) && !shown_by_links_.contains(document_.objects[i].name)) show(i, {});
  }

  /// The members of a container; a plain group (a folder) in it stands for what is in the folder.
  std::vector<std::size_t> members(const FreecadObject& container) const {
    std::vector<std::size_t> found;
    std::unordered_set<std::size_t> seen;
    const auto add = [&](const FreecadObject& object) {
      for (const std::string& name : *object.group)
        if (const auto it = document_.index_of.find(name);
            it != document_.index_of.end() && seen.insert(it->second).second)
          found.push_back(it->second);
    };
    add(container);
    for (std::size_t i = 0; i < found.size(); ++i)  // grows on the way
      if (const FreecadObject& object = document_.objects[found[i]]; object.group && !object.own_axes)
        add(object);
    return found;
  }

  bool is_shown(const FreecadObject& object) const {
    if (hidden_too_ && !is_datum(object.type)) return !used_.contains(object.name);
    return object.visible.value_or(true) && (!by_use_ || !used_.contains(object.name));
  }

  void show(std::size_t index, const Context& context) {
    const FreecadObject& object = document_.objects[index];
    if (++visits_ > kMostVisits) too_many();
    if (!context.visible && !is_shown(object)) return;
    if (context.depth > kMostNested)
      throw ImportError(file_, "\"" + object.label_or_name() + "\"",
                        "is nested more than " + std::to_string(kMostNested) + " deep",
                        "flatten the document");
    if (is_datum(object.type)) return;
    if (object.link)
      show_link(object, context);
    else if (!object.tip.empty() && object.shape_entry.empty())
      show_tip(object, context);
    else if (object.group && object.own_axes && object.type != "PartDesign::Body")
      show_members(object, context);
    else if (object.group && !object.own_axes && context.visible)
      show_members(object,
                   context);  // a folder that a link shows; elsewhere its members speak for themselves
    else if (starts_with(object.type, "Mesh::"))
      scene_.warnings.push_back("\"" + object.label_or_name() +
                                "\" is a mesh and was left out: export it from FreeCAD as STL or OBJ");
    else if (!object.shape_entry.empty())
      add(index, context);
  }

  [[noreturn]] void too_many() const {
    throw ImportError(file_, "", "shows more than " + std::to_string(kMostShapes) + " shapes",
                      "hide what is not needed, or make arrays smaller");
  }

  static glm::dmat4 placed(const FreecadObject& object, const Context& context) {
    return context.own_placement ? context.to_world * object.placement.value_or(glm::dmat4(1))
                                 : context.to_world;
  }

  void add(std::size_t index, const Context& context) {
    if (scene_.shapes.size() >= kMostShapes) too_many();
    const FreecadObject& object = document_.objects[index];
    FreecadShown shown{index, context.label.value_or(object.label_or_name()), placed(object, context),
                       context.color};
    if (!object.placement && context.own_placement && context.to_world == glm::dmat4(1)) shown.place.reset();
    scene_.shapes.push_back(std::move(shown));
  }

  Context inside(const FreecadObject& object, const Context& context) const {
    Context inner;
    inner.to_world = placed(object, context);
    inner.color = context.color;
    inner.depth = context.depth + 1;
    return inner;
  }

  void show_members(const FreecadObject& container, const Context& context) {
    const Context inner = inside(container, context);
    for (const std::size_t member : members(container))
      if (!shown_by_links_.contains(document_.objects[member].name)) show(member, inner);
  }

  // A Body of FreeCAD 0.16 has no shape of its own.
  void show_tip(const FreecadObject& body, const Context& context) {
    const auto tip = document_.index_of.find(body.tip);
    if (tip == document_.index_of.end()) return;
    Context inner = inside(body, context);
    inner.visible = true;
    inner.label = context.label.value_or(body.label_or_name());
    show(tip->second, inner);
  }

  void show_link(const FreecadObject& object, const Context& context) {
    const FreecadLink& link = *object.link;
    Context inner = inside(object, context);
    inner.to_world = glm::scale(inner.to_world, link.scale);
    inner.visible = true;
    if (object.link_color) inner.color = object.link_color;
    if (!link.elements.empty()) {
      for (std::size_t i = 0; i < link.elements.size(); ++i)
        if (i >= link.elements_shown.size() || link.elements_shown[i])
          if (const auto element = document_.index_of.find(link.elements[i]);
              element != document_.index_of.end())
            show(element->second, inner);
      return;
    }
    if (link.group || (link.target.empty() && link.target_file.empty())) return;
    const std::string label = context.label.value_or(object.label_or_name());
    const auto target = find_target(object, label, inner);
    if (!target) return;
    inner.label = label;
    if (link.count == 0) return show(*target, inner);
    for (int i = 0; i < link.count; ++i) {
      const auto at = std::size_t(i);
      Context copy = inner;
      if (at < link.placements.size()) copy.to_world = copy.to_world * link.placements[at];
      if (at < link.scales.size()) copy.to_world = glm::scale(copy.to_world, link.scales[at]);
      copy.label = label + " " + std::to_string(i + 1);
      show(*target, copy);
    }
  }

  /// What a link shows; changes `inner` to its place. Nullopt, with a warning, where it cannot be shown.
  std::optional<std::size_t> find_target(const FreecadObject& object, const std::string& label,
                                         Context& inner) {
    const FreecadLink& link = *object.link;
    if (!link.target_file.empty()) {
      scene_.warnings.push_back("\"" + label + "\" is a link into another document, " + link.target_file +
                                ", and was left out: give that document beside this one");
      return std::nullopt;
    }
    if (link.face_only) {
      scene_.warnings.push_back("\"" + label + "\" is a link to a face or edge and was left out");
      return std::nullopt;
    }
    auto found = document_.index_of.find(link.target);
    if (found == document_.index_of.end())
      throw ImportError(file_, "\"" + label + "\"",
                        "is a link to \"" + link.target + "\", which is not in the document",
                        "mend the link in FreeCAD");
    std::size_t target = found->second;
    inner.own_placement = link.with_target_placement;
    for (const std::string& step : link.path) {  // from container to member
      inner.to_world = placed(document_.objects[target], inner);
      inner.own_placement = true;
      const auto next = std::ranges::find_if(document_.objects, [&](const FreecadObject& candidate) {
        return step.front() == '$' ? candidate.label == step.substr(1) : candidate.name == step;
      });
      if (next == document_.objects.end())
        throw ImportError(file_, "\"" + label + "\"",
                          "is a link to \"" + step + "\", which is not in the document",
                          "mend the link in FreeCAD");
      target = std::size_t(next - document_.objects.begin());
    }
    return target;
  }

  const FreecadDocument& document_;
  const std::string& file_;
  std::unordered_set<std::string> shown_by_links_;  // elements of links: shown there and nowhere else
  std::unordered_set<std::size_t> held_;            // members of containers: shown with these
  std::unordered_set<std::string> used_;            // made into another shape
  bool by_use_ = false, hidden_too_ = false;
  std::size_t visits_ = 0;
  FreecadScene scene_;
};

}  // namespace

FreecadScene freecad_scene(const FreecadDocument& document, const std::string& file) {
  check_freecad_cycles(document, file);
  return Walker(document, file).walk();
}

}  // namespace catoptra::cad_import

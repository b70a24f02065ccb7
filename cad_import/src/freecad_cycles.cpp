#include "cad_import/src/freecad_cycles.h"

#include <algorithm>

#include "cad_import/error.h"

namespace catoptra::cad_import {
namespace {

/// Depth-first without recursion: a chain may be as long as the document.
class RingSearch {
 public:
  explicit RingSearch(const FreecadDocument& document)
      : document_(document), state_(document.objects.size(), State::unseen) {}

  /// The ring that can be reached from `start`, its first object once more at its end; empty where there is
  /// none.
  std::vector<std::size_t> from(std::size_t start) {
    if (state_[start] != State::unseen) return {};
    enter(start);
    while (!stack_.empty()) {
      Step& step = stack_.back();
      if (step.next == step.shown.size()) {
        state_[step.object] = State::done;
        stack_.pop_back();
        continue;
      }
      const std::size_t shown = step.shown[step.next++];
      if (state_[shown] == State::open) return ring_at(shown);
      if (state_[shown] == State::unseen) enter(shown);
    }
    return {};
  }

 private:
  enum class State { unseen, open, done };
  struct Step {
    std::size_t object = 0;
    std::vector<std::size_t> shown;
    std::size_t next = 0;
  };

  void enter(std::size_t object) {
    state_[object] = State::open;
    stack_.push_back({object, shown_by(document_.objects[object]), 0});
  }

  std::vector<std::size_t> shown_by(const FreecadObject& object) const {
    std::vector<std::size_t> all;
    const auto add = [&](const std::string& name) {
      if (const auto it = document_.index_of.find(name); it != document_.index_of.end())
        all.push_back(it->second);
    };
    if (object.group) std::ranges::for_each(*object.group, add);
    add(object.tip);
    if (!object.link) return all;
    std::ranges::for_each(object.link->elements, add);
    if (object.link->target_file.empty()) add(object.link->target);
    for (const std::string& step : object.link->path) add(step);
    return all;
  }

  std::vector<std::size_t> ring_at(std::size_t object) const {
    std::vector<std::size_t> ring;
    const auto begin = std::ranges::find(stack_, object, &Step::object);
    for (auto step = begin; step != stack_.end(); ++step) ring.push_back(step->object);
    ring.push_back(object);
    return ring;
  }

  const FreecadDocument& document_;
  std::vector<State> state_;
  std::vector<Step> stack_;
};

}  // namespace

void check_freecad_cycles(const FreecadDocument& document, const std::string& file) {
  RingSearch search(document);
  for (std::size_t i = 0; i < document.objects.size(); ++i) {
    const std::vector<std::size_t> ring = search.from(i);
    if (ring.empty()) continue;
    constexpr std::size_t kNamed = 6;
    std::string names;
    for (std::size_t k = 0; k < std::min(kNamed, ring.size()); ++k)
      names += (k > 0 ? " > " : "") + document.objects[ring[k]].label_or_name();
    if (ring.size() > kNamed) names += " > ...";
    throw ImportError(file, "\"" + document.objects[ring.front()].label_or_name() + "\"",
                      "holds or shows itself (" + names + ")",
                      "break the ring of links and groups in FreeCAD");
  }
}

}  // namespace catoptra::cad_import

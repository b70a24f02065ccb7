// The table [evaluation]: the vehicle that a mirror is judged on.
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "app/src/scene_context.h"

namespace catoptra::app {
namespace {

std::vector<std::string> read_names(const TomlTable& table, std::string_view key) {
  const toml::node* node = table.node(key);
  if (!node) return {};
  const toml::array* array = node->as_array();
  if (!array || array->empty())
    table.fail(key, "expected an array of one or more names of surroundings; left out, all of them are in the way");
  std::vector<std::string> names;
  for (const toml::node& element : *array) {
    if (!element.is_string()) table.fail(key, "expected an array of names of surroundings");
    names.push_back(*element.value<std::string>());
  }
  return names;
}

/// Two points, or none.
std::vector<glm::dvec3> read_ocular_points(const TomlTable& table, double unit_mm) {
  const toml::node* node = table.node("ocular_points");
  if (!node) return {};
  const toml::array* array = node->as_array();
  if (!array || array->size() != 2) table.fail("ocular_points", "expected two points [x, y, z]");
  std::vector<glm::dvec3> points;
  for (const toml::node& element : *array) {
    const auto p = table.numbers_of(element, "ocular_points", 3, {});
    points.emplace_back(p[0] * unit_mm, p[1] * unit_mm, p[2] * unit_mm);
  }
  if (points[0] == points[1]) table.fail("ocular_points", "both are the same point");
  return points;
}

void refuse_two_of(const TomlTable& table, std::initializer_list<std::string_view> keys) {
  std::string_view first;
  for (const std::string_view key : keys) {
    if (!table.has(key)) continue;
    if (!first.empty())
      table.fail(key, std::string(first) + " and " + std::string(key) + " exclude each other");
    first = key;
  }
}

}  // namespace

EvaluationSettings read_evaluation(const TomlTable& root, const SceneContext& context) {
  EvaluationSettings settings;
  const toml::table* found = root.table("evaluation");
  if (!found) return settings;
  const TomlTable table(
      *found, context.name, "evaluation",
      {"forward", "ground", "eye", "r_point", "ocular_points", "ocular_spacing", "left_side", "right_side",
       "median", "driver_side", "vehicle", "far", "direct_view_deg"});
  const double unit_mm = context.unit_mm;
  const auto point = [&](std::string_view key) {
    auto value = table.vec3(key);
    if (value) *value *= unit_mm;
    return value;
  };
  refuse_two_of(table, {"ocular_points", "eye", "r_point"});
  refuse_two_of(table, {"ocular_points", "ocular_spacing"});
  settings.forward = table.vec3("forward");
  if (settings.forward && glm::length(*settings.forward) == 0)
    table.fail("forward", "must not be the zero vector");
  settings.ground_mm = point("ground").value_or(glm::dvec3(0));
  settings.eye_mm = point("eye");
  settings.r_point_mm = point("r_point");
  settings.ocular_points_mm = read_ocular_points(table, unit_mm);
  if (const auto spacing = table.number("ocular_spacing", Range::not_negative()))
    settings.ocular_spacing_mm = *spacing * unit_mm;
  settings.left_side_mm = point("left_side");
  settings.right_side_mm = point("right_side");
  settings.median_mm = point("median");
  if (const auto side = table.choice("driver_side", {"left", "right"}))
    settings.driver_left = *side == "left";
  settings.vehicle = read_names(table, "vehicle");
  if (const auto far = table.number("far", Range::positive())) settings.far_mm = *far * unit_mm;
  if (const auto limit = table.number("direct_view_deg", {0, 180}))
    settings.direct_view_rad = glm::radians(*limit);
  return settings;
}

}  // namespace catoptra::app

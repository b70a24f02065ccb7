// The tables [[lens]] and [[planar]]: read and checked in full, for the error that says they cannot be shown
// yet.
#include <glm/geometric.hpp>

#include "app/src/mirror_faces.h"
#include "app/src/scene_context.h"

namespace catoptra::app {
namespace {

/// `material`: a name, or one of { nd, vd }, { rgb }, { sellmeier }.
void check_material(const TomlTable& lens, const SceneContext& context) {
  const toml::node* node = lens.node("material");
  if (!node || node->is_string()) return;
  const toml::table* found = node->as_table();
  if (!found) lens.fail("material", "expected a catalogue name or a table", "{ nd = 1.498, vd = 58 }");
  const TomlTable material(*found, context.name, "lens.material", {"nd", "vd", "rgb", "sellmeier"});
  const Range index{1, 5};
  const int given = int(material.has("nd")) + int(material.has("rgb")) + int(material.has("sellmeier"));
  if (given != 1) lens.fail("material", "needs exactly one of nd, rgb and sellmeier");
  if (material.has("nd") != material.has("vd"))
    material.fail_missing(material.has("nd") ? "vd" : "nd", "nd and vd belong together");
  (void)material.number("nd", index);
  (void)material.number("vd", Range::positive());
  (void)material.vec3("rgb", index);
  const auto sellmeier = material.numbers("sellmeier", 0);
  if (sellmeier && (sellmeier->empty() || sellmeier->size() % 2))
    material.fail("sellmeier", "expected pairs of numbers: B1, C1, B2, C2, ...");
}

void check_lens(const TomlTable& lens, const SceneContext& context) {
  const bool one_file = lens.has("file"), two_files = lens.has("front") || lens.has("back");
  if (one_file && two_files) lens.fail("file", "file excludes front and back");
  if (!one_file && !two_files) lens.fail_missing("file", "or give front and back");
  (void)lens.text("name");
  if (one_file) (void)read_file_entry(lens, context);
  if (two_files) {
    (void)read_file_entry(lens, context, "front");
    (void)read_file_entry(lens, context, "back");
  }
  (void)read_face_selectors(lens, "front_faces");
  (void)read_face_selectors(lens, "back_faces");
  check_material(lens, context);
  (void)lens.integer("wavelengths", 1, 1000);
}

void check_corners(const TomlTable& planar) {
  const toml::array* corners = planar.node("corners")->as_array();
  if (!corners || corners->size() < 3)
    planar.fail("corners", "expected an array of at least three points [x, y, z]");
  for (const toml::node& corner : *corners) (void)planar.numbers_of(corner, "corners", 3, {});
}

void check_planar(const TomlTable& planar, const SceneContext& context) {
  if (!planar.choice("kind", {"mirror", "refractor", "pane"}))
    planar.fail_missing("kind", "mirror, refractor or pane");
  const bool corners = planar.has("corners"), file = planar.has("file");
  if (corners == file)
    planar.fail(corners ? "corners" : "", corners ? "corners excludes file" : "needs corners or file");
  if (corners) check_corners(planar);
  if (file) (void)read_file_entry(planar, context);
  (void)planar.text("name");
  (void)read_face_selectors(planar, "faces");
  (void)planar.boolean("one_sided");
  (void)read_reflectance(planar);
  (void)planar.number("ior", {1, 5});
  (void)planar.number("thickness", Range::not_negative());
  (void)planar.vec3("tint", {0, 1});
  (void)planar.number("translucency", {0, 1});
  (void)planar.number("material_alpha", {0, 1});
}

}  // namespace

std::string check_lenses(const TomlTable& root, const SceneContext& context) {
  std::string first;
  for (const toml::table* entry : root.tables("lens")) {
    const TomlTable lens(*entry, context.name, "lens",
                         {"name", "file", "front", "back", "front_faces", "back_faces", "material",
                          "wavelengths", "translate", "rotate_deg", "scale", "unit"});
    check_lens(lens, context);
    if (first.empty()) first = lens.entity("");
  }
  return first;
}

std::string check_planars(const TomlTable& root, const SceneContext& context) {
  std::string first;
  for (const toml::table* entry : root.tables("planar")) {
    const TomlTable planar(
        *entry, context.name, "planar",
        {"name", "kind", "corners", "file", "faces", "one_sided", "reflectance", "ior", "thickness", "tint",
         "translucency", "material_alpha", "translate", "rotate_deg", "scale", "unit"});
    check_planar(planar, context);
    if (first.empty()) first = planar.entity("");
  }
  return first;
}

}  // namespace catoptra::app

// The table [[planar]]: read and checked in full, for the error that says it cannot be shown yet.
#include <glm/geometric.hpp>

#include "app/src/mirror_faces.h"
#include "app/src/scene_context.h"

namespace catoptra::app {
namespace {

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

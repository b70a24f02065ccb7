// The table [[planar]]: flat mirrors, refractors and panes of the surroundings.
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "app/src/mirror_faces.h"
#include "app/src/scene_context.h"
#include "cad_import/error.h"
#include "cad_import/import.h"
#include "cad_import/polygon.h"
#include "tessellate/optic_mesh.h"

namespace catoptra::app {
namespace {

/// The corners in mm, of a table that has them.
std::vector<glm::dvec3> read_corners(const TomlTable& planar, const SceneContext& context) {
  const toml::array* corners = planar.node("corners")->as_array();
  if (!corners || corners->size() < 3)
    planar.fail("corners", "expected an array of at least three points [x, y, z]");
  std::vector<glm::dvec3> points;
  for (const toml::node& corner : *corners) {
    const auto numbers = planar.numbers_of(corner, "corners", 3, {});
    points.push_back(glm::dvec3(numbers[0], numbers[1], numbers[2]) * context.unit_mm);
  }
  return points;
}

cad_import::CadModel polygon_of(const TomlTable& planar, const SceneContext& context) {
  const std::vector<glm::dvec3> corners = read_corners(planar, context);
  try {
    return cad_import::polygon_model(corners);
  } catch (const Error& error) {
    planar.fail("corners", error.reason(), error.hint());
  }
}

/// The planar face of a file that is meant: the one selected, or the only planar one.
int planar_face(const TomlTable& planar, const cad_import::CadModel& model) {
  const auto selectors = read_face_selectors(planar, "faces");
  std::vector<int> faces;
  try {
    if (!selectors.empty()) faces = select_faces(model, selectors);
  } catch (const Error& error) {
    planar.fail("faces", error.entity() + " of " + error.file() + ": " + error.reason(), error.hint());
  }
  if (selectors.empty())
    for (const auto& face : model.faces)
      if (face.planar) faces.push_back(face.index);
  if (faces.size() != 1)
    planar.fail("faces",
                faces.empty() ? "the file has no planar face"
                              : std::to_string(faces.size()) + " faces are meant, and a planar optic is one",
                "name one planar face, as `catoptra info` prints them");
  if (!model.faces[std::size_t(faces[0])].planar)
    planar.fail("faces", "face " + std::to_string(faces[0]) + " is not planar", "use [[mirror]] for it");
  return faces[0];
}

void read_material(const TomlTable& planar, const SceneContext& context, optics::Optic& optic) {
  optics::PlanarMaterial& material = optic.material;
  if (const auto ior = planar.number("ior", {1, 5})) material.ior = *ior;
  if (const auto thickness = planar.number("thickness", Range::not_negative()))
    material.thickness_mm = *thickness * context.unit_mm;
  if (const auto tint = planar.vec3("tint", {0, 1})) material.tint = *tint;
  if (const auto fog = planar.number("translucency", {0, 1})) material.translucency = *fog;
  if (const auto alpha = planar.number("material_alpha", {0, 1})) material.material_alpha = *alpha;
  if (const auto color = planar.vec3("color", {0, 1})) material.color = *color;
  if (const auto rough = planar.numbers("roughness_deg", 2, {0, 45}))
    material.roughness_rad = glm::radians(glm::dvec2((*rough)[0], (*rough)[1]));
}

/// From the first corner to the second, or along the first edge of a file's face.
glm::dvec3 first_edge(const TomlTable& planar, const SceneContext& context, const cad_import::Face& face) {
  if (planar.has("corners")) {
    const auto corners = read_corners(planar, context);
    return glm::normalize(corners[1] - corners[0]);
  }
  for (const auto& loop : face.loops)
    for (const auto& edge : loop.edges) {
      if (!loop.outer || edge.degenerate) continue;
      const glm::dvec3 way = edge.curve->point(edge.t_end) - edge.curve->point(edge.t_begin);
      if (glm::length(way) > 0) return glm::normalize(edge.reversed ? -way : way);
    }
  return {1, 0, 0};
}

optics::Optic make_planar(const TomlTable& planar, const SceneContext& context, const cad_import::Face& face,
                          render::Scene& scene) {
  const auto kind = planar.choice("kind", {"mirror", "refractor", "pane"});
  if (!kind) planar.fail_missing("kind", "mirror, refractor or pane");
  optics::Optic optic;
  optic.planar = true;
  optic.kind = *kind == "mirror"      ? optics::OpticKind::mirror
               : *kind == "refractor" ? optics::OpticKind::refractor
                                      : optics::OpticKind::pane;
  optic.one_sided = planar.boolean("one_sided").value_or(false);
  optic.two_sided = optic.kind == optics::OpticKind::mirror && !optic.one_sided;
  if (const auto reflectance = read_reflectance(planar)) optic.reflectance = *reflectance;
  read_material(planar, context, optic);
  optic.material.first_edge = first_edge(planar, context, face);
  optic.faces.push_back(face);
  auto meshed = tessellate::tessellate_optic(optic.faces, {});
  for (const auto& unmeshed : meshed.unmeshed)
    planar.fail("", "could not be meshed: " + unmeshed.reason, "check the outline");
  scene.warnings.insert(scene.warnings.end(), meshed.warnings.begin(), meshed.warnings.end());
  optic.mesh = meshed.mesh.arrays();
  return optic;
}

void read_planar(const TomlTable& planar, const SceneContext& context, SceneFile& result) {
  const bool corners = planar.has("corners"), file = planar.has("file");
  if (corners == file)
    planar.fail(corners ? "corners" : "", corners ? "corners excludes file" : "needs corners or file",
                "give the corners, or a file with a planar face");
  for (const char* key : {"faces", "translate", "rotate_deg", "scale", "unit"})
    if (corners && planar.has(key))
      planar.fail(key, "belongs to a file, and this planar optic has corners",
                  "corners are points of the scene, in its unit: move them instead");
  std::optional<FileEntry> entry;
  if (file) entry = read_file_entry(planar, context);
  const cad_import::CadModel model =
      file ? cad_import::import_cad(entry->path, import_options(*entry, context))
           : polygon_of(planar, context);
  const int face = file ? planar_face(planar, model) : 0;
  optics::Optic optic = make_planar(planar, context, model.faces[std::size_t(face)], result.scene);
  const auto name = planar.text("name");
  for (const auto& other : result.scene.optics)
    if (name && other.name == *name) planar.fail("name", "two optics are called '" + *name + "'");
  optic.name = name.value_or(
      default_optic_name(result.scene.optics, file ? entry->path : std::filesystem::path("planar")));
  result.scene.optics.push_back(std::move(optic));
  OpticSource source{model, {face}, {}, glm::dmat4(1)};
  if (entry) source = {model, {face}, {entry->path}, entry->placement};
  result.optic_sources.push_back(std::move(source));
}

}  // namespace

void read_planars(const TomlTable& root, const SceneContext& context, SceneFile& result) {
  for (const toml::table* entry : root.tables("planar")) {
    const TomlTable planar(*entry, context.name, "planar",
                           {"name", "kind", "corners", "file", "faces", "one_sided", "reflectance", "ior",
                            "thickness", "tint", "translucency", "material_alpha", "color", "roughness_deg",
                            "translate", "rotate_deg", "scale", "unit"});
    read_planar(planar, context, result);
  }
}

}  // namespace catoptra::app

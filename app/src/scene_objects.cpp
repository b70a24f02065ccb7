// The tables [[surrounding]] and [[mirror]]: what is imported, meshed and placed.
#include <algorithm>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <set>

#include "app/src/mirror_faces.h"
#include "app/src/nearest_name.h"
#include "app/src/scene_context.h"
#include "cad_import/error.h"
#include "cad_import/import.h"
#include "optics/coating.h"
#include "tessellate/optic_mesh.h"

namespace catoptra::app {
namespace {

/// A file that mirrors of the scene come from: read once, however many of its faces reflect.
struct MirrorFile {
  FileEntry entry;
  cad_import::CadModel model;
  std::set<int> reflecting;              ///< face indices taken by some mirror; the rest becomes surroundings
  glm::vec3 color{0.8f};                 ///< of the rest, where the file has none
  std::vector<std::size_t> optics = {};  ///< the mirrors, as indices in the scene
};

MirrorFile& open_mirror_file(std::vector<MirrorFile>& files, const FileEntry& entry,
                             const SceneContext& context) {
  const auto known =
      std::find_if(files.begin(), files.end(), [&](const MirrorFile& f) { return f.entry == entry; });
  if (known != files.end()) return *known;
  files.push_back(
      {entry, cad_import::import_cad(entry.path, import_options(entry, context)), {}, glm::vec3(0.8f), {}});
  return files.back();
}

std::vector<int> faces_of_mirror(const TomlTable& table, const cad_import::CadModel& model,
                                 std::vector<std::string>& warnings) {
  const auto selectors = read_face_selectors(table, "faces");
  if (!selectors.empty()) {
    try {
      return select_faces(model, selectors);
    } catch (const Error& error) {
      table.fail("faces", error.entity() + " of " + error.file() + ": " + error.reason(), error.hint());
    }
  }
  DefaultFaces chosen = default_mirror_faces(model);
  if (!chosen.warning.empty()) warnings.push_back(chosen.warning);
  return chosen.faces;
}

optics::Optic make_mirror(const TomlTable& table, const cad_import::CadModel& model,
                          const std::vector<int>& faces, render::Scene& scene) {
  optics::Optic optic;
  optic.kind = optics::OpticKind::mirror;
  for (const int index : faces) optic.faces.push_back(model.faces[std::size_t(index)]);
  auto meshed = tessellate::tessellate_optic(optic.faces, tessellation_options(table, scene.settings));
  optic.mesh = meshed.mesh.arrays();
  for (const auto& face : meshed.unmeshed)
    scene.warnings.push_back(model.file + ": face " + face.id + " could not be meshed: " + face.reason);
  scene.warnings.insert(scene.warnings.end(), meshed.warnings.begin(), meshed.warnings.end());
  if (const auto reflectance = read_reflectance(table)) optic.reflectance = *reflectance;
  optic.flip = table.boolean("flip").value_or(false);
  return optic;
}

void read_mirror(const TomlTable& table, const SceneContext& context, std::vector<MirrorFile>& files,
                 SceneFile& result) {
  const FileEntry entry = read_file_entry(table, context);
  // Checked before the import, so that a slip in a key is told at once and not after minutes of reading.
  (void)read_face_selectors(table, "faces");
  (void)read_reflectance(table);
  const auto color = table.vec3("color", {0, 1});
  const auto name = table.text("name");
  for (const auto& other : result.scene.optics)
    if (name && other.name == *name) table.fail("name", "two optics are called '" + *name + "'");
  if (!cad_import::is_cad(cad_import::sniff_format(entry.path)))
    table.fail("file", "a mirror needs exact surfaces, and '" + entry.path.string() + "' has none",
               "give a STEP, IGES, BREP or FreeCAD file");

  MirrorFile& file = open_mirror_file(files, entry, context);
  if (color) file.color = *color;
  const auto faces = faces_of_mirror(table, file.model, result.scene.warnings);
  for (const int face : faces)
    if (!file.reflecting.insert(face).second)
      table.fail("faces",
                 "face " + std::to_string(face) + " already belongs to another mirror of this scene");
  optics::Optic optic = make_mirror(table, file.model, faces, result.scene);
  optic.name = name.value_or(default_optic_name(result.scene.optics, entry.path));
  result.scene.optics.push_back(std::move(optic));
  file.optics.push_back(result.scene.optics.size() - 1);
  result.optic_sources.push_back({file.model, faces, {entry.path}, entry.placement});
}

}  // namespace

std::filesystem::path read_path(const TomlTable& table, const SceneContext& context, std::string_view key) {
  const auto text = table.text(key);
  if (!text) table.fail_missing(key);
  if (text->empty()) table.fail(key, "must not be empty");
  const auto path = (context.folder / *text).lexically_normal();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    table.fail(key, "no file '" + path.string() + "'", "paths start at the scene file's folder");
  if (std::filesystem::is_directory(path, ignored)) table.fail(key, "'" + path.string() + "' is a folder");
  return path;
}

FileEntry read_file_entry(const TomlTable& table, const SceneContext& context, std::string_view key) {
  FileEntry entry;
  entry.path = read_path(table, context, key);
  entry.scale = table.number("scale", Range::positive()).value_or(1);
  entry.unit = table.text("unit");
  if (entry.unit && !cad_import::unit_in_mm(*entry.unit))
    table.fail("unit", "unknown unit '" + *entry.unit + "'", "known: mm, cm, m, in");
  const glm::dvec3 turn = table.vec3("rotate_deg").value_or(glm::dvec3(0));
  const glm::dvec3 move = table.vec3("translate").value_or(glm::dvec3(0)) * context.unit_mm;
  entry.placement = glm::translate(glm::dmat4(1), move);
  entry.placement = glm::rotate(entry.placement, glm::radians(turn.z), glm::dvec3(0, 0, 1));
  entry.placement = glm::rotate(entry.placement, glm::radians(turn.y), glm::dvec3(0, 1, 0));
  entry.placement = glm::rotate(entry.placement, glm::radians(turn.x), glm::dvec3(1, 0, 0));
  return entry;
}

cad_import::ImportOptions import_options(const FileEntry& entry, const SceneContext& context) {
  cad_import::ImportOptions options;
  options.unit = entry.unit;
  options.scale = entry.scale;
  options.placement = entry.placement;
  if (context.options.progress)
    options.progress = [&report = context.options.progress, name = entry.path.filename().string()](
                           double done, std::string_view stage) {
      report(done, name + ": " + std::string(stage));
    };
  return options;
}

std::optional<glm::vec3> read_reflectance(const TomlTable& table) {
  const toml::node* node = table.node("reflectance");
  if (!node) return std::nullopt;
  if (node->is_array()) return glm::vec3(*table.vec3("reflectance", {0, 1}));
  if (node->is_number()) return glm::vec3(static_cast<float>(*table.number("reflectance", {0, 1})));
  const auto name = table.text("reflectance");
  std::vector<std::string> known;
  for (const optics::Coating& coating : optics::built_in_coatings()) {
    if (coating.name == *name) return glm::vec3(coating.reflectance_rgb());
    known.emplace_back(coating.name);
  }
  table.fail("reflectance", "unknown coating '" + *name + "'", hint_for_unknown(*name, known));
}

tessellate::TessellationOptions tessellation_options(const TomlTable& table,
                                                     const render::RenderSettings& settings) {
  tessellate::TessellationOptions options;
  options.chord_mm = settings.chord_mm;
  options.angle_rad = settings.angle_rad;
  if (table.has("vertices") && table.has("grid")) table.fail("grid", "vertices and grid exclude each other");
  if (const auto vertices = table.integer("vertices", 4, 1'000'000))
    options.target_vertices = std::size_t(*vertices);
  if (const auto grid = table.numbers("grid", 2, {2, 4096})) {
    options.grid = {static_cast<int>((*grid)[0]), static_cast<int>((*grid)[1])};
    if (options.grid->columns != (*grid)[0] || options.grid->rows != (*grid)[1])
      table.fail("grid", "expected two integers");
  }
  return options;
}

std::string default_optic_name(const std::vector<optics::Optic>& optics, const std::filesystem::path& path) {
  const std::string stem = path.stem().string();
  std::string name = stem;
  const auto taken = [&] {
    return std::any_of(optics.begin(), optics.end(), [&](const auto& o) { return o.name == name; });
  };
  for (int number = 2; taken(); ++number) name = stem + " " + std::to_string(number);
  return name;
}

void add_remaining_faces(const cad_import::CadModel& model, std::span<const int> optical, glm::vec3 color,
                         render::Scene& scene) {
  std::vector<int> rest;
  for (const auto& face : model.faces)
    if (std::find(optical.begin(), optical.end(), face.index) == optical.end()) rest.push_back(face.index);
  if (rest.empty()) return;
  scene.surroundings.push_back(cad_import::triangulate(model, rest, {}, color));
  const auto& warnings = scene.surroundings.back().warnings;
  scene.warnings.insert(scene.warnings.end(), warnings.begin(), warnings.end());
}

void read_surroundings(const TomlTable& root, const SceneContext& context, SceneFile& result) {
  for (const toml::table* found : root.tables("surrounding")) {
    const TomlTable table(*found, context.name, "surrounding",
                          {"name", "file", "translate", "rotate_deg", "scale", "unit", "color"});
    const auto name = table.text("name");
    const FileEntry entry = read_file_entry(table, context);
    auto options = import_options(entry, context);
    if (const auto color = table.vec3("color", {0, 1})) options.color = *color;
    auto mesh = cad_import::import_mesh(entry.path, options);
    result.scene.warnings.insert(result.scene.warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
    result.scene.surroundings.push_back(std::move(mesh));
    result.surrounding_sources.push_back({name.value_or(entry.path.stem().string()), {}, entry.path});
  }
}

void read_mirrors(const TomlTable& root, const SceneContext& context, SceneFile& result) {
  std::vector<MirrorFile> files;
  for (const toml::table* found : root.tables("mirror")) {
    const TomlTable table(*found, context.name, "mirror",
                          {"name", "file", "faces", "reflectance", "flip", "vertices", "grid", "color",
                           "translate", "rotate_deg", "scale", "unit"});
    read_mirror(table, context, files, result);
  }
  for (const MirrorFile& file : files) {
    result.scene.warnings.insert(result.scene.warnings.end(), file.model.warnings.begin(),
                                 file.model.warnings.end());
    const std::vector<int> reflecting(file.reflecting.begin(), file.reflecting.end());
    const std::size_t before = result.scene.surroundings.size();
    add_remaining_faces(file.model, reflecting, file.color, result.scene);
    if (result.scene.surroundings.size() > before)
      result.surrounding_sources.push_back({file.entry.path.stem().string(), file.optics});
  }
}

}  // namespace catoptra::app

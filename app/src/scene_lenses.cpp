// The table [[lens]]: two refracting sides from CAD, what they are made of, and the rim around them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "app/src/lens_material.h"
#include "app/src/lens_sides.h"
#include "app/src/scene_context.h"
#include "cad_import/error.h"
#include "cad_import/import.h"
#include "tessellate/optic_mesh.h"

namespace catoptra::app {
namespace {

/// Vertices of each side where the scene does not say: the paper's lenses trace rays at 500 to 1,000.
constexpr std::size_t kDefaultVertices = 750;

/// Wavelengths of "spectral": below it the sum over the spectrum is off by more than 0.5 % in some channel.
constexpr int kSpectralWavelengths = 16;

/// Thinner than this is no lens but one surface given twice, mm.
constexpr double kThinnest_mm = 1e-3;

/// Everything of a [[lens]] that needs no CAD file, so that a slip is told before minutes of reading.
struct LensKeys {
  std::optional<std::string> name;
  std::vector<FaceSelector> front_faces, back_faces;
  optics::Medium medium, around = optics::air();
  int wavelengths = 3;
  std::optional<glm::dvec3> color;
  tessellate::TessellationOptions meshing;
};

/// A file of the lens and the faces of it that refract.
struct LensFile {
  cad_import::CadModel model;
  std::vector<int> optical;
  std::filesystem::path path;
  glm::dmat4 placement{1};
};

int read_wavelengths(const TomlTable& table) {
  const toml::node* node = table.node("wavelengths");
  if (!node) return 3;
  if (node->is_string()) {
    (void)table.choice("wavelengths", {"spectral"});
    return kSpectralWavelengths;
  }
  const int count = *table.integer("wavelengths", 1, 1000);
  if (count == 2) table.fail("wavelengths", "two wavelengths make no white", "1, 3 or more, or \"spectral\"");
  return count;
}

LensKeys read_keys(const TomlTable& table, const SceneContext& context, const SceneFile& result) {
  LensKeys keys;
  keys.name = table.text("name");
  for (const auto& other : result.scene.optics)
    if (keys.name && other.name == *keys.name)
      table.fail("name", "two optics are called '" + *keys.name + "'");
  keys.front_faces = read_face_selectors(table, "front_faces");
  keys.back_faces = read_face_selectors(table, "back_faces");
  keys.wavelengths = read_wavelengths(table);
  keys.color = table.vec3("color", {0, 1});
  keys.meshing = tessellation_options(table, result.scene.settings);
  if (!keys.meshing.target_vertices && !keys.meshing.grid) keys.meshing.target_vertices = kDefaultVertices;

  optics::MediumCatalogue media;
  try {
    media =
        lens_media(table.has("catalogue") ? read_path(table, context, "catalogue") : std::filesystem::path());
  } catch (const cad_import::ImportError& error) {
    table.fail("catalogue", error.what());
  } catch (const Error& error) {
    if (error.file() == context.name) throw;
    table.fail("catalogue", error.what());
  }
  const auto medium = read_medium(table, "material", media);
  if (!medium) table.fail_missing("material", "a name such as \"CR-39\", or { nd = 1.498, vd = 58 }");
  keys.medium = *medium;
  if (const auto around = read_medium(table, "around", media)) keys.around = *around;
  return keys;
}

FileEntry read_cad_entry(const TomlTable& table, const SceneContext& context, std::string_view key) {
  FileEntry entry = read_file_entry(table, context, key);
  if (!cad_import::is_cad(cad_import::sniff_format(entry.path)))
    table.fail(key, "a lens needs exact surfaces, and '" + entry.path.string() + "' has none",
               "give a STEP, IGES, BREP or FreeCAD file");
  return entry;
}

/// Runs a step whose errors name the CAD file, and words them as errors of `key`.
template <typename Step>
auto told_at(const TomlTable& table, std::string_view key, Step step) {
  try {
    return step();
  } catch (const Error& error) {
    table.fail(key,
               error.file() + ": " + (error.entity().empty() ? "" : error.entity() + ": ") + error.reason(),
               error.hint());
  }
}

std::vector<LensFile> read_one_file(const TomlTable& table, const SceneContext& context, const LensKeys& keys,
                                    optics::Optic& lens) {
  const FileEntry entry = read_cad_entry(table, context, "file");
  auto model = cad_import::import_cad(entry.path, import_options(entry, context));
  const char* at = !keys.front_faces.empty()  ? "front_faces"
                   : !keys.back_faces.empty() ? "back_faces"
                                              : "file";
  if (keys.front_faces.empty() && keys.back_faces.empty() && is_mirror_glass(model))
    table.fail("file", "'" + model.file + "' is a mirror glass: its faces are called Glass, Back and Edge",
               "give it as [[mirror]], or name both sides with front_faces and back_faces");
  LensFaceIndices sides =
      told_at(table, at, [&] { return lens_faces_of(model, keys.front_faces, keys.back_faces); });
  lens.faces = faces_at(model, sides.front);
  lens.back.faces = faces_at(model, sides.back);
  // The source's faces are the front's: what benchmarks mesh again.
  std::vector<LensFile> files{{std::move(model), sides.front, entry.path, entry.placement}};
  files[0].optical.insert(files[0].optical.end(), sides.back.begin(), sides.back.end());
  return files;
}

std::vector<LensFile> read_two_files(const TomlTable& table, const SceneContext& context,
                                     const LensKeys& keys, optics::Optic& lens) {
  const FileEntry front = read_cad_entry(table, context, "front");
  const FileEntry back = read_cad_entry(table, context, "back");
  std::vector<LensFile> files;
  for (const FileEntry* entry : {&front, &back}) {
    const bool is_front = entry == &front;
    LensFile file{cad_import::import_cad(entry->path, import_options(*entry, context)),
                  {},
                  entry->path,
                  entry->placement};
    file.optical = told_at(table, is_front ? "front" : "back", [&] {
      return lens_side_of(file.model, is_front ? keys.front_faces : keys.back_faces);
    });
    (is_front ? lens.faces : lens.back.faces) = faces_at(file.model, file.optical);
    files.push_back(std::move(file));
  }
  return files;
}

void mesh_side(const TomlTable& table, std::string_view key, const std::vector<cad_import::Face>& faces,
               const LensKeys& keys, tessellate::OpticArrays& mesh, std::vector<std::string>& warnings) {
  auto meshed = told_at(table, key, [&] { return tessellate::tessellate_optic(faces, keys.meshing); });
  mesh = meshed.mesh.arrays();
  for (const auto& face : meshed.unmeshed)
    warnings.push_back("lens: face " + face.id + " could not be meshed: " + face.reason);
  warnings.insert(warnings.end(), meshed.warnings.begin(), meshed.warnings.end());
}

std::string in_mm(double length) {
  char text[48];
  std::snprintf(text, sizeof text, "%.3g mm", length);
  return text;
}

void check_thickness(const TomlTable& table, std::string_view key, const optics::Optic& lens) {
  const auto thickness = lens_thickness(lens);
  if (!thickness)
    table.fail(key, "front and back do not lie behind one another", "see front_faces and back_faces");
  if (thickness->max_mm < -kThinnest_mm)
    table.fail(
        key,
        "the thickness is negative: the front lies " + in_mm(-thickness->max_mm) + " or more behind the back",
        "exchange front and back");
  if (thickness->max_mm < kThinnest_mm) table.fail(key, "the lens has no thickness: front and back coincide");
  if (thickness->min_mm < -kThinnest_mm)
    table.fail(key,
               "front and back cross: the back lies up to " + in_mm(-thickness->min_mm) + " before the front",
               "make the lens thicker, or its outline smaller");
}

void read_lens(const TomlTable& table, const SceneContext& context, SceneFile& result) {
  const bool one_file = table.has("file"), two_files = table.has("front") || table.has("back");
  if (one_file && two_files) table.fail("file", "file excludes front and back");
  if (!one_file && !two_files) table.fail_missing("file", "or give front and back");
  if (two_files && !table.has("front")) table.fail_missing("front", "a lens has two surfaces");
  if (two_files && !table.has("back")) table.fail_missing("back", "a lens has two surfaces");
  const LensKeys keys = read_keys(table, context, result);

  optics::Optic lens;
  lens.kind = optics::OpticKind::lens;
  lens.medium = keys.medium;
  lens.around = keys.around;
  lens.wavelengths = keys.wavelengths;
  if (keys.color) lens.rim_color = *keys.color;
  const auto files =
      one_file ? read_one_file(table, context, keys, lens) : read_two_files(table, context, keys, lens);
  const std::string_view front = one_file ? "file" : "front", back = one_file ? "file" : "back";
  const auto geometry = told_at(table, back, [&] {
    return turn_normals_outwards(lens.faces, lens.back.faces, files.back().model.file);
  });
  mesh_side(table, front, lens.faces, keys, lens.mesh, result.scene.warnings);
  mesh_side(table, back, lens.back.faces, keys, lens.back.mesh, result.scene.warnings);
  check_thickness(table, back, lens);

  const auto path = read_path(table, context, front);
  lens.name = keys.name.value_or(default_optic_name(result.scene.optics, path));
  if (const auto reason = exchanged_sides(lens.faces, lens.back.faces, geometry))
    result.scene.warnings.push_back("lens '" + lens.name + "': front and back look exchanged: " + *reason +
                                    " (no picture depends on it, measurements do)");
  for (const LensFile& file : files) {
    add_remaining_faces(file.model, file.optical, lens.rim_color, result.scene);
    result.scene.warnings.insert(result.scene.warnings.end(), file.model.warnings.begin(),
                                 file.model.warnings.end());
  }
  std::vector<int> front_indices = files[0].optical;
  front_indices.resize(lens.faces.size());
  std::vector<std::filesystem::path> paths;
  for (const LensFile& file : files) paths.push_back(file.path);
  result.optic_sources.push_back({files[0].model, front_indices, paths, files[0].placement});
  result.scene.optics.push_back(std::move(lens));
}

}  // namespace

void read_lenses(const TomlTable& root, const SceneContext& context, SceneFile& result) {
  for (const toml::table* found : root.tables("lens")) {
    const TomlTable table(
        *found, context.name, "lens",
        {"name", "file", "front", "back", "front_faces", "back_faces", "material", "catalogue", "around",
         "wavelengths", "vertices", "grid", "color", "translate", "rotate_deg", "scale", "unit"});
    read_lens(table, context, result);
  }
}

}  // namespace catoptra::app

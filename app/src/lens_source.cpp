#include "app/src/lens_source.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "app/src/file_hash.h"
#include "app/src/lens_sides.h"
#include "app/src/nearest_name.h"
#include "cad_import/import.h"
#include "cad_import/lens_faces.h"
#include "tessellate/optic_mesh.h"

namespace catoptra::app {
namespace {

/// Starting points for the exact rays, as many as scenes take; results do not depend on it.
constexpr std::size_t kVertices = 750;

/// An `up` nearer than this to the lens's axis tells nothing about the lens's own up.
constexpr double kAlongAxis = 0.999;

tessellate::OpticArrays mesh_of(const std::vector<cad_import::Face>& faces,
                                std::vector<std::string>& warnings) {
  tessellate::TessellationOptions options;
  options.target_vertices = kVertices;
  auto meshed = tessellate::tessellate_optic(faces, options);
  for (const auto& face : meshed.unmeshed)
    warnings.push_back("lens: face " + face.id + " could not be meshed: " + face.reason);
  warnings.insert(warnings.end(), meshed.warnings.begin(), meshed.warnings.end());
  return meshed.mesh.arrays();
}

/// Faces of the body called `name`, front and back.
LensFaceIndices faces_of_body(const cad_import::CadModel& model, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t body = 0; body < model.bodies.size(); ++body) {
    names.push_back(model.bodies[body].name);
    if (names.back() != name) continue;
    if (const auto lens = cad_import::lens_in_body(model, static_cast<int>(body)))
      return {lens->front, lens->back};
    throw Error(model.file, "body '" + name + "'", "does not look like a lens",
                "name its sides with --front-faces and --back-faces");
  }
  throw Error(model.file, "body '" + name + "'", "is not in this file", hint_for_unknown(name, names));
}

LensFaceIndices chosen_faces(const cad_import::CadModel& model, const LensSourceOptions& options,
                             std::vector<std::string>& warnings) {
  if (!options.name.empty()) return faces_of_body(model, options.name);
  LensFaceIndices faces;
  try {
    faces = lens_faces_of(model, options.front_faces, options.back_faces);
  } catch (const Error& error) {
    if (!error.hint().empty()) throw;
    throw Error(error.file(), error.entity(), error.reason(),
                "is it a lens? name its sides with --front-faces and --back-faces, or its body with --lens");
  }
  if (!options.front_faces.empty() || !options.back_faces.empty()) return faces;
  std::vector<std::string> lenses;
  for (std::size_t body = 0; body < model.bodies.size(); ++body)
    if (model.bodies.size() > 1 && cad_import::lens_in_body(model, static_cast<int>(body)))
      lenses.push_back(model.bodies[body].name);
  if (lenses.size() > 1)
    warnings.push_back(model.file + ": " + std::to_string(lenses.size()) + " bodies look like lenses (" +
                       list_of_names(lenses) + "); the largest is taken, --lens chooses another");
  return faces;
}

/// The lens's own up as placed in the model: +y of its file, or +z for one whose axis that is.
glm::dvec3 up_in_model(const glm::dmat4& placement, const glm::dvec3& axis) {
  const glm::dvec3 y = glm::normalize(glm::dvec3(placement * glm::dvec4(0, 1, 0, 0)));
  if (std::abs(glm::dot(y, axis)) < kAlongAxis) return y;
  return glm::normalize(glm::dvec3(placement * glm::dvec4(0, 0, 1, 0)));
}

void set_frame(LensSource& source, const LensSourceOptions& options, const glm::dmat4& placement,
               const std::string& file) {
  const auto geometry = cad_import::measure_lens(source.lens.faces, source.lens.back.faces, file);
  const glm::dvec3 up = options.up.value_or(up_in_model(placement, geometry.axis));
  if (glm::length(glm::cross(up, geometry.axis)) < 1e-6 * glm::length(up))
    throw Error(file, "--up", "runs along the axis of the lens", "give a direction across it");
  source.frame = optics::lens_frame(geometry, up);
}

const optics::Optic& lens_called(const render::Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const optics::Optic& optic : scene.optics)
    if (optic.kind == optics::OpticKind::lens) names.push_back(optic.name);
  if (names.empty()) throw Error(scene.file, "lens", "the scene has no [[lens]]");
  if (name.empty() && names.size() > 1)
    throw Error(scene.file, "lens", "the scene has " + std::to_string(names.size()) + " lenses",
                "choose one with --lens: " + list_of_names(names));
  const std::string& wanted = name.empty() ? names.front() : name;
  for (const optics::Optic& optic : scene.optics)
    if (optic.kind == optics::OpticKind::lens && optic.name == wanted) return optic;
  throw Error(scene.file, "lens '" + wanted + "'", "is not in the scene", hint_for_unknown(wanted, names));
}

LensSource lens_of_scene(const std::filesystem::path& file, const LensSourceOptions& options) {
  SceneReadOptions reading;
  reading.progress = options.progress;
  SceneFile scene = read_scene(file, reading);
  LensSource source;
  source.lens = lens_called(scene.scene, options.name);
  source.warnings = scene.scene.warnings;
  if (options.medium) source.lens.medium = *options.medium;
  const auto index = std::find_if(scene.scene.optics.begin(), scene.scene.optics.end(),
                                  [&](const optics::Optic& o) { return o.name == source.lens.name; }) -
                     scene.scene.optics.begin();
  const OpticSource& origin = scene.optic_sources.at(std::size_t(index));
  set_frame(source, options, origin.placement, scene.scene.file);
  std::vector<std::filesystem::path> files{scene.path};
  files.insert(files.end(), origin.files.begin(), origin.files.end());
  source.inputs = input_files(files);
  return source;
}

}  // namespace

bool is_scene_file(const std::filesystem::path& file) {
  return file == "-" || file.extension() == ".toml";
}

LensSource lens_of_model(const cad_import::CadModel& model, const LensSourceOptions& options) {
  LensSource source;
  const LensFaceIndices faces = chosen_faces(model, options, source.warnings);
  optics::Optic& lens = source.lens;
  lens.kind = optics::OpticKind::lens;
  lens.name = options.name.empty() ? std::filesystem::path(model.file).stem().string() : options.name;
  lens.medium = options.medium.value();
  lens.faces = faces_at(model, faces.front);
  lens.back.faces = faces_at(model, faces.back);
  turn_normals_outwards(lens.faces, lens.back.faces, model.file);
  lens.mesh = mesh_of(lens.faces, source.warnings);
  lens.back.mesh = mesh_of(lens.back.faces, source.warnings);
  source.warnings.insert(source.warnings.end(), model.warnings.begin(), model.warnings.end());
  set_frame(source, options, glm::dmat4(1), model.file);
  return source;
}

LensSource load_lens(const std::filesystem::path& file, const LensSourceOptions& options) {
  if (is_scene_file(file)) return lens_of_scene(file, options);
  if (!cad_import::is_cad(cad_import::sniff_format(file)))
    throw Error(file.string(), "", "a lens needs exact surfaces, and this file has none",
                "give a STEP, IGES, BREP or FreeCAD file, or a scene (.toml)");
  cad_import::ImportOptions importing;
  importing.unit = options.unit;
  importing.progress = options.progress;
  LensSource source = lens_of_model(cad_import::import_cad(file, importing), options);
  source.inputs.push_back({file.string(), sha256_of_file(file)});
  return source;
}

}  // namespace catoptra::app

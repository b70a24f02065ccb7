// Reads triangle meshes: glTF, OBJ, STL and PLY through assimp, CAD files through the CAD import.
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <cmath>
#include <exception>
#include <fstream>
#include <glm/ext/matrix_transform.hpp>
#include <memory>
#include <sstream>
#include <utility>

#include "cad_import/src/import_progress.h"
#include "cad_import/src/mesh_parts.h"

namespace catoptra::cad_import {
namespace {

constexpr double kReadShare =
    0.7;  // of the time goes into assimp's own reading, measured on the street circuit

/// Hands assimp's progress on and tells it to stop; assimp forbids exceptions here, so they wait for
/// rethrow().
class AssimpProgress : public Assimp::ProgressHandler {
 public:
  explicit AssimpProgress(ImportProgress& progress) : progress_(progress) {}
  bool Update(float share) override {
    if (thrown_) return false;
    try {
      progress_.step(share < 0 ? 0 : share);
    } catch (...) {
      thrown_ = std::current_exception();
    }
    return !thrown_;
  }
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  ImportProgress& progress_;
  std::exception_ptr thrown_;
};

std::string name_of(FileFormat format) {
  switch (format) {
    case FileFormat::gltf:
      return "glTF";
    case FileFormat::obj:
      return "OBJ";
    case FileFormat::stl:
      return "STL";
    case FileFormat::ply:
      return "PLY";
    default:
      return "";
  }
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

double unit_of(const std::filesystem::path& file, FileFormat format, const ImportOptions& options) {
  if (!(options.scale > 0 && std::isfinite(options.scale)))
    throw ImportError(file.string(), "scale", "must be a number above 0");
  if (!options.unit)
    return format == FileFormat::gltf ? 1000 : 1;  // glTF 2.0, 3.4: metres; the others say nothing
  const std::optional<double> unit = unit_in_mm(*options.unit);
  if (!unit)
    throw ImportError(file.string(), "unit", "\"" + *options.unit + "\" is not a length unit",
                      "use mm, cm, m, in or ft");
  return *unit;
}

const aiScene& read_scene(Assimp::Importer& importer, const std::filesystem::path& file,
                          ImportProgress& progress) {
  auto handler = std::make_unique<AssimpProgress>(progress);
  const AssimpProgress& watch = *handler;
  importer.SetProgressHandler(handler.release());  // the importer owns it from here
  const aiScene* scene = nullptr;
  std::string reason;
  try {
    scene = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure);
    reason = importer.GetErrorString();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  watch.rethrow();
  if (!scene) throw ImportError(file.string(), "", "cannot be read: " + one_line(reason));
  return *scene;
}

/// assimp reads on without a word where an OBJ file's material library is missing.
std::vector<std::string> missing_libraries(const std::filesystem::path& file) {
  constexpr std::string_view kKeyword = "mtllib ";
  std::vector<std::string> warnings;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line) && line.rfind("f ", 0) != 0;) {
    if (line.rfind(kKeyword, 0) != 0) continue;
    const std::size_t end = line.find_last_not_of(" \t\r") + 1;
    const std::string name = line.substr(kKeyword.size(), std::max(end, kKeyword.size()) - kKeyword.size());
    if (!find_beside(file, name)) warnings.push_back("material library \"" + name + "\" was not found");
  }
  return warnings;
}

/// Surroundings reach from a thing in the hand to a landscape: wider limits than those of an optic.
std::string surroundings_warning(const BoundingBox& bounds) {
  constexpr double kLargest_mm = 1e7, kSmallest_mm = 10;
  const glm::dvec3 size = bounds.max - bounds.min;
  const double longest = std::max({size.x, size.y, size.z});
  if (longest >= kSmallest_mm && longest <= kLargest_mm) return {};
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << longest << " mm long: is the unit right?";
  return text.str();
}

TriangleMesh import_cad_as_mesh(const std::filesystem::path& file, const ImportOptions& options) {
  const CadModel model = import_cad(file, options);
  TriangleMesh mesh = triangulate(model, {}, {}, options.color);
  mesh.file = model.file;
  mesh.format = model.format;
  mesh.warnings.insert(mesh.warnings.begin(), model.warnings.begin(), model.warnings.end());
  if (mesh.triangles.empty()) throw ImportError(file.string(), "", "no face could be triangulated");
  return mesh;
}

}  // namespace

TriangleMesh import_mesh(const std::filesystem::path& file, const ImportOptions& options) {
  const FileFormat format = sniff_format(file);
  if (is_cad(format)) return import_cad_as_mesh(file, options);
  if (format == FileFormat::unknown)
    throw ImportError(file.string(), "", "is no mesh or CAD file that can be read",
                      "glTF, OBJ, STL, PLY, STEP, IGES or BREP");
  const double scale = unit_of(file, format, options) * options.scale;
  if (format == FileFormat::ply) check_ply_header(file);
  ImportProgress progress(options, file.string());
  Assimp::Importer importer;
  progress.stage("reading", 0, kReadShare);
  const aiScene& scene = read_scene(importer, file, progress);

  progress.stage("collecting triangles", kReadShare, 1);
  MaterialSet materials = read_materials(scene, file, format, options.color);
  const glm::dmat4 to_mm = options.placement * glm::scale(glm::dmat4(1), glm::dvec3(scale));
  SceneTriangles collected = flatten_scene(scene, materials.uses, to_mm, file.string());
  importer.FreeScene();

  TriangleMesh mesh;
  mesh.file = file.string();
  mesh.format = name_of(format);
  mesh.materials = std::move(materials.materials);
  mesh.textures = std::move(materials.textures);
  mesh.warnings = format == FileFormat::obj ? missing_libraries(file) : std::vector<std::string>{};
  mesh.warnings.insert(mesh.warnings.end(), materials.warnings.begin(), materials.warnings.end());
  mesh.warnings.insert(mesh.warnings.end(), collected.warnings.begin(), collected.warnings.end());
  progress.step(0.5);
  weld(std::move(collected.soup), mesh);
  if (mesh.triangles.empty()) {
    const std::string why = mesh.warnings.empty() ? "" : mesh.warnings.back();
    throw ImportError(file.string(), "", "holds no triangle", why);
  }
  if (std::string warning = surroundings_warning(mesh.bounds); !warning.empty())
    mesh.warnings.push_back(std::move(warning));
  progress.step(1);
  return mesh;
}

}  // namespace catoptra::cad_import

#include "app/scene_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>

#include "app/src/scene_context.h"
#include "cad_import/error.h"
#include "cad_import/import.h"

namespace catoptra::app {
namespace {

double read_unit_mm(const TomlTable& root) {
  const auto unit = root.text("units");
  if (!unit) return 1;
  const auto mm = cad_import::unit_in_mm(*unit);
  if (!mm) root.fail("units", "unknown unit '" + *unit + "'", "known: mm, cm, m, in");
  return *mm;
}

std::string read_all(std::istream& stream) {
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Says once what of the light the model leaves out (docs/decisions/0015).
void warn_of_light(render::Scene& scene) {
  if (std::ranges::none_of(scene.lights, &render::Light::shadows)) return;
  std::string without;
  for (const optics::Optic& optic : scene.optics) {
    if (optic.planar) continue;
    scene.warnings.push_back("light reflected or refracted by " + optic.name + " is not simulated");
    if (optic.kind == optics::OpticKind::lens && without.empty()) without = "lenses";
  }
  for (const cad_import::TriangleMesh& mesh : scene.surroundings) {
    if (std::ranges::none_of(mesh.materials, [](const auto& m) { return m.alpha_cutoff > 0; })) continue;
    without += without.empty() ? "alpha-tested triangles" : " and alpha-tested triangles";
    break;
  }
  if (!without.empty()) scene.warnings.push_back(without + " cast no shadow");
}

}  // namespace

SceneFile read_scene_text(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                          const SceneReadOptions& options) {
  const toml::table parsed = parse_toml(text, name);
  const TomlTable root(parsed, name, "",
                       {"units", "camera", "environment", "light", "surrounding", "mirror", "lens", "planar",
                        "render", "evaluation"});
  const SceneContext context{name, folder, read_unit_mm(root), options};

  SceneFile result;
  render::Scene& scene = result.scene;
  scene.file = name;
  result.unit_mm = context.unit_mm;
  scene.camera = read_camera(root, context);
  scene.environment = read_environment(root, context);
  scene.lights = read_lights(root, context);
  scene.settings = read_render_settings(root);
  result.evaluation = read_evaluation(root, context);
  read_surroundings(root, context, result);
  read_mirrors(root, context, result);
  read_lenses(root, context, result);
  read_planars(root, context, result);
  result.surrounding_sources.resize(scene.surroundings.size());  // rims of lenses
  warn_of_light(scene);
  return result;
}

SceneFile read_scene(const std::filesystem::path& file, const SceneReadOptions& options) {
  if (file == "-")
    return read_scene_text(read_all(std::cin), "standard input", std::filesystem::current_path(), options);
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw Error(file.string(), "", "is a folder, not a scene file", "name the .toml file in it");
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw Error(file.string(), "", "cannot open the scene file", "does it exist and may you read it?");
  SceneFile scene = read_scene_text(read_all(stream), file.string(),
                                    std::filesystem::absolute(file).parent_path(), options);
  scene.path = file;
  return scene;
}

}  // namespace catoptra::app

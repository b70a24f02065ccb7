#include "app/src/mirror_page.h"

#include <algorithm>

#include "app/src/html_report.h"
#include "app/src/json_values.h"
#include "app/src/mirror_evaluation_writers.h"
#include "app/src/output_file.h"
#include "render/renderer.h"

namespace catoptra::app {
namespace {

/// The scene from its eye, as exact rays see it; wide enough to read signs by.
std::string scene_picture(const render::Scene& scene) {
  constexpr int kWidth = 960, kSamples = 4;
  render::FrameOptions options;
  options.width = kWidth;
  options.height = std::max(1, kWidth * scene.camera.resolution.y / scene.camera.resolution.x);
  options.samples = kSamples;
  render::Renderer renderer(scene);
  const auto picture = renderer.render(render::Mode::raytrace, scene.camera, options);
  return data_address(png_bytes(picture.frame), "image/png");
}

}  // namespace

std::string mirror_page(const MirrorEvaluation& evaluation, const SceneFile& scene) {
  HtmlPage page;
  page.title = "Mirror " + evaluation.mirror;
  page.summary = "What the mirror shows, measured by exact rays in " + evaluation.scene;
  page.mirrors.push_back(mirror_json(evaluation));
  page.mirrors.back()["picture"] = scene_picture(scene.scene);
  // The picture shows the whole scene.
  std::vector<std::filesystem::path> files;
  for (const InputFile& input : evaluation.inputs) files.emplace_back(input.file);
  for (const OpticSource& source : scene.optic_sources)
    files.insert(files.end(), source.files.begin(), source.files.end());
  for (const SurroundingSource& source : scene.surrounding_sources) files.push_back(source.file);
  page.inputs = inputs_json(input_files(files));
  return html_report(page);
}

}  // namespace catoptra::app

#include "app/src/report.h"

#include <spdlog/version.h>
#include <toml++/toml.h>

#include <CLI/Version.hpp>
#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "app/version.h"

namespace catoptra::app {
namespace {

using nlohmann::ordered_json;

ordered_json patches_json(const std::vector<render::PatchStats>& patches) {
  ordered_json result = ordered_json::array();
  for (const render::PatchStats& patch : patches)
    result.push_back({{"viewpoint_mm", {patch.viewpoint_mm.x, patch.viewpoint_mm.y, patch.viewpoint_mm.z}},
                      {"residual_mm", patch.residual_mm},
                      {"fov_deg", {glm::degrees(patch.fov_rad[0]), glm::degrees(patch.fov_rad[1])}},
                      {"texels", {patch.texels[0], patch.texels[1]}}});
  return result;
}

template <typename Part>
std::string dotted(Part major, Part minor, Part patch) {
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

}  // namespace

ordered_json quantiles_json(const render::ErrorQuantiles& q) {
  return {{"median", q.median}, {"p99", q.p99}, {"p999", q.p999}, {"max", q.max}};
}

double retraced_fraction(render::Mode mode, const render::OpticStats& optic) {
  if (mode == render::Mode::hybrid || mode == render::Mode::raytrace) return 1;
  return optic.shown_pixels ? double(optic.retraced_pixels) / double(optic.shown_pixels) : 0;
}

ordered_json optics_json(const render::Scene& scene, render::Mode mode, const render::FrameStats& stats,
                         const std::vector<render::OpticError>* errors) {
  ordered_json entries = ordered_json::array();
  for (std::size_t i = 0; i < scene.optics.size(); ++i) {
    const optics::Optic& optic = scene.optics[i];
    const render::OpticStats told = i < stats.optics.size() ? stats.optics[i] : render::OpticStats{};
    ordered_json entry{{"name", optic.name},
                       {"kind", optics::kind_name(optic.kind)}};
    if (errors) entry["pixels"] = errors->at(i).pixels;
    entry["vertices"] = told.vertices > 0 ? told.vertices : optic.mesh.vertices.size();
    entry["tessellated_vertices"] = optic.mesh.vertices.size();
    entry["rays"] = told.rays;
    entry["refinement_rays"] = told.refinement_rays;
    entry["patches"] = patches_json(told.patches);
    if (errors) {
      entry["outline_pixels"] = errors->at(i).outline_pixels;
      entry["touching_pixels"] = errors->at(i).touching_pixels;
      entry["other_path_pixels"] = errors->at(i).other_path_pixels;
      entry["error_arcmin"] = quantiles_json(errors->at(i).arcmin);
      entry["error_px"] = quantiles_json(errors->at(i).screen_px);
      entry["visible_error_px"] = quantiles_json(errors->at(i).visible_px);
      const double pixels = double(std::max<std::size_t>(errors->at(i).pixels, 1));
      entry["occlusion_fraction"] = double(errors->at(i).occlusion_pixels) / pixels;
    }
    entry["retraced_fraction"] = retraced_fraction(mode, told);
    entries.push_back(std::move(entry));
  }
  return entries;
}

ordered_json maps_json(const render::FrameStats& stats) {
  ordered_json maps = ordered_json::array();
  for (const render::MapStats& map : stats.maps)
    maps.push_back({{"way", map.way},
                    {"level", map.level},
                    {"drawn", map.drawn},
                    {"texels", map.texels},
                    {"rays", map.rays},
                    {"scene_rays", map.scene_rays},
                    {"draws", map.draws}});
  return maps;
}

ordered_json shadows_json(const render::FrameStats& stats) {
  const render::ShadowStats& shadows = stats.shadows;
  return {{"views", shadows.views},
          {"volumes", shadows.volumes},
          {"silhouette_edges", shadows.silhouette_edges},
          {"stencil_draws", shadows.stencil_draws},
          {"folds", shadows.folds}};
}

ordered_json choice_json(const render::ModeChoice& choice) {
  ordered_json costs = ordered_json::array();
  for (const render::ModeCost& cost : choice.costs)
    costs.push_back({{"mode", render::mode_name(cost.mode)},
                     {"frame_ms", cost.frame_ms},
                     {"measured", cost.measured},
                     {"meets_error", cost.meets_error}});
  return {{"mode", render::mode_name(choice.mode)},
          {"reason", choice.reason},
          {"costs", costs},
          {"trial_ms", choice.trial_ms}};
}

render::Mode drawn_mode(render::Mode asked, const render::RenderResult& result) {
  return result.choice ? result.choice->mode : asked;
}

ordered_json image_json(const render::ImageError& image) {
  return {{"psnr_db", std::min(image.psnr_db, kIdenticalPsnr_db)},
          {"psnr_linear_db", std::min(image.psnr_linear_db, kIdenticalPsnr_db)},
          {"flip_mean", image.flip_mean}};
}

ordered_json versions_json() {
  return {{"catoptra", version()},
          {"compiler", __VERSION__},
          {"cli11", CLI11_VERSION},
          {"tomlplusplus", dotted(TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
          {"nlohmann_json",
           dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
          {"spdlog", dotted(SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR, SPDLOG_VER_PATCH)}};
}

std::string json_text(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace catoptra::app

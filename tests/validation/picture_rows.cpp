// Rows that compare a picture with exact rays.
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "app/scene_file.h"
#include "cad_import/mirror_blank.h"
#include "render/comparison.h"
#include "render/renderer.h"
#include "tests/validation/table.h"

namespace catoptra::validation {
namespace {

render::Comparison compare_mode(const render::Scene& scene, render::Mode mode) {
  render::Renderer renderer(scene);
  render::FrameOptions options;
  options.width = 640;
  options.height = 360;
  options.geometry = true;
  const auto reference = renderer.render(render::Mode::raytrace, scene.camera, options);
  const auto picture = renderer.render(mode, scene.camera, options);
  return render::compare(reference.frame, picture.frame, scene);
}

std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw Error("validation", from, "not found in the scene");
  text.replace(at, from.size(), to);
}

/// wall_table.toml with a mirror of another radius and `cells` x `cells` cells.
render::Comparison wall(const std::filesystem::path& examples, const std::filesystem::path& folder,
                        double radius_mm, int cells) {
  cad_import::MirrorBlank blank;
  blank.radius_h_mm = blank.radius_v_mm = radius_mm;
  const auto mirror = std::filesystem::absolute(folder / "validation_wall.step");
  cad_import::write_mirror_blank(blank, mirror);
  std::string text = read_text(examples / "wall_table.toml");
  const std::string vertices = std::to_string(cells + 1);
  replace(text, "wall_mirror.step", mirror.string());
  replace(text, "grid = [7, 7]", "grid = [" + vertices + ", " + vertices + "]");
  const auto scene = app::read_scene_text(text, "wall_table.toml", examples);
  return compare_mode(scene.scene, render::Mode::pvrr);
}

Row wall_row(const std::filesystem::path& examples, const std::filesystem::path& folder,
             const std::string& name, double radius_mm, const char* designed) {
  const auto error = wall(examples, folder, radius_mm, 6).optics.at(0).arcmin;
  const std::string computed = number(error.median, 2) + " / " + number(error.p99, 2, "'");
  return {"Wall 5 m before a mirror, " + name + ", 49 vertices: error of `pvrr`, median / p99", designed,
          computed, computed};
}

/// p99 at 6 x 6, 12 x 12 and 24 x 24 cells; the order is the slope of its logarithm.
Row convergence(const std::filesystem::path& examples, const std::filesystem::path& folder) {
  std::array<double, 3> p99{};
  for (std::size_t i = 0; i < p99.size(); ++i)
    p99[i] = wall(examples, folder, 1200, 6 << i).optics.at(0).arcmin.p99;
  const double order = std::log2(p99[0] / p99[2]) / 2;
  return {"... order with which it falls, R 1200 convex, 6 to 24 cells a side", "2 (error ~ h²)",
          number(order, 2), below(std::abs(order - 2), "")};
}

std::vector<Row> plane(const std::filesystem::path& examples, const std::filesystem::path& folder) {
  const auto compared = wall(examples, folder, 0, 1);
  const double px = compared.optics.at(0).screen_px.max;
  return {{"Plane mirror, 4 vertices: greatest error of `pvrr`", "0 px", below(px, "px"), below(px, "px")},
          {"... picture against exact rays, PSNR", "≥ 45 dB", number(compared.image.psnr_db, 2, "dB"), "-"}};
}

std::vector<Row> door_mirror(const std::filesystem::path& examples) {
  const auto scene = app::read_scene(examples / "door_mirror.toml");
  std::vector<Row> rows;
  for (const render::Mode mode : {render::Mode::pvrr, render::Mode::hybrid, render::Mode::cubemap}) {
    const auto compared = compare_mode(scene.scene, mode);
    const auto& error = compared.optics.at(0).arcmin;
    const std::string computed = error.p99 < 1e-3
                                     ? below(error.p99, "'")
                                     : number(error.median, 2) + " / " + number(error.p99, 2, "'");
    rows.push_back(
        {"`door_mirror.toml`: error of `" + std::string(render::mode_name(mode)) + "`, median / p99",
         "exact rays", computed, computed});
  }
  return rows;
}

}  // namespace

std::vector<Row> picture_rows(const std::filesystem::path& examples, const std::filesystem::path& folder) {
  std::vector<Row> rows = plane(examples, folder);
  // In the column of expected values: the paper's way of interpolating (q = 1), measured by an independent
  // prototype.
  rows.push_back(wall_row(examples, folder, "R 3000 concave", -3000, "paper 0.40 / 0.64'"));
  rows.push_back(wall_row(examples, folder, "R 1200 concave", -1200, "paper 0.16 / 0.30'"));
  rows.push_back(wall_row(examples, folder, "R 1200 convex", 1200, "paper 0.56 / 1.8'"));
  rows.push_back(wall_row(examples, folder, "R 300 convex", 300, "paper 10 / 46'"));
  rows.push_back(convergence(examples, folder));
  for (Row& row : door_mirror(examples)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace catoptra::validation

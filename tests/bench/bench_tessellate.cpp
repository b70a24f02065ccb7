// Speed of the optics' mesher against the CAD kernel's, same faces, same chord, in one run.
// Usage: bench_tessellate [FILE...]: the reflecting faces of a made mirror first, then every face of each CAD
// file.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numeric>
#include <vector>

#include "cad_import/import.h"
#include "cad_import/mirror_blank.h"
#include "tessellate/optic_mesh.h"

namespace {

using namespace catoptra;

constexpr double kChord_mm = 0.01;
constexpr double kAngle_rad = 0.0873;

/// Median time of `count` runs, ms.
double median_ms(int count, const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  std::nth_element(times.begin(), times.begin() + count / 2, times.end());
  return times[static_cast<std::size_t>(count / 2)];
}

void compare(const char* name, const std::filesystem::path& file, const std::vector<int>& indices) {
  // The kernel keeps its mesh with the shape, so that only its first run counts.
  const cad_import::CadModel model = cad_import::import_cad(file);
  std::vector<cad_import::Face> faces;
  for (const int i : indices.empty() ? [&] {
         std::vector<int> all(model.faces.size());
         std::iota(all.begin(), all.end(), 0);
         return all;
       }() : indices)
    faces.push_back(model.faces[static_cast<std::size_t>(i)]);

  tessellate::TessellationOptions options;
  options.chord_mm = kChord_mm;
  options.angle_rad = kAngle_rad;
  std::size_t vertices = 0, triangles = 0;
  const double own_ms = median_ms(9, [&] {
    const auto mesh = tessellate::tessellate_optic(faces, options).mesh;
    vertices = mesh.vertex_count();
    triangles = mesh.triangle_count();
  });
  std::size_t kernel_triangles = 0;
  const double kernel_ms = median_ms(1, [&] {
    kernel_triangles = cad_import::triangulate(model, indices, {kChord_mm, kAngle_rad}).triangles.size();
  });
  std::printf(
      "%-28s %8.2f ms (%zu vertices, %zu triangles)   BRepMesh %9.1f ms (%zu triangles)   ratio %.0f\n", name,
      own_ms, vertices, triangles, kernel_ms, kernel_triangles, kernel_ms / own_ms);
}

void compare_mirror(const char* name, const cad_import::MirrorBlank& blank) {
  const auto file = std::filesystem::temp_directory_path() / "catoptra_bench_mirror.step";
  cad_import::write_mirror_blank(blank, file);
  const auto model = cad_import::import_cad(file);
  std::vector<int> glass;
  for (const auto& face : model.faces)
    if (face.name == "Glass") glass.push_back(face.index);
  compare(name, file, glass);
  std::filesystem::remove(file);
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("chord %g mm, angle %g rad\n", kChord_mm, kAngle_rad);
  cad_import::MirrorBlank blank;
  blank.outline = cad_import::MirrorOutline::rectangle;
  compare_mirror("mirror R 1200, rectangle", blank);
  blank.outline = cad_import::MirrorOutline::rounded;
  compare_mirror("mirror R 1200, rounded", blank);
  blank.radius_h_mm = blank.radius_v_mm = -400;
  compare_mirror("mirror R -400, rounded", blank);
  for (int k = 1; k < argc; ++k) compare(std::filesystem::path(argv[k]).filename().c_str(), argv[k], {});
  return 0;
}

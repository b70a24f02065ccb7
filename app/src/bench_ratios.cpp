#include "app/src/bench_ratios.h"

#include <chrono>
#include <vector>

#include "app/src/frame_timing.h"
#include "cad_import/import.h"
#include "optics/ray_scene.h"
#include "tessellate/optic_mesh.h"

namespace catoptra::app {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

optics::RayScene filled_ray_scene(const render::Scene& scene) {
  optics::RayScene rays;
  for (const auto& mesh : scene.surroundings) (void)rays.add_surroundings(mesh);
  for (const auto& optic : scene.optics) (void)rays.add_optic(optic.mesh);
  return rays;
}

tessellate::OpticArrays moved(tessellate::OpticArrays mesh, double by_mm) {
  for (auto& vertex : mesh.vertices) vertex.position_mm.x += by_mm;
  return mesh;
}

}  // namespace

CommitTimes time_commits(const render::Scene& scene) {
  // Full builds take up to a second at a million triangles: three of them. A moved optic's commit takes 0.1
  // ms, where a single reading says little: fifty.
  constexpr int kBuilds = 3, kMoves = 50;
  std::vector<double> builds, commits;
  const auto first_optic = static_cast<std::uint32_t>(scene.surroundings.size());
  for (int build = 0; build < kBuilds; ++build) {
    optics::RayScene rays = filled_ray_scene(scene);
    const auto start = Clock::now();
    rays.commit();
    builds.push_back(ms_since(start));
    if (build + 1 < kBuilds) continue;
    for (int i = 1; i <= kMoves; ++i) {
      const auto mesh = moved(scene.optics[0].mesh, 0.1 * i);
      const auto move_start = Clock::now();
      rays.update_optic(first_optic, mesh);
      rays.commit();
      commits.push_back(ms_since(move_start));
    }
  }
  return {median(builds), median(commits)};
}

MeshingTimes time_meshing(const SceneFile& file) {
  const OpticSource& source = file.optic_sources[0];
  const render::RenderSettings& settings = file.scene.settings;
  MeshingTimes times;
  tessellate::TessellationOptions options;
  options.chord_mm = settings.chord_mm;
  options.angle_rad = settings.angle_rad;
  std::vector<double> repetitions;
  for (int i = 0; i < 5; ++i) {
    const auto start = Clock::now();
    const auto result = tessellate::tessellate_optic(file.scene.optics[0].faces, options);
    repetitions.push_back(ms_since(start));
    times.tessellate_triangles = result.mesh.triangle_count();
  }
  times.tessellate_ms = median(repetitions);
  // Once: it takes seconds at fine chords.
  const auto start = Clock::now();
  const auto mesh =
      cad_import::triangulate(source.model, source.faces, {settings.chord_mm, settings.angle_rad});
  times.kernel_ms = ms_since(start);
  times.kernel_triangles = mesh.triangles.size();
  return times;
}

}  // namespace catoptra::app

// The ratios that `catoptra bench` states besides frame times.
#pragma once

#include "app/scene_file.h"
#include "render/scene.h"

namespace catoptra::app {

/// Commit of the ray scene after an optic moved, over building the whole of it: medians over a few
/// repetitions.
struct CommitTimes {
  double full_build_ms = 0;
  double optic_commit_ms = 0;
};

/// Needs at least one optic.
[[nodiscard]] CommitTimes time_commits(const render::Scene& scene);

/// Meshing the first optic's faces by tessellate_optic and by the CAD kernel's mesher at the same chord and
/// angle.
struct MeshingTimes {
  double tessellate_ms = 0;
  double kernel_ms = 0;
  std::size_t tessellate_triangles = 0, kernel_triangles = 0;
};

/// Needs at least one optic.
[[nodiscard]] MeshingTimes time_meshing(const SceneFile& file);

}  // namespace catoptra::app

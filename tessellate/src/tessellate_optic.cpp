// From what the caller asks for to limits that the mesher keeps.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "cad_import/error.h"
#include "tessellate/optic_mesh.h"
#include "tessellate/src/tessellator.h"

namespace catoptra::tessellate {
namespace {

using cad_import::Face;

constexpr double kCoarseAngle_rad =
    0.6;  // of borders and normals where the number of vertices is what counts
constexpr int kSearchSteps = 8;
constexpr double kAboutTarget = 0.05;  // of the number asked for

void check(std::span<const Face> faces, const TessellationOptions& options) {
  const auto refuse = [](const char* option, const char* reason) { throw Error("", option, reason); };
  if (faces.empty()) throw Error("", "optic", "there is no face to tessellate", "name the optical faces");
  if (!(options.chord_mm > 0)) refuse("chord_mm", "must be greater than 0");
  if (!(options.angle_rad > 0)) refuse("angle_rad", "must be greater than 0");
  if (options.max_vertices < 4) refuse("max_vertices", "must be at least 4");
  if (options.min_vertices > options.max_vertices) refuse("min_vertices", "must not exceed max_vertices");
  if (options.grid && (options.grid->columns < 2 || options.grid->rows < 2))
    refuse("grid", "needs at least 2 x 2 vertices");
  if (options.target_vertices &&
      (*options.target_vertices < 4 || *options.target_vertices > options.max_vertices))
    refuse("target_vertices", "must be at least 4 and at most max_vertices");
}

/// Meshes, leaving out for good what cannot be meshed: no vertex then belongs to a face that is not there.
Attempt mesh_without_failures(Tessellator& work, const StepLimits& limits) {
  while (true) {
    Attempt attempt = work.mesh(limits);
    bool failed = false;
    for (std::size_t f = 0; f < attempt.failure.size(); ++f) {
      if (attempt.failure[f].empty()) continue;
      work.skip(f, attempt.failure[f]);
      failed = true;
    }
    if (!failed) return attempt;
  }
}

/// Columns and rows whose product is `target` with cells at most twice as long as wide, or else the nearest
/// to square.
GridRequest square_cells(std::size_t target, const glm::dvec2& size_mm) {
  const auto n = static_cast<int>(target);
  const auto elongation = [&](int columns, int rows) {
    return std::abs(std::log(size_mm.x / (columns - 1) * (rows - 1) / size_mm.y));
  };
  GridRequest best{0, 0};
  for (int columns = 2; columns <= n / 2; ++columns)
    if (n % columns == 0 &&
        (best.columns == 0 || elongation(columns, n / columns) < elongation(best.columns, best.rows)))
      best = {columns, n / columns};
  if (best.columns > 0 && elongation(best.columns, best.rows) <= std::log(2.0)) return best;
  const double columns = std::max(2.0, std::round(std::sqrt(n * size_mm.x / size_mm.y)));
  return {static_cast<int>(columns), static_cast<int>(std::max(2.0, std::round(n / columns)))};
}

/// Even steps of a length that gives about `target` vertices.
Attempt mesh_to_target(Tessellator& work, std::size_t target) {
  StepLimits limits{kUnlimited, kCoarseAngle_rad, kUnlimited, {}};
  const auto wanted = static_cast<double>(target);
  if (work.is_single_grid()) {
    limits.grid = square_cells(target, work.single_size_mm());
    return mesh_without_failures(work, limits);
  }
  limits.length_mm = std::sqrt(work.rectangle_area_mm2() / wanted);
  Attempt best = mesh_without_failures(work, limits);
  const auto miss = [&](const Attempt& a) {
    return std::abs(std::log(static_cast<double>(a.draft.vertices.size()) / wanted));
  };
  double count = static_cast<double>(best.draft.vertices.size());
  for (int step = 0; step < kSearchSteps && miss(best) > kAboutTarget; ++step) {
    limits.length_mm *= std::sqrt(count / wanted);
    Attempt next = mesh_without_failures(work, limits);
    count = static_cast<double>(next.draft.vertices.size());
    if (miss(next) < miss(best)) best = std::move(next);
  }
  return best;
}

/// By chord and angle; coarser or finer where that gives more or fewer vertices than the options allow.
Attempt mesh_to_chord(Tessellator& work, const TessellationOptions& options,
                      std::vector<std::string>& warnings) {
  StepLimits limits{options.chord_mm, options.angle_rad, kUnlimited, {}};
  const auto most = static_cast<double>(options.max_vertices),
             least = static_cast<double>(options.min_vertices);
  bool coarser = false;
  const auto coarsen = [&](double count) {
    limits.chord_mm *= 1.1 * count / most;
    limits.angle_rad *= std::sqrt(1.1 * count / most);
    coarser = true;
  };
  for (int step = 0; step < kSearchSteps; ++step) {
    const double cells = work.estimated_cells(limits);
    if (cells <= most) break;
    coarsen(cells);
  }
  Attempt attempt = mesh_without_failures(work, limits);
  for (int step = 0; step<kSearchSteps&& static_cast<double>(attempt.draft.vertices.size())> most; ++step) {
    coarsen(static_cast<double>(attempt.draft.vertices.size()));
    attempt = mesh_without_failures(work, limits);
  }
  if (coarser) {
    std::ostringstream text;
    text << "a chord of " << options.chord_mm << " mm needs more than " << options.max_vertices
         << " vertices: meshed with " << limits.chord_mm << " mm (is the unit right?)";
    warnings.push_back(text.str());
  }
  limits.length_mm = std::sqrt(work.rectangle_area_mm2() / least);
  for (int step = 0; step < kSearchSteps && !coarser; ++step) {
    const auto count = static_cast<double>(attempt.draft.vertices.size());
    if (count >= least || work.remaining() == 0) break;
    attempt = mesh_without_failures(work, limits);
    limits.length_mm *=
        0.9 * std::min(1.0, std::sqrt(static_cast<double>(attempt.draft.vertices.size()) / least));
  }
  return attempt;
}

}  // namespace

OpticMeshResult tessellate_optic(std::span<const Face> faces, const TessellationOptions& options) {
  check(faces, options);
  Tessellator work(faces);
  std::vector<std::string> warnings;
  const Attempt attempt =
      options.grid ? mesh_without_failures(work, {kUnlimited, kCoarseAngle_rad, kUnlimited, options.grid})
      : options.target_vertices ? mesh_to_target(work, *options.target_vertices)
                                : mesh_to_chord(work, options, warnings);

  std::vector<UnmeshedFace> unmeshed;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (!work.skipped()[f].empty()) unmeshed.push_back({static_cast<int>(f), faces[f].id, work.skipped()[f]});
  if (attempt.draft.triangles.empty())
    throw Error("", "face " + unmeshed.front().id, "no face could be meshed: " + unmeshed.front().reason);
  return {OpticMesh(attempt.draft, work.faces()), std::move(unmeshed), std::move(warnings)};
}

}  // namespace catoptra::tessellate

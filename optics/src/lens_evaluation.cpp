#include "optics/lens_evaluation.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>

#include "optics/src/lens_chief_rays.h"
#include "optics/src/lens_setting.h"

namespace catoptra::optics {
namespace {

// Calls `chunk` for [first, last) of every ChiefRays::kMost indices below `count`; where they begin does not
// depend on the threads.
void for_each_chunk(std::size_t count, std::size_t threads,
                    const std::function<void(std::size_t first, std::size_t last)>& chunk) {
  constexpr std::size_t kMost = ChiefRays::kMost;
  const std::size_t most = std::size_t(tbb::this_task_arena::max_concurrency());
  tbb::task_arena arena(int(threads == 0 ? most : std::min(threads, most)));
  arena.execute([&] {
    tbb::parallel_for(std::size_t(0), (count + kMost - 1) / kMost,
                      [&](std::size_t c) { chunk(c * kMost, std::min(count, (c + 1) * kMost)); });
  });
}

}  // namespace

struct LensEvaluator::Impl {
  const Optic& lens;
  LensFrame frame;
  ChiefRays rays;
  double start_mm = 10;  // so far behind the back vertex, and more, is nothing of the lens

  Impl(const Optic& optic, const LensFrame& f) : lens(optic), frame(f), rays(optic) {
    for (const auto& vertex : lens.back.mesh.vertices)
      start_mm = std::max(start_mm, 10 - glm::dot(vertex.position_mm - frame.back_vertex_mm, frame.z));
  }

  // The ray along the lens's axis that meets its back at (x, y).
  Ray axial_ray(const glm::dvec2& point) const {
    return {frame.back_vertex_mm + point.x * frame.x + point.y * frame.y - start_mm * frame.z, frame.z};
  }

  LensSetting setting(const EvaluationOptions& options) const {
    return {options, lens, frame, rays.one_by_one(), axial_ray({0, 0})};
  }

  // Measures the lens where `sight` meets it, and writes what it finds to the points.
  void measure(const LensSetting& setting, std::span<const Ray> sight, std::span<LensPoint> points) const {
    const auto chief = rays.trace(sight, setting.task());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = setting.measured(points[i], chief[i]);
  }

  // The same where points of the back surface are given.
  void measure_at(const LensSetting& setting, std::span<LensPoint> points) const {
    std::vector<Ray> sight;
    for (const LensPoint& point : points) sight.push_back(axial_ray(point.point_mm));
    ChiefRayTask to_back;
    to_back.indices = setting.task().indices;
    const auto met = rays.trace(sight, to_back);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (met[i].end == LensPathEnd::missed) continue;  // nor will the same ray meet it below
      const glm::dvec3 direction = glm::normalize(met[i].back_mm - setting.rotation_centre_mm());
      points[i].gaze_rad = gaze_of(setting.wearer(), direction);
      if (setting.worn()) sight[i] = {setting.rotation_centre_mm(), direction};
    }
    measure(setting, sight, points);
  }
};

LensEvaluator::LensEvaluator(const Optic& lens, const LensFrame& frame)
    : impl_(std::make_unique<Impl>(lens, frame)) {}
LensEvaluator::~LensEvaluator() = default;
LensEvaluator::LensEvaluator(LensEvaluator&&) noexcept = default;

LensEvaluation LensEvaluator::at_gaze(std::span<const glm::dvec2> gaze_rad,
                                      const EvaluationOptions& options) const {
  const LensSetting setting = impl_->setting(options);
  LensEvaluation result = setting.of_lens();
  result.points.resize(gaze_rad.size());
  for_each_chunk(gaze_rad.size(), options.threads, [&](std::size_t first, std::size_t last) {
    std::vector<Ray> sight;
    for (std::size_t i = first; i < last; ++i) {
      result.points[i].gaze_rad = gaze_rad[i];
      sight.push_back({setting.rotation_centre_mm(), gaze_direction(setting.wearer(), gaze_rad[i])});
    }
    impl_->measure(setting, sight, std::span(result.points).subspan(first, last - first));
  });
  return result;
}

LensEvaluation LensEvaluator::at_points(std::span<const glm::dvec2> points_mm,
                                        const EvaluationOptions& options) const {
  const LensSetting setting = impl_->setting(options);
  LensEvaluation result = setting.of_lens();
  result.points.resize(points_mm.size());
  for (std::size_t i = 0; i < points_mm.size(); ++i) result.points[i].point_mm = points_mm[i];
  for_each_chunk(points_mm.size(), options.threads, [&](std::size_t first, std::size_t last) {
    impl_->measure_at(setting, std::span(result.points).subspan(first, last - first));
  });
  return result;
}

}  // namespace catoptra::optics

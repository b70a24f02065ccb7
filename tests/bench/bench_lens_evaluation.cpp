// Chief rays with their wavefronts through a lens of two B-spline surfaces, per second and core: the kernel
// alone on each vector unit, whole measured points, and a map of 41 x 41 points with its evaluator. Ratios
// are of one run.
//   bench_lens_evaluation [points in thousands, default 200]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <glm/trigonometric.hpp>
#include <string>

#include "optics/lens_evaluation.h"
#include "optics/src/lens_chief_rays.h"
#include "optics/src/lens_wearing.h"
#include "tests/support/bspline_lens.h"

namespace {

using namespace catoptra;

// Processor time of the calling thread, s, best of seven: the least disturbed run.
double seconds(const std::function<void()>& run) {
  double best = 1e300;
  for (int i = 0; i < 7; ++i) {
    timespec begin{}, end{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    run();
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    best = std::min(best, double(end.tv_sec - begin.tv_sec) + 1e-9 * double(end.tv_nsec - begin.tv_nsec));
  }
  return best;
}

// Directions in rows within 35 degrees, about `count` of them.
std::vector<glm::dvec2> gazes_of(std::size_t count) {
  const double reach = glm::radians(35.0);
  return optics::gaze_grid(reach, reach * std::sqrt(3.1416 / double(count)));
}

std::vector<optics::Ray> rays_of(std::span<const glm::dvec2> gazes, const optics::LensFrame& frame) {
  const optics::Axes axes = optics::lens_axes(frame);
  std::vector<optics::Ray> rays;
  for (const glm::dvec2& gaze : gazes)
    rays.push_back({frame.back_vertex_mm - 25.0 * frame.z, optics::gaze_direction(axes, gaze)});
  return rays;
}

std::size_t trace_all(const optics::ChiefRays& tracer, std::span<const optics::Ray> rays,
                      const optics::ChiefRayTask& task, optics::SimdLevel level) {
  std::size_t passed = 0;
  for (std::size_t first = 0; first < rays.size(); first += optics::ChiefRays::kMost) {
    const std::size_t count = std::min(optics::ChiefRays::kMost, rays.size() - first);
    for (const auto& chief : tracer.trace(rays.subspan(first, count), task, level))
      passed += chief.end == optics::LensPathEnd::passed;
  }
  return passed;
}

void bench_kernel(const optics::Optic& lens, const optics::LensFrame& frame, std::size_t count) {
  const optics::ChiefRays tracer(lens);
  const auto rays = rays_of(gazes_of(count), frame);
  const auto million_per_s = [&](std::size_t n, double s) { return double(n) * 1e-6 / s; };
  for (const bool coloured : {false, true}) {
    optics::ChiefRayTask task;
    task.indices = {1.586, 1};
    task.coloured = coloured;
    task.indices_f = {1.6, 1};
    task.indices_c = {1.58, 1};
    std::size_t passed = 0;
    const double single = million_per_s(rays.size() / 8, seconds([&] {
                                          for (std::size_t i = 0; i < rays.size(); i += 8)
                                            passed += tracer.one_by_one().trace(rays[i], task).coloured;
                                        }));
    std::printf("  chief rays%s, million per s and core: one by one %.3f",
                coloured ? " and their F and C" : "", single);
    double scalar = 0;
    for (const auto level : {optics::SimdLevel::scalar, optics::SimdLevel::avx2, optics::SimdLevel::avx512}) {
      if (level > optics::best_simd_level()) continue;
      const double rate =
          million_per_s(rays.size(), seconds([&] { passed += trace_all(tracer, rays, task, level); }));
      if (level == optics::SimdLevel::scalar) scalar = rate;
      std::printf(", %s %.2f (x %.1f)", std::string(optics::simd_level_name(level)).c_str(), rate,
                  rate / scalar);
    }
    std::printf("  [%zu passed]\n", passed);
  }
}

void bench_points(const optics::Optic& lens, const optics::LensFrame& frame, std::size_t count) {
  const auto gazes = gazes_of(count);
  std::vector<glm::dvec2> square;
  for (int j = 0; j < 41; ++j)
    for (int i = 0; i < 41; ++i) square.emplace_back(1.2 * (i - 20), 1.2 * (20 - j));
  const optics::LensEvaluator evaluator(lens, frame);
  optics::EvaluationOptions options;
  options.threads = 1;
  for (const auto mode : {optics::EvaluationMode::as_worn, optics::EvaluationMode::lensmeter})
    for (const bool chromatic : {false, true}) {
      options.mode = mode;
      options.chromatic = chromatic;
      std::size_t passed = 0;
      const double points = seconds([&] {
        for (const auto& p : evaluator.at_gaze(gazes, options).points)
          passed += p.end == optics::LensPathEnd::passed;
      });
      const double map = seconds([&] { passed += evaluator.at_points(square, options).points.size(); });
      std::printf("  %s%s: %.2f million points per s and core, map of 41 x 41 points %.3f ms  [%zu]\n",
                  mode == optics::EvaluationMode::as_worn ? "as worn  " : "focimeter",
                  chromatic ? " in colours" : "", double(gazes.size()) * 1e-6 / points, 1e3 * map, passed);
    }
  options.chromatic = true;
  const double whole = seconds([&] {
    const optics::LensEvaluator fresh(lens, frame);
    (void)fresh.at_points(square, options);
  });
  std::printf("  evaluator made anew and map: %.2f ms\n", 1e3 * whole);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = std::size_t(argc > 1 ? std::max(1, std::atoi(argv[1])) : 200) * 1000;
  for (const int degree : {3, 5}) {
    test::BSplineLensSpec spec;
    spec.poles = 24;
    spec.degree = degree;
    spec.trim_radius_mm = 34.5;
    optics::Optic lens = test::bspline_lens(spec);
    lens.medium = optics::abbe_medium(1.586, 30);
    const optics::LensFrame frame{.front_vertex_mm = {0, 0, 0}, .back_vertex_mm = {0, 0, -spec.thickness_mm}};
    std::printf("B-splines of degree %d, %d x %d poles\n", degree, spec.poles, spec.poles);
    bench_kernel(lens, frame, count);
    bench_points(lens, frame, count);
  }
}

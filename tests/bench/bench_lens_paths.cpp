// Whole paths through a lens of two bicubic B-splines per second and core: one at a time through the mesh,
// one at a time without it, and several at once, all in one run.
//   bench_lens_paths [rays in thousands, default 1000]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <glm/geometric.hpp>
#include <string>

#include "optics/lens_path_batch.h"
#include "optics/map_coordinates.h"
#include "tests/support/bspline_lens.h"

namespace {

using namespace catoptra;

// Rays of an eye 60 mm behind the lens in rows over its middle 50 mm, as a picture is scanned.
std::vector<optics::Ray> rows_of_rays(std::size_t count) {
  const std::size_t side = std::size_t(std::sqrt(double(count)));
  const glm::dvec3 eye(0, 0, -63);
  std::vector<optics::Ray> rays;
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i) {
      const glm::dvec3 on_lens(50 * (double(i) / double(side) - 0.5), 50 * (double(j) / double(side) - 0.5),
                               -3);
      rays.push_back({eye, glm::normalize(on_lens - eye)});
    }
  return rays;
}

// Processor time of the calling thread, best of five: the least disturbed run.
double millions_per_second(std::size_t count, const std::function<void()>& run) {
  double best = 1e300;
  for (int i = 0; i < 5; ++i) {
    timespec begin{}, end{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    run();
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    best = std::min(best, double(end.tv_sec - begin.tv_sec) + 1e-9 * double(end.tv_nsec - begin.tv_nsec));
  }
  return double(count) * 1e-6 / best;
}

void bench(int poles, std::size_t count) {
  test::BSplineLensSpec spec;
  spec.poles = poles;
  spec.trim_radius_mm = 34;
  const optics::Optic lens = test::bspline_lens(spec);
  const auto rays = rows_of_rays(count);
  const optics::LensIndices indices{1.586, 1};
  const optics::LensTracer single(lens);
  std::size_t passed = 0;
  const double through_mesh = millions_per_second(rays.size() / 4, [&] {
    for (std::size_t i = 0; i < rays.size() / 4; ++i)
      passed += single.trace(rays[i], optics::LensSide::back, indices).end == optics::LensPathEnd::passed;
  });
  std::printf("%2d x %2d poles, %zu rays: LensTracer %.2f million paths/s and core\n", poles, poles,
              rays.size(), through_mesh);
  const optics::LensBatchTracer tracer(lens, optics::LensSide::back, indices);
  optics::LensRayBatch batch(rays);
  double scalar = 0;
  for (const auto level : {optics::SimdLevel::scalar, optics::SimdLevel::avx2, optics::SimdLevel::avx512}) {
    if (level > optics::best_simd_level()) continue;
    const double rate =
        millions_per_second(rays.size(), [&] { batch = tracer.trace(std::move(batch), level); });
    if (level == optics::SimdLevel::scalar) scalar = rate;
    const auto through = std::count(batch.end.begin(), batch.end.end(), optics::LensPathEnd::passed);
    std::printf(
        "    %-8s %6.2f million paths/s and core, %.1f times LensTracer, %.1f times scalar (%ld passed)\n",
        std::string(optics::simd_level_name(level)).c_str(), rate, rate / through_mesh, rate / scalar,
        long(through));
  }
  if (passed == 0) std::puts("no ray passed");
}

// Lenses that the batch does not take, or that cost more per evaluation: LensTracer alone.
void bench_single(const char* name, const optics::Optic& lens, std::size_t count) {
  const auto rays = rows_of_rays(count);
  const optics::LensTracer tracer(lens);
  std::size_t passed = 0;
  const double rate = millions_per_second(rays.size(), [&] {
    for (const optics::Ray& ray : rays)
      passed += tracer.trace(ray, optics::LensSide::back, {1.586, 1}).end == optics::LensPathEnd::passed;
  });
  std::printf("%s: LensTracer %.2f million paths/s and core (%zu passed)\n", name, rate, passed / 5);
}

// PVRR's share: the vertices of one side with their differentials (on all cores), and the two steps that
// follow.
void bench_vertices(int per_side) {
  const optics::Optic lens = test::bspline_lens({.per_side = per_side});
  const optics::LensTracer tracer(lens);
  const glm::dvec3 eye(0, 0, -63);
  std::vector<optics::VertexHit> hits;
  const auto milliseconds = [](const std::function<void()>& run) {  // of the wall clock, best of twenty
    double best = 1e300;
    for (int i = 0; i < 20; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      run();
      best = std::min(
          best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    }
    return best;
  };
  const double refract = milliseconds(
      [&] { hits = optics::refract_vertices(lens, tracer, optics::LensSide::back, optics::kLineD_nm, eye); });
  optics::VirtualView view;
  const double fit = milliseconds([&] {
    view =
        optics::make_virtual_view(lens, optics::LensSide::back, hits, {{-1e4, -1e4, -100}, {1e4, 1e4, 6e3}});
  });
  std::size_t count = 0;
  const double coordinates = milliseconds(
      [&] { count += optics::map_coordinates(lens, optics::LensSide::back, hits, view).size(); });
  std::printf("%d vertices, ms: rays %.2f, viewpoint and volume %.3f, coordinates %.2f (%zu)\n",
              per_side * per_side, refract, fit, coordinates, count);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = std::size_t(argc > 1 ? std::max(1, std::atoi(argv[1])) : 1000) * 1000;
  for (const int poles : {8, 16, 40}) bench(poles, count);
  bench_single("two spheres", test::spherical_lens(120, 90, 3, 70, 33), count / 4);
  bench_single("degree 5, 16 x 16 poles", test::bspline_lens({.degree = 5}), count / 4);
  for (const int per_side : {23, 32}) bench_vertices(per_side);
}

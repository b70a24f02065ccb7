// Surface evaluation, own against the CAD kernel's, in one run: counts per second and their ratio.
//   bench_surface [evaluations in millions, default 2]
#include <GeomAdaptor_Surface.hxx>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

#include "tests/cad_import/kernel_geometry.h"

namespace {

using catoptra::test::RandomSurface;

struct Points {
  std::vector<double> u, v;
};

// Random points, so that no evaluator profits from a cache of the last span.
Points random_points(const catoptra::cad_import::ParameterDomain& d, std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(d.u_min, d.u_max), v(d.v_min, d.v_max);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    points.u.push_back(u(random));
    points.v.push_back(v(random));
  }
  return points;
}

// Processor time, best of five: the least disturbed run. The sum keeps the compiler from leaving the work
// out.
double millions_per_second(std::size_t count, const std::function<double()>& run) {
  double best = 1e300, sum = 0;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t begin = std::clock();
    sum += run();
    best = std::min(best, double(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  if (sum == 0.12345) std::puts("");
  return double(count) * 1e-6 / best;
}

void bench(const char* name, const RandomSurface& spec, std::size_t count) {
  std::mt19937 random(7);
  const Handle(Geom_BSplineSurface) kernel = catoptra::test::random_bspline(spec, random);
  const auto own = catoptra::test::evaluator_of(kernel);
  const Points points = random_points(own->domain(), 65536);
  const auto each = [&](auto evaluate) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += evaluate(points.u[i & 65535], points.v[i & 65535]);
    return sum;
  };
  const double own_d1 = millions_per_second(count, [&] {
    return each([&](double u, double v) {
      const auto f = own->d1(u, v);
      return f.point.x + f.du.y + f.dv.z;
    });
  });
  const double own_d2 = millions_per_second(count, [&] {
    return each([&](double u, double v) {
      const auto f = own->d2(u, v);
      return f.point.x + f.du.y + f.dvv.z;
    });
  });
  gp_Pnt p;
  gp_Vec du, dv;
  const double kernel_d1 = millions_per_second(count, [&] {
    return each([&](double u, double v) {
      kernel->D1(u, v, p, du, dv);
      return p.X() + du.Y() + dv.Z();
    });
  });
  const GeomAdaptor_Surface adaptor(kernel);
  const double adaptor_d1 = millions_per_second(count, [&] {
    return each([&](double u, double v) {
      adaptor.D1(u, v, p, du, dv);
      return p.X() + du.Y() + dv.Z();
    });
  });
  std::printf(
      "%-28s own D1 %6.1f  own D2 %6.1f  Geom_BSplineSurface D1 %5.2f  GeomAdaptor D1 %5.2f   own D1 / Geom "
      "%5.1f\n",
      name, own_d1, own_d2, kernel_d1, adaptor_d1, own_d1 / kernel_d1);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = std::size_t(1e6 * (argc > 1 ? std::atof(argv[1]) : 2.0));
  std::printf("million evaluations per second at random parameters, one thread, %zu evaluations each\n",
              count);
  bench("bicubic, 5 x 5 spans", {3, 3, 5, 5, false, false, false}, count);
  bench("bicubic, 13 x 13 spans", {3, 3, 13, 13, false, false, false}, count);
  bench("bicubic, 37 x 37 spans", {3, 3, 37, 37, false, false, false}, count);
  bench("bicubic rational, 13 x 13", {3, 3, 13, 13, true, false, false}, count);
  bench("degree 5, 5 x 5 spans", {5, 5, 5, 5, false, false, false}, count);
  bench("degree 8, 3 x 3 spans", {8, 8, 3, 3, false, false, false}, count);
  return 0;
}

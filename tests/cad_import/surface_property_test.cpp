// Every kind of surface: derivatives against finite differences, placement, threads, domain.
#include <gtest/gtest.h>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <gp_Ax3.hxx>

#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <thread>

#include "tests/cad_import/kernel_geometry.h"

namespace catoptra::cad_import {
namespace {

constexpr unsigned kSeed = 4711;

gp_Ax3 tilted_frame() {
  return {gp_Pnt(3, -7, 11), gp_Dir(1, 2, 3), gp_Dir(0, 3, -2)};
}

// A curve in the plane of the axis, away from it.
Handle(Geom_BezierCurve) profile() {
  TColgp_Array1OfPnt poles(1, 4);
  poles(1) = gp_Pnt(20, 0, 0);
  poles(2) = gp_Pnt(25, 0, 8);
  poles(3) = gp_Pnt(24, 0, 15);
  poles(4) = gp_Pnt(30, 0, 22);
  return new Geom_BezierCurve(poles);
}

struct Sort {
  std::string name;
  SurfaceKind kind;
  std::function<Handle(Geom_Surface)()> make;
};

Handle(Geom_Surface) random_patch(bool rational) {
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  return test::random_bspline({4, 3, 3, 3, rational, false, false}, random);
}

std::vector<Sort> sorts() {
  const gp_Ax1 z(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
  return {
      {"plane", SurfaceKind::plane, [] { return new Geom_Plane(tilted_frame()); }},
      {"cylinder", SurfaceKind::cylinder, [] { return new Geom_CylindricalSurface(tilted_frame(), 12); }},
      {"cone", SurfaceKind::cone, [] { return new Geom_ConicalSurface(tilted_frame(), 0.4, 12); }},
      {"sphere", SurfaceKind::sphere, [] { return new Geom_SphericalSurface(tilted_frame(), 12); }},
      {"torus", SurfaceKind::torus, [] { return new Geom_ToroidalSurface(tilted_frame(), 30, 12); }},
      {"bspline", SurfaceKind::bspline, [] { return random_patch(false); }},
      {"rational", SurfaceKind::bspline, [] { return random_patch(true); }},
      {"revolution", SurfaceKind::revolution, [z] { return new Geom_SurfaceOfRevolution(profile(), z); }},
      {"extrusion", SurfaceKind::extrusion,
       [] { return new Geom_SurfaceOfLinearExtrusion(new Geom_Ellipse(gp_Ax2(), 9, 5), gp_Dir(1, 1, 3)); }},
      {"offset", SurfaceKind::offset,
       [z] { return new Geom_OffsetSurface(new Geom_SurfaceOfRevolution(profile(), z), 2.5); }},
      {"trimmed", SurfaceKind::torus,
       [] {
         return new Geom_RectangularTrimmedSurface(new Geom_ToroidalSurface(tilted_frame(), 30, 12), 0.2, 1.1,
                                                   0.3, 1.4);
       }},
  };
}

class EverySort : public testing::TestWithParam<Sort> {};

std::vector<glm::dvec2> points_inside(const ExactSurface& surface) {
  const ParameterDomain d = surface.domain();
  std::vector<glm::dvec2> points;
  for (const double a : {0.13, 0.37, 0.61, 0.82})
    for (const double b : {0.18, 0.45, 0.77})
      points.emplace_back(d.u_min + a * (d.u_max - d.u_min), d.v_min + b * (d.v_max - d.v_min));
  return points;
}

TEST_P(EverySort, AgreesWithKernelTo1e12) {
  const Handle(Geom_Surface) kernel = GetParam().make();
  const auto own = test::evaluator_of(kernel);
  EXPECT_EQ(own->kind(), GetParam().kind);
  for (const glm::dvec2 uv : points_inside(*own)) {
    const SurfaceDerivatives a = test::kernel_d2(kernel, uv.x, uv.y), b = own->d2(uv.x, uv.y);
    const auto near = [](const glm::dvec3& x, const glm::dvec3& y, double size) {
      EXPECT_LT(glm::length(x - y), 1e-12 * std::max(size, 1.0));
    };
    const double first = glm::length(a.du) + glm::length(a.dv);
    const double second = glm::length(a.duu) + glm::length(a.duv) + glm::length(a.dvv);
    near(a.point, b.point, glm::length(a.point));
    near(a.du, b.du, first);
    near(a.dv, b.dv, first);
    near(a.duu, b.duu, second);
    near(a.duv, b.duv, second);
    near(a.dvv, b.dvv, second);
  }
}

TEST_P(EverySort, DerivativesAreThoseOfFiniteDifferences) {
  const auto s = test::evaluator_of(GetParam().make());
  const ParameterDomain d = s->domain();
  // Central differences: error h^2/6 f''' + 1e-14/h; h = 1e-4 of the domain leaves about 1e-7 of the
  // derivative.
  const double hu = 1e-4 * (d.u_max - d.u_min), hv = 1e-4 * (d.v_max - d.v_min);
  for (const glm::dvec2 uv : points_inside(*s)) {
    const double u = uv.x, v = uv.y;
    const SurfaceDerivatives exact = s->d2(u, v);
    const auto near = [](const glm::dvec3& analytic, const glm::dvec3& difference, double size) {
      EXPECT_LT(glm::length(analytic - difference), 1e-5 * (size + 1e-3));
    };
    const double first = glm::length(exact.du) + glm::length(exact.dv);
    near(exact.du, (s->point(u + hu, v) - s->point(u - hu, v)) / (2 * hu), first);
    near(exact.dv, (s->point(u, v + hv) - s->point(u, v - hv)) / (2 * hv), first);
    const SurfaceFrame right = s->d1(u + hu, v), left = s->d1(u - hu, v), up = s->d1(u, v + hv),
                       down = s->d1(u, v - hv);
    const double second = glm::length(exact.duu) + glm::length(exact.duv) + glm::length(exact.dvv);
    near(exact.duu, (right.du - left.du) / (2 * hu), second);
    near(exact.duv, (right.dv - left.dv) / (2 * hu), second);
    near(exact.duv, (up.du - down.du) / (2 * hv), second);
    near(exact.dvv, (up.dv - down.dv) / (2 * hv), second);
  }
}

TEST_P(EverySort, PlacementMovesScalesAndMirrors) {
  const Handle(Geom_Surface) kernel = GetParam().make();
  glm::dmat4 m =
      glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(100, -20, 3)), 0.7, glm::dvec3(1, 2, -1));
  m = glm::scale(m, glm::dvec3(-25.4, 25.4, 25.4));  // inches, mirrored at x
  const AffineMap map(m);
  const auto own = test::evaluator_of(kernel), placed = test::evaluator_of(kernel, map);
  EXPECT_EQ(placed->orientation(), -own->orientation());
  const glm::dmat3 linear(m);
  for (const glm::dvec2 uv : points_inside(*own)) {
    const SurfaceDerivatives a = own->d2(uv.x, uv.y), b = placed->d2(uv.x, uv.y);
    EXPECT_LT(glm::length(glm::dvec3(m * glm::dvec4(a.point, 1)) - b.point), 1e-10);
    EXPECT_LT(glm::length(linear * a.duv - b.duv), 1e-10 * (1 + glm::length(linear * a.duv)));
    // The outside stays the outside.
    const glm::dvec3 n = glm::normalize(linear * own->unit_normal(uv.x, uv.y));
    EXPECT_LT(glm::length(n - placed->unit_normal(uv.x, uv.y)), 1e-10);
    const PrincipalCurvatures k = own->principal_curvatures(uv.x, uv.y),
                              s = placed->principal_curvatures(uv.x, uv.y);
    EXPECT_NEAR(k.k1 / 25.4, s.k1, 1e-11);
    EXPECT_NEAR(k.k2 / 25.4, s.k2, 1e-11);
  }
}

TEST_P(EverySort, ManyThreadsSeeTheSameNumbersAndNothingThrows) {
  const auto s = test::evaluator_of(GetParam().make());
  const ParameterDomain d = s->domain();
  const auto sum = [&] {
    glm::dvec3 total(0);
    for (int i = 0; i < 3000; ++i) {  // half as far again beyond the domain on either side
      const double a = (i * 7919 % 3000) / 1500.0 - 0.5, b = (i * 104729 % 3000) / 1500.0 - 0.5;
      const double u = d.u_min + a * (d.u_max - d.u_min), v = d.v_min + b * (d.v_max - d.v_min);
      const SurfaceDerivatives f = s->d2(u, v);
      total += f.point + 0.1 * f.duv + s->unit_normal(u, v);
    }
    return total;
  };
  const glm::dvec3 expected = sum();
  std::vector<glm::dvec3> results(8);
  std::vector<std::thread> threads;
  for (glm::dvec3& result : results) threads.emplace_back([&] { result = sum(); });
  for (std::thread& thread : threads) thread.join();
  for (const glm::dvec3& result : results) EXPECT_EQ(result, expected);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EverySort, testing::ValuesIn(sorts()),
                         [](const testing::TestParamInfo<Sort>& sort) { return sort.param.name; });

}  // namespace
}  // namespace catoptra::cad_import

// Areas by adaptive cells against closed forms.
#include "optics/ground_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace catoptra::optics {
namespace {

const std::vector<GroundPolygon> kSquare{{{-2000, -2000}, {2000, -2000}, {2000, 2000}, {-2000, 2000}}};

TEST(GroundRegion, DiscWithinTheStatedBound) {
  for (const double radius : {1500.0, 700.0, 333.0}) {
    const auto measured = measure_region(kSquare, [radius](const glm::dvec2& p) {
      return std::uint8_t(glm::length(p - glm::dvec2(100, 57)) < radius ? 1 : 0);
    });
    const double exact = glm::pi<double>() * radius * radius;
    EXPECT_EQ(measured.area_mm2, 16e6);
    EXPECT_LE(std::abs(measured.area_of_any(1) - exact), measured.mixed_mm2);
    EXPECT_LE(measured.mixed_mm2, 5e-4 * 16e6);
    EXPECT_NEAR(measured.area_of_any(1) / exact, 1, 2e-3);
  }
}

TEST(GroundRegion, StatesAddUpAndSetsCombine) {
  const auto measured = measure_region(
      kSquare, [](const glm::dvec2& p) { return std::uint8_t((p.x < 300 ? 1 : 0) | (p.y > -200 ? 2 : 0)); });
  double sum = 0;
  for (const auto& [state, area] : measured.area_by_state) sum += area;
  EXPECT_NEAR(sum, measured.area_mm2, 1e-3);
  EXPECT_NEAR(measured.area_of_any(1), 2300.0 * 4000, measured.mixed_mm2);
  EXPECT_NEAR(measured.area_of_all(3), 2300.0 * 2200, measured.mixed_mm2);
  EXPECT_NEAR(measured.area_of_any(3),
              measured.area_of_any(1) + measured.area_of_any(2) - measured.area_of_all(3), 1e-3);
}

TEST(GroundRegion, SlantedPartsAreCutExactly) {
  // Where nothing changes, the area is the polygons' own to rounding, whatever the cells.
  const std::vector<GroundPolygon> parts{{{1500, 0}, {1500, 4500}, {10000, 15000}, {10000, 0}},
                                         {{10000, 0}, {10000, 15000}, {25000, 15000}, {25000, 0}}};
  const auto measured = measure_region(parts, [](const glm::dvec2&) { return std::uint8_t(1); });
  EXPECT_NEAR(measured.area_mm2 * 1e-6, 307.875, 1e-9);
  EXPECT_NEAR(measured.area_of_any(1) * 1e-6, 307.875, 1e-6);
  EXPECT_EQ(measured.mixed_mm2, 0);
}

TEST(GroundRegion, NothingAndLinesHaveNoArea) {
  EXPECT_EQ(measure_region({}, [](const glm::dvec2&) { return std::uint8_t(1); }).area_mm2, 0);
  const std::vector<GroundPolygon> line{{{0, 0}, {1000, 0}, {500, 0}}};
  EXPECT_EQ(measure_region(line, [](const glm::dvec2&) { return std::uint8_t(1); }).area_of_any(1), 0);
  EXPECT_TRUE(polygon_holds(kSquare[0], {2000, 0}));
  EXPECT_FALSE(polygon_holds(kSquare[0], {2000.1, 0}));
}

}  // namespace
}  // namespace catoptra::optics

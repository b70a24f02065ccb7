// The residual of mode exact, on rays written down by hand.
#include "render/src/exact_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "render/src/lens_rays.h"
#include "render/src/pixel_error.h"

namespace catoptra::render {
namespace {

constexpr double kPixel_arcmin = 6;
constexpr std::size_t kMiddle = 4;

/// 3 x 3 pixels whose rays leave the origin, kPixel_arcmin apart, and meet the plane z = `depth_mm`.
ExactPixels rays_to_wall(double depth_mm, double pixel_arcmin = kPixel_arcmin) {
  ExactPixels exact;
  exact.reset(3, 3);
  for (std::size_t i = 0; i < 9; ++i) {
    const glm::dvec3 direction =
        glm::normalize(glm::dvec3((double(i % 3) - 1) * pixel_arcmin / kArcminPerRad,
                                  (double(i / 3) - 1) * pixel_arcmin / kArcminPerRad, 1));
    exact.frame.optic_id[i] = 0;
    exact.frame.surface[i] = glm::vec3(0);
    exact.frame.direction[i] = glm::vec3(direction);
    exact.frame.position[i] = glm::vec4(glm::vec3(depth_mm / direction.z * direction), 1);
    exact.normal[i] = {0, 0, -1};
  }
  return exact;
}

/// Whether the middle pixel may show the point at `arcmin` beside the ray, on the plane z = `depth_mm`.
bool allowed(const ExactPixels& exact, double arcmin, double depth_mm) {
  Frame shown = exact.frame;
  shown.position[kMiddle] =
      glm::vec4(float(depth_mm * std::tan(arcmin / kArcminPerRad)), 0, float(depth_mm), 1);
  return agrees(exact, shown, kMiddle);
}

TEST(ExactPixels, HalfAPixelIsAllowedWhereItIsMoreThanAnArcminute) {
  const ExactPixels exact = rays_to_wall(2000);
  EXPECT_TRUE(allowed(exact, 0, 2000));
  EXPECT_TRUE(allowed(exact, 2.9, 2000));
  EXPECT_FALSE(allowed(exact, 3.1, 2000));
}

TEST(ExactPixels, AnArcminuteIsAllowedWherePixelsAreSmaller) {
  const ExactPixels exact = rays_to_wall(2000, 0.5);
  EXPECT_TRUE(allowed(exact, 0.99, 2000));
  EXPECT_FALSE(allowed(exact, 1.01, 2000));
}

TEST(ExactPixels, OnTheRayButNotOnTheSurfaceMet) {
  const ExactPixels exact = rays_to_wall(2000);
  // 1 arcmin at 2 m is 0.58 mm.
  EXPECT_TRUE(allowed(exact, 0, 2000.5));
  EXPECT_FALSE(allowed(exact, 0, 2001));  // hidden by what the ray meets
  EXPECT_FALSE(allowed(exact, 0, 1999));  // not there for the ray
}

TEST(ExactPixels, SkyIsNoSurface) {
  ExactPixels exact = rays_to_wall(2000);
  Frame shown = exact.frame;
  shown.position[kMiddle] = {0, 0, 1, 0};
  EXPECT_FALSE(agrees(exact, shown, kMiddle));
  exact.frame.position[kMiddle] = {0, 0, 1, 0};
  EXPECT_TRUE(agrees(exact, shown, kMiddle));
  shown.position[kMiddle] = glm::vec4(glm::normalize(glm::vec3(float(4 / kArcminPerRad), 0, 1)), 0);
  EXPECT_FALSE(agrees(exact, shown, kMiddle));
}

TEST(ExactPixels, OnACausticTheArcminuteCountsAlone) {
  ExactPixels exact = rays_to_wall(2000);
  for (std::size_t i = 0; i < 9; ++i) exact.frame.direction[i] = exact.frame.direction[3 + i % 3];
  EXPECT_TRUE(allowed(exact, 0.9, 2000));
  EXPECT_FALSE(allowed(exact, 1.5, 2000));
}

TEST(ExactPixels, AnotherOpticOrNoneIsWrong) {
  const ExactPixels exact = rays_to_wall(2000);
  Frame shown = exact.frame;
  for (const std::int32_t id : {-1, 1}) {
    shown.optic_id[kMiddle] = id;
    EXPECT_FALSE(agrees(exact, shown, kMiddle));
  }
}

TEST(ExactPixels, ExtremeSamplesAreTheReferenceAndTheEndsOfTheSpectrum) {
  for (const int count : {1, 3, 4, 8}) {
    optics::Optic lens;
    lens.wavelengths = count;
    const auto samples = samples_of(lens);
    const auto extremes = extreme_samples(samples.size());
    ASSERT_EQ(extremes.size(), std::min<std::size_t>(samples.size(), 3));
    EXPECT_EQ(extremes[0], 0u);
    for (const auto& sample : samples) {
      double least = 1e9, most = 0;
      for (const std::size_t k : extremes) {
        least = std::min(least, samples[k].wavelength_nm);
        most = std::max(most, samples[k].wavelength_nm);
      }
      EXPECT_GE(sample.wavelength_nm, least);
      EXPECT_LE(sample.wavelength_nm, most);
    }
  }
}

}  // namespace
}  // namespace catoptra::render

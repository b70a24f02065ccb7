#include "optics/spectrum.h"

#include <gtest/gtest.h>

#include <glm/matrix.hpp>

#include "cad_import/error.h"

namespace catoptra::optics {
namespace {

class SpectralSamples : public ::testing::TestWithParam<int> {};

// Without dispersion every wavelength sees the same colour, so the weights must add up to the identity.
TEST_P(SpectralSamples, LeaveColoursUnchangedWithoutDispersion) {
  const auto samples = spectral_samples(GetParam());
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(GetParam()));
  glm::dmat3 sum(0);
  for (const SpectralSample& sample : samples) sum += sample.weight;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(sum[i][j], i == j ? 1 : 0, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Counts, SpectralSamples, ::testing::Values(1, 3, 4, 8, 16, 31));

TEST(SpectralSamplesOrder, LongWavelengthsAreRedAndShortOnesBlue) {
  const auto samples = spectral_samples(16);
  const auto white = [&](std::size_t i) { return samples[i].weight * glm::dvec3(1); };
  EXPECT_GT(white(2).z, white(2).x);    // about 440 nm
  EXPECT_GT(white(11).x, white(11).z);  // about 627 nm
}

TEST(SpectralSamplesBadInput, TwoWavelengthsAreRefused) {
  EXPECT_THROW((void)spectral_samples(2), Error);
  EXPECT_THROW((void)spectral_samples(0), Error);
}

// CIE 1931 table at its peaks: y(555) = 1.0000, x(600) = 1.0622, z(445) = 1.7826. The fit's own error is
// about 1 %.
TEST(CieMatching, FollowsTheStandardTable) {
  EXPECT_NEAR(cie_matching(555).y, 1.0, 0.015);
  EXPECT_NEAR(cie_matching(600).x, 1.0622, 0.015);
  EXPECT_NEAR(cie_matching(445).z, 1.7826, 0.03);
}

}  // namespace
}  // namespace catoptra::optics

#include "optics/coating.h"

#include <gtest/gtest.h>

#include <map>

namespace catoptra::app {
namespace {

/// First-surface reflectances at 650, 550, 450 nm as printed with the n and k (refractiveindex.info), to
/// 0.001.
TEST(Coating, ReflectanceAgreesWithTheDatabase) {
  const std::map<std::string_view, glm::vec3> published{{"aluminium", {0.906f, 0.915f, 0.922f}},
                                                        {"silver", {0.990f, 0.983f, 0.980f}},
                                                        {"chromium", {0.556f, 0.555f, 0.555f}}};
  ASSERT_EQ(optics::built_in_coatings().size(), published.size());
  for (const optics::Coating& coating : optics::built_in_coatings())
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(coating.reflectance_rgb()[c], published.at(coating.name)[c], 1e-3)
          << coating.name << " channel " << c;
}

}  // namespace
}  // namespace catoptra::app

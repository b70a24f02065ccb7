#include "app/src/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace catoptra::app {
namespace {

const std::vector<std::string> kNames{"translate", "rotate_deg", "scale", "unit"};

TEST(NearestName, FindsOneSlip) {
  EXPECT_EQ(nearest_name("tanslate", kNames), "translate");
  EXPECT_EQ(nearest_name("Scale", kNames), "scale");
  EXPECT_EQ(nearest_name("rotate", kNames), "");  // 4 of 10 letters are missing: more than a third
  EXPECT_EQ(nearest_name("rotate_dgr", kNames), "rotate_deg");
}

TEST(NearestName, NothingNearGivesNoSuggestion) {
  EXPECT_EQ(nearest_name("chromium", kNames), "");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(NearestName, HintListsWhatIsKnown) {
  EXPECT_EQ(hint_for_unknown("unti", kNames), "known: translate, rotate_deg, scale, unit");
  EXPECT_EQ(hint_for_unknown("units", kNames), "did you mean 'unit'?");
  EXPECT_EQ(list_of_names(kNames, 2), "translate, rotate_deg, ... (4 in all)");
}

}  // namespace
}  // namespace catoptra::app

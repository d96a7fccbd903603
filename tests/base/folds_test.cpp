#include "base/folds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt {
namespace {

using testing::ElementsAre;

TEST(Folds, AreOfOneEachAsLongAsTheyMayBe) {
    EXPECT_THAT(folds_of(3, 3), ElementsAre(ElementsAre(0U), ElementsAre(1U), ElementsAre(2U)));
    EXPECT_THAT(folds_of(2, 20), ElementsAre(ElementsAre(0U), ElementsAre(1U)));
    EXPECT_TRUE(folds_of(0, 20).empty());
}

TEST(Folds, OfMoreAreGroupsWithoutNeighbours) {
    EXPECT_THAT(folds_of(7, 3), ElementsAre(ElementsAre(0U, 3U, 6U), ElementsAre(1U, 4U), ElementsAre(2U, 5U)));
}

}  // namespace
}  // namespace flightwatt

#include "base/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt {
namespace {

using testing::ElementsAre;

TEST(Statistics, MomentsOfASample) {
    const std::vector<double> values{2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0};
    EXPECT_DOUBLE_EQ(mean(values), 5.0);
    EXPECT_DOUBLE_EQ(sample_variance(values), 32.0 / 7.0);
    EXPECT_DOUBLE_EQ(sample_sd(values) * sample_sd(values), 32.0 / 7.0);
}

TEST(Statistics, AnIntervalContainsItsEnds) {
    const Interval interval{1.0, 2.0};
    for (const double inside : {1.0, 1.5, 2.0}) EXPECT_TRUE(interval.contains(inside));
    for (const double outside : {0.9, 2.1}) EXPECT_FALSE(interval.contains(outside));
}

TEST(Statistics, TheMedianOfAnEvenNumberIsTheMeanOfTheMiddleTwo) {
    EXPECT_EQ(median({3.0}), 3.0);
    EXPECT_EQ(median({5.0, 1.0, 3.0}), 3.0);
    EXPECT_EQ(median({8.0, 1.0, 2.0, 4.0}), 3.0);
    EXPECT_EQ(median_high({8.0, 1.0, 2.0, 4.0}), 4.0);
    EXPECT_EQ(median_high({5.0, 1.0, 3.0}), 3.0);
}

TEST(Statistics, QuantilesLieOnStraightLinesBetweenSortedValues) {
    const std::vector<double> values{1.0, 2.0, 4.0};
    EXPECT_EQ(quantile(values, 0.0), 1.0);
    EXPECT_EQ(quantile(values, 0.25), 1.5);
    EXPECT_EQ(quantile(values, 0.75), 3.0);
    EXPECT_EQ(quantile(values, 1.0), 4.0);
    EXPECT_EQ(quantile(std::vector<double>{7.0}, 0.5), 7.0);
    EXPECT_EQ(quantile_of({4.0, 1.0, 2.0}, 0.25), 1.5);
}

TEST(Statistics, HalfWidthsAsInAnyTable) {
    EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-12);
    EXPECT_NEAR(normal_half_width(), 1.959964, 1e-6);
    EXPECT_NEAR(student_t_half_width(1.0), 12.7062, 1e-4);
    EXPECT_NEAR(student_t_half_width(2.0), 4.3027, 1e-4);
    EXPECT_NEAR(student_t_half_width(5.0), 2.5706, 1e-4);
    EXPECT_NEAR(student_t_half_width(1e6), normal_half_width(), 1e-4);
    EXPECT_EQ(student_t_half_width(0.3), student_t_half_width(1.0));
}

TEST(Folds, AreOfOneEachAsLongAsTheyMayBe) {
    EXPECT_THAT(make_folds(3, 3), ElementsAre(ElementsAre(0U), ElementsAre(1U), ElementsAre(2U)));
    EXPECT_THAT(make_folds(2, 20), ElementsAre(ElementsAre(0U), ElementsAre(1U)));
    EXPECT_TRUE(make_folds(0, 20).empty());
}

TEST(Folds, OfMoreAreGroupsWithoutNeighbours) {
    EXPECT_THAT(make_folds(7, 3), ElementsAre(ElementsAre(0U, 3U, 6U), ElementsAre(1U, 4U), ElementsAre(2U, 5U)));
}

}  // namespace
}  // namespace flightwatt

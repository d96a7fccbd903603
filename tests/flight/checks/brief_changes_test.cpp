#include "helpers/power_records.h"

#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

/// A change of the power that is repeated each 13 samples.
struct Change {
    std::size_t samples;
    double factor;
    double throttle_percent = 50.0;  ///< at the same time
    double usual_percent = 50.0;
    bool has_throttle = true;
    std::size_t times = 60;
};

bool is_brief(const Change& change) {
    auto record = test::sound_record();
    for (std::size_t i = 190; i < 1010; ++i) {
        const bool changes = i >= 200 && i < 200 + 13 * change.times && (i - 200) % 13 < change.samples;
        record.power_w[i] *= changes ? change.factor : 1.0;
        record.throttle_percent[i] = changes ? change.throttle_percent : change.usual_percent;
    }
    if (!change.has_throttle) record.throttle_percent.clear();
    const auto warnings = test::found_in(std::move(record)).warnings;
    const testing::Matcher<std::string> expected = testing::HasSubstr("power rises or falls for up to 5 samples");
    return testing::Matches(testing::Contains(expected))(warnings);
}

TEST(BriefChanges, AreOfUpToFiveSamplesToLessThanTwoThirdsOrMore) {
    EXPECT_TRUE(is_brief({5, 0.6}));
    EXPECT_FALSE(is_brief({6, 0.6}));
    EXPECT_FALSE(is_brief({5, 0.7}));
    EXPECT_TRUE(is_brief({5, 1.6}));
    EXPECT_FALSE(is_brief({5, 1.5}));
}

TEST(BriefChanges, AreNotThoseOfTheThrottle) {
    EXPECT_TRUE(is_brief({.samples = 3, .factor = 0.6, .throttle_percent = 43.0}));
    EXPECT_FALSE(is_brief({.samples = 3, .factor = 0.6, .throttle_percent = 42.0})) << "less than 0.85 of 50 %";
    EXPECT_TRUE(is_brief({.samples = 3, .factor = 0.6, .throttle_percent = 31.0, .usual_percent = 34.0}));
    EXPECT_FALSE(is_brief({.samples = 3, .factor = 0.6, .throttle_percent = 29.0, .usual_percent = 34.0}));
    EXPECT_TRUE(is_brief({.samples = 3, .factor = 1.6, .throttle_percent = 60.0})) << "50 % / 0.85 + 2 %";
    EXPECT_FALSE(is_brief({.samples = 3, .factor = 1.6, .throttle_percent = 61.0}));
}

TEST(BriefChanges, AreLargerWithoutAThrottle) {
    EXPECT_TRUE(is_brief({.samples = 3, .factor = 0.27, .has_throttle = false}));
    EXPECT_FALSE(is_brief({.samples = 3, .factor = 0.33, .has_throttle = false}));
    EXPECT_TRUE(is_brief({.samples = 1, .factor = 3.5, .has_throttle = false}));
    EXPECT_FALSE(is_brief({.samples = 1, .factor = 3.2, .has_throttle = false}));
}

TEST(BriefChanges, CountFromTwoPercentOfTheEnergyOn) {
    EXPECT_TRUE(is_brief({.samples = 1, .factor = 0.15, .times = 24}));
    EXPECT_FALSE(is_brief({.samples = 1, .factor = 0.15, .times = 23}));
}

}  // namespace
}  // namespace flightwatt::flight

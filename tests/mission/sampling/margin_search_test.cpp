#include "mission/sampling/landing_distribution.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// The margin found, and after how many answers, where answers keep `least_percent` whatever the margin and flights
/// need `needed_percent`, each point of margin being so much of slack.
struct Found {
    double margin_percent = 0.0;
    int rounds = 0;
};

Found find(double least_percent, double needed_percent, double slack_per_margin) {
    constexpr int max_rounds = 40;
    MarginSearch search(0.0);
    Found found;
    for (; found.rounds < max_rounds; ++found.rounds) {
        found.margin_percent = std::max(search.margin_percent(), least_percent);
        const double slack_percent = slack_per_margin * (found.margin_percent - needed_percent);
        if (std::abs(slack_percent) < 1e-4) break;
        search.add_result(slack_percent, 0.0);
    }
    return found;
}

TEST(MarginSearch, FindsTheMarginWhoseFlightsHaveNoSlack) {
    for (const double slack_per_margin : {0.3, 1.0, 2.0}) {
        const auto [margin_percent, rounds] = find(0.0, 12.5, slack_per_margin);
        EXPECT_NEAR(margin_percent, 12.5, 1e-3);
        EXPECT_LE(rounds, 6) << slack_per_margin;
    }
}

}  // namespace
}  // namespace flightwatt::mission

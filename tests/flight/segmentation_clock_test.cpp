#include "flight/segmentation_clock.h"

#include "flight/segmentation.h"
#include "helpers/flown_points.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

TEST(SegmentationClock, GivesTheSameEdgesToALogThatBeginsAWholeNumberOfStepsLater) {
    constexpr double interval_s = 0.125;
    auto whole = test::columns_of(test::sortie(100), interval_s);
    for (std::size_t i = 0; i < whole.time_s.size(); ++i) {
        whole.altitude_m[i] +=
            2.0 * std::sin(1.7 * static_cast<double>(i));  // uneven, so that it matters when one looks
    }
    const auto edges_without = [&](std::ptrdiff_t samples) {
        auto later = whole;
        for (auto* column : {&later.time_s, &later.altitude_m, &later.throttle_percent, &later.power_w}) {
            column->erase(column->begin(), column->begin() + samples);
        }
        std::vector<double> edges;
        const auto phases = segment(test::series_of(later));
        for (const auto& span : phases.sorties.at(0).phases) {
            edges.push_back(span.start.time_s);
            edges.push_back(span.end.time_s);
        }
        return edges;
    };
    const auto all = edges_without(0);
    const auto step = static_cast<std::ptrdiff_t>(segmentation_step_s / interval_s);
    EXPECT_EQ(edges_without(step), all);
    EXPECT_EQ(edges_without(7 * step), all);
    EXPECT_NE(edges_without(step / 2), all);
}

}  // namespace
}  // namespace flightwatt::flight

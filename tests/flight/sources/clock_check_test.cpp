#include "flight/sources/clock_check.h"

#include "base/number.h"
#include "helpers/damaged_logs.h"
#include "helpers/rejected.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::flight {
namespace {

using testing::HasSubstr;

/// The first sample log with the clock set by `by_s` from `from_s` on, once.
std::string with_jump(double from_s, double by_s) {
    return test::damaged_sample([&](test::Words& words) {
        const double time_s = number_or_nan(words[0]);
        if (time_s > from_s) words[0] = fmt::format("{:.3f}", time_s + by_s);
    });
}

TEST(ClockCheck, RefusesAClockThatRunsBackByLessThanAMinute) {
    for (const double by_s : {-8.0, -20.0, -50.0, -59.0}) {
        SCOPED_TRACE(by_s);
        EXPECT_THAT(test::rejected([&] { test::examined(with_jump(300.0, by_s)); }), HasSubstr("its clock runs back"));
    }
}

TEST(ClockCheck, RefusesAStretchThatLiesOverAnother) {
    const auto text = test::damaged_sample([](test::Words& words) {
        const double time_s = number_or_nan(words[0]);
        if (time_s > 300.0 && time_s < 330.0) words[0] = fmt::format("{:.3f}", time_s + 30.0);
    });
    EXPECT_THAT(test::rejected([&] { test::examined(text); }), HasSubstr("its clock runs back"));
}

TEST(ClockCheck, TakesDoubledLinesAndLinesOutOfOrderAsTheyAre) {
    const auto lines = test::lines_of(test::damaged_sample([](test::Words&) {}));
    const auto joined = [](const std::vector<std::string>& parts) {
        std::string text;
        for (const auto& part : parts) text += part;
        return text;
    };
    const auto sound = test::examined(joined(lines));
    std::mt19937 random(5);
    auto shuffled = lines;
    for (std::size_t i = 0; i + 400 < lines.size(); i += 400) {
        std::shuffle(shuffled.begin() + static_cast<std::ptrdiff_t>(i),
                     shuffled.begin() + static_cast<std::ptrdiff_t>(i + 400), random);
    }
    auto far_apart = lines;
    for (std::size_t i = 0; i + 1300 < lines.size(); i += 170) std::swap(far_apart[i], far_apart[i + 500]);
    auto block = lines;
    std::rotate(block.begin() + 5000, block.begin() + 5500, block.begin() + 6000);
    auto doubled = lines;
    doubled.insert(doubled.begin() + 9000, lines.begin() + 8200, lines.begin() + 9000);
    for (const auto& changed : {shuffled, far_apart, block, doubled}) {
        const auto loaded = test::examined(joined(changed));
        EXPECT_NEAR(test::energy_in_flight_wh(loaded), test::energy_in_flight_wh(sound), 1e-6);
        EXPECT_EQ(loaded.warnings, sound.warnings);
    }
}

TEST(ClockCheck, KnowsNothingOfWhatComesLater) {
    const auto text = with_jump(300.0, -20.0);
    const auto series = test::all_series(text, std::nullopt).at(0);
    ASSERT_TRUE(series.clock_restart);
    for (const double until_s : {283.0, 285.0, 290.0, 296.0, 300.0, 400.0}) {
        const auto cut = test::all_series(test::cut_log(text, until_s).before, std::nullopt).at(0);
        EXPECT_EQ(cut.clock_restart, truncate_series(series, until_s).clock_restart) << until_s;
    }
}

}  // namespace
}  // namespace flightwatt::flight

// A live flight that starts at any line of a log, and one whose clock goes back in the air: no crash, and a state that
// names what is missing until there is a prediction. Real logs take part where ../shared is.

#include "helpers/cut_logs.h"
#include "helpers/sample_logs.h"
#include "helpers/watched_logs.h"
#include "live/live_flight.h"
#include "live/live_state.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

constexpr std::size_t lines_of_start = 1500;

/// The messages of a log, one for each line.
std::vector<IncomingMessage> all_messages(const std::filesystem::path& log) {
    std::vector<IncomingMessage> messages;
    for (const auto& line : test::lines_of(read_file(log)))
        if (auto message = parse_message_line(line.substr(0, line.find_last_not_of("\r\n") + 1)))
            messages.push_back(std::move(*message));
    return messages;
}

/// Feeds messages and updates after each second of the log's clock. Checks every state.
void fly(LiveFlight& flight, const std::vector<IncomingMessage>& messages, std::size_t first, std::size_t last,
         const std::string& where) {
    double updated_s = -1e9;
    for (auto i = first; i < std::min(last, messages.size()); ++i) {
        flight.receive(messages[i], 0.0);
        const double now_s = messages[i].time_s.value_or(updated_s);
        if (std::abs(now_s - updated_s) < 1.0) continue;
        updated_s = now_s;
        const auto state = flight.update();
        ASSERT_TRUE(state.prediction || !state.no_prediction_reason.empty()) << where << ", line " << i;
        if (!state.prediction) continue;
        ASSERT_TRUE(std::isfinite(state.prediction->remaining_energy.energy_wh)) << where << ", line " << i;
    }
}

LiveFlight flight_of(const std::filesystem::path& log) {
    auto options = test::options_of(log);
    return {std::move(options), test::wing_basis(100.0), nullptr};
}

std::vector<std::filesystem::path> logs_with_definitions() {
    auto logs = test::all_logs();
    std::erase_if(logs, [](const auto& log) {
        return !std::filesystem::exists(std::filesystem::path(log).replace_extension(".log"));
    });
    return logs;
}

/// Starts at every `stride`th line of every log. Returns how many there were.
std::size_t start_everywhere(std::size_t stride) {
    std::size_t starts = 0;
    for (const auto& log : logs_with_definitions()) {
        const auto messages = all_messages(log);
        for (std::size_t first = 0; first < messages.size(); first += stride, ++starts) {
            auto flight = flight_of(log);
            fly(flight, messages, first, first + lines_of_start, log.filename().string());
            flight.end();
            flight.update();
        }
    }
    return starts;
}

/// Sets the clock back by 65 to 600 s in the air, as a restart of the log does. Returns how often.
std::size_t set_clocks_back(std::size_t stride) {
    std::mt19937 random(5);
    std::size_t restarts = 0;
    for (const auto& log : logs_with_definitions()) {
        const auto messages = all_messages(log);
        for (auto last = messages.size() / 4; last < messages.size(); last += stride, ++restarts) {
            constexpr double backs_s[] = {65.0, 100.0, 200.0, 340.0, 600.0};
            const double again_s = messages[last].time_s.value() - backs_s[random() % std::size(backs_s)];
            const auto again =
                std::ranges::find_if(messages, [&](const auto& message) { return message.time_s.value() >= again_s; });
            const auto next = static_cast<std::size_t>(again - messages.begin());
            auto flight = flight_of(log);
            const auto where = log.filename().string() + " with its clock set back";
            fly(flight, messages, last - std::min(last, lines_of_start), last, where);
            fly(flight, messages, next, next + lines_of_start, where);
        }
    }
    return restarts;
}

TEST(StartsInFlight, NameWhatIsMissing) { EXPECT_GT(start_everywhere(2000), 10U); }

TEST(StartsInFlight, SurviveClocksSetBack) { EXPECT_GT(set_clocks_back(4000), 5U); }

TEST(StartsInFlightStudy, NameWhatIsMissing) { EXPECT_GT(start_everywhere(100), 200U); }

TEST(StartsInFlightStudy, SurviveClocksSetBack) { EXPECT_GT(set_clocks_back(200), 100U); }

/// One power and two altitudes above the ground of the flight plan: a height, but no duration.
TEST(StartsInFlight, WaitAfterThreeLines) {
    auto options = LiveOptions{};
    options.configuration = telemetry::LogConfiguration{};
    options.configuration->aircraft["20"].ground_altitude_m = 185.0;
    LiveFlight flight(std::move(options), test::wing_basis(), nullptr);
    for (const auto* line : {"100.0 20 ENERGY 94 10.9 5.2 56.6 0.86 9.8", "100.2 20 ESTIMATOR 289.5 0.5",
                             "100.7 20 ESTIMATOR 289.8 0.74"}) {
        flight.receive(parse_message_line(line).value(), 0.0);
        EXPECT_FALSE(flight.update().no_prediction_reason.empty());
    }
}

/// The first sample log until `until_s`, then from `again_s` on with its clock four minutes back.
LiveState restarted(double until_s, double again_s, double last_s) {
    const auto log = test::sample(1);
    auto flight = flight_of(log);
    const auto feed = [&](double from_s, double to_s, double back_s) {
        double updated_s = from_s;
        for (auto message : test::messages_of(log, to_s, from_s)) {
            const double time_s = message.time_s.value();
            message.time_s = time_s - back_s;
            flight.receive(message, 0.0);
            if (time_s - updated_s < 1.0) continue;
            updated_s = time_s;
            flight.update();
        }
    };
    feed(0.0, until_s, 0.0);
    feed(again_s, last_s, 240.0);
    return flight.update();
}

TEST(StartsInFlight, CountFromARestartInTheAir) {
    const auto again = restarted(300.0, 310.0, 400.0);
    const auto whole = test::predicted(test::sample(1), 400.0, test::wing_basis(100.0));
    ASSERT_EQ(again.restarts, 1U);
    ASSERT_TRUE(again.began_in_air);
    ASSERT_TRUE(again.energy_wh);
    EXPECT_LT(*again.energy_wh, 0.5 * whole.flown.energy_wh) << "of 90 s";
    ASSERT_TRUE(again.battery);
    EXPECT_FALSE(again.battery->soc_percent) << "the counter may have restarted, too";
    EXPECT_TRUE(again.battery->soc_by_voltage_percent);
}

TEST(StartsInFlight, PredictNothingWhileThePowerRecordIsRejected) {
    const auto log = test::sample(1);
    const auto state_at = [&](double by) {
        auto flight = flight_of(log);
        double counted_wh = 0.0;
        for (auto message : test::messages_of(log, 300.0)) {
            if (message.text.starts_with("7 ENERGY ")) {
                const auto last = message.text.rfind(' ');
                counted_wh = std::stod(message.text.substr(last + 1));
                message.text = fmt::format("{} {:.5f}", message.text.substr(0, last), by * counted_wh);
            }
            flight.receive(message, 0.0);
        }
        return flight.update();
    };
    EXPECT_TRUE(state_at(1.08).prediction);
    const auto rejected = state_at(1.2);
    EXPECT_FALSE(rejected.prediction);
    EXPECT_THAT(rejected.no_prediction_reason, testing::HasSubstr("away from the on-board energy counter"));
}

}  // namespace
}  // namespace flightwatt::live

#include "base/atomic_file.h"
#include "battery/battery_toml.h"
#include "helpers/mavlink_packets.h"
#include "helpers/sample_logs.h"
#include "helpers/test_paths.h"
#include "live/live_flight.h"
#include "live/live_state.h"
#include "live/prediction.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"
#include "telemetry/link_encoder.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <flightwatt/predictor.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

using testing::HasSubstr;

std::string source(const std::string& file) { return (test::source_dir() / file).string(); }

PredictorSetup wing_setup() {
    PredictorSetup setup;
    setup.model_file = source("fits/mechanical/synthetic-wing.toml");
    setup.remaining_s = 300.0;
    setup.battery_file = source("fits/battery/synthetic-3s.toml");
    setup.definitions_file = test::sample(1, ".log").string();
    return setup;
}

PredictorSetup wing_setup_of_samples() {
    auto setup = wing_setup();
    setup.definitions_file.clear();
    setup.input = PredictorInput::samples;
    return setup;
}

std::vector<std::string> lines_until(double until_s) {
    std::vector<std::string> lines;
    std::istringstream text(read_file(test::sample(1)));
    for (std::string line; std::getline(text, line);)
        if (std::stod(line) <= until_s) lines.push_back(line);
    return lines;
}

/// What the watch knows after the same lines.
LiveState watched(const std::vector<std::string>& lines, std::optional<PredictionInput> basis,
                  std::unique_ptr<LiveSchedule> schedule = nullptr) {
    LiveOptions options;
    options.configuration = telemetry::read_log_configuration(test::sample(1, ".log"));
    LiveFlight flight(std::move(options), std::move(basis), std::move(schedule));
    for (const auto& line : lines) flight.receive(parse_message_line(line).value(), 0.0);
    flight.end();
    return flight.update();
}

PredictionInput wing_basis() {
    const auto setup = wing_setup();
    auto basis = input_from_model(mechanical::read_mechanical_model(setup.model_file), setup.model_file, 300.0);
    basis.battery = battery::read_battery(setup.battery_file);
    return basis;
}

void expect_same(const PredictorState& outlook, const LiveState& state) {
    ASSERT_TRUE(state.prediction);
    ASSERT_TRUE(outlook.landing) << outlook.waits_for;
    const auto& landing = *outlook.landing;
    EXPECT_EQ(outlook.time_s, state.time_s);
    EXPECT_EQ(outlook.phase, FlightPhase::cruise);
    EXPECT_EQ(outlook.energy_wh, state.energy_wh);
    EXPECT_EQ(landing.energy_wh, state.prediction->remaining_energy.energy_wh);
    EXPECT_EQ(landing.energy_low_wh, state.prediction->interval.low);
    EXPECT_EQ(landing.energy_high_wh, state.prediction->interval.high);
    EXPECT_EQ(landing.soc_percent, state.prediction->battery->expected.soc_percent);
    EXPECT_EQ(landing.worst_soc_percent, state.prediction->battery->worst.soc_percent);
    EXPECT_EQ(landing.chance_below_reserve, state.battery->probability_below_reserve);
    EXPECT_EQ(landing.reserve_in_s, state.battery->time_to_reserve_s);
    EXPECT_EQ(outlook.rows, state.rows);
}

TEST(Predictor, SaysOfLinesWhatTheWatchSays) {
    const auto lines = lines_until(400.0);
    const auto made = make_predictor(wing_setup());
    ASSERT_TRUE(made.predictor) << made.error;
    for (const auto& line : lines) EXPECT_TRUE(made.predictor->push_line(line));
    expect_same(made.predictor->end(), watched(lines, wing_basis()));
    EXPECT_EQ(made.predictor->state().unusable, 0U);
}

TEST(Predictor, StartsInFlightAsTheWatchDoes) {
    const auto lines = lines_until(900.0);
    for (std::size_t first = 500; first < lines.size(); first += 3000) {
        const auto made = make_predictor(wing_setup());
        ASSERT_TRUE(made.predictor) << made.error;
        for (auto i = first; i < std::min(first + 1500, lines.size()); ++i) {
            made.predictor->push_line(lines[i]);
            if (i % 100 != 0) continue;
            const auto& now = made.predictor->update();
            ASSERT_TRUE(now.landing || !now.waits_for.empty()) << first;
            ASSERT_TRUE(now.failure.empty()) << now.failure;
        }
    }
}

TEST(Predictor, SaysOfAMissionWhatTheWatchSays) {
    auto setup = wing_setup();
    setup.model_file.clear();
    setup.battery_file.clear();
    setup.mission_file = source("missions/synthetic/thevenin-plan.toml");
    const auto lines = lines_until(300.0);
    const auto made = make_predictor(setup);
    ASSERT_TRUE(made.predictor) << made.error;
    for (const auto& line : lines) made.predictor->push_line(line);
    mission::MissionReadOptions reading;
    reading.allow_unplanned = true;
    const auto mission = mission::read_mission(setup.mission_file, reading);
    auto basis = input_from_mission(setup_of(mission), setup.mission_file);
    basis.remaining_s = 300.0;
    const auto state = watched(lines, basis, std::make_unique<LiveSchedule>(mission, false));
    const auto& outlook = made.predictor->end();
    EXPECT_EQ(outlook.landing.has_value(), state.prediction.has_value());
    ASSERT_TRUE(state.decision);
    ASSERT_TRUE(outlook.decision);
    EXPECT_EQ(outlook.decision->utility_per_s, state.decision->utility_per_s);
    EXPECT_EQ(outlook.decision->rest_utility, state.decision->remaining_utility_per_s);
    const auto& components = setup_of(mission).compute.components;
    const auto& runs = outlook.components;
    ASSERT_EQ(runs.size(), components.size());
    std::size_t running = 0;
    for (std::size_t c = 0; c < runs.size(); ++c) {
        EXPECT_EQ(runs[c].name, components[c].name);
        running += runs[c].runs ? 1 : 0;
    }
    EXPECT_EQ(running, state.decision->run.size());
}

/// Frames carry floats of seven digits, and card time is of no account: the numbers are near.
TEST(Predictor, TakesFramesOfALink) {
    const auto dictionary = telemetry::read_message_dictionary(test::sample(1, ".log"));
    telemetry::LinkEncoder encoder(dictionary, telemetry::LinkVersion::v2);
    const auto made = make_predictor(wing_setup());
    ASSERT_TRUE(made.predictor) << made.error;
    const auto lines = lines_until(400.0);
    for (const auto& line : lines) {
        const auto message = parse_message_line(line).value();
        std::string frames;
        if (!encoder.append_frame(message.text, frames).empty()) continue;  // of the ground
        EXPECT_TRUE(made.predictor->push_frames(message.time_s.value(), frames));
    }
    const auto& outlook = made.predictor->end();
    const auto state = watched(lines, wing_basis());
    ASSERT_TRUE(outlook.landing) << outlook.waits_for;
    EXPECT_NEAR(outlook.landing->energy_wh, state.prediction->remaining_energy.energy_wh, 1e-3);
}

TEST(Predictor, SaysOfSamplesWhatItSaysOfTheirMessages) {
    const auto made = make_predictor(wing_setup_of_samples());
    ASSERT_TRUE(made.predictor) << made.error;
    std::vector<std::string> kept;
    for (const auto& line : lines_until(400.0)) {
        std::istringstream words(line);
        Sample sample;
        std::string sender;
        std::string name;
        words >> sample.time_s >> sender >> name;
        if (name == "ENERGY") {
            words >> sample.throttle_percent >> sample.voltage_v >> sample.current_a >> sample.power_w >>
                sample.charge_ah;
        } else if (name == "ESTIMATOR") {
            words >> sample.altitude_m >> sample.climb_m_per_s;
        } else {
            continue;
        }
        EXPECT_TRUE(made.predictor->push_sample(sample));
        kept.push_back(line);
    }
    const auto& outlook = made.predictor->end();
    const auto state = watched(kept, wing_basis());
    ASSERT_TRUE(outlook.landing) << outlook.waits_for;
    EXPECT_NEAR(outlook.landing->energy_wh, state.prediction->remaining_energy.energy_wh, 1e-9);
    EXPECT_NEAR(outlook.landing->soc_percent.value(), state.prediction->battery->expected.soc_percent, 1e-9);
}

/// Power is voltage times current where it is not known; what is never known is no error.
TEST(Predictor, TakesSamplesThatLackSomething) {
    const auto made = make_predictor(wing_setup_of_samples());
    ASSERT_TRUE(made.predictor) << made.error;
    for (int i = 0; i <= 300; ++i) {
        const double time_s = i;
        const double height_m = std::clamp(3.0 * (time_s - 60.0), 0.0, 90.0);
        Sample sample{.time_s = time_s, .voltage_v = 12.0, .current_a = height_m > 0.0 ? 2.0 + 0.1 * (i % 3) : 0.03};
        sample.altitude_m = 200.0 + height_m;
        ASSERT_TRUE(made.predictor->push_sample(sample));
    }
    const auto& outlook = made.predictor->update();
    EXPECT_EQ(outlook.phase, FlightPhase::cruise);
    ASSERT_TRUE(outlook.power_w);
    EXPECT_NEAR(*outlook.power_w, 24.0, 1e-9);
    EXPECT_TRUE(outlook.landing) << outlook.waits_for;
}

TEST(Predictor, SaysWhatIsWrongInsteadOfThrowing) {
    auto setup = wing_setup();
    setup.model_file = "no-such-model.toml";
    EXPECT_THAT(make_predictor(setup).error, HasSubstr("no-such-model.toml"));
    setup = wing_setup();
    setup.remaining_s.reset();
    EXPECT_THAT(make_predictor(setup).error, HasSubstr("remaining_s"));
    setup.remaining_s = -1.0;
    EXPECT_THAT(make_predictor(setup).error, HasSubstr("remaining_s"));
    setup = wing_setup();
    setup.initial_soc_percent = 101.0;
    EXPECT_THAT(make_predictor(setup).error, HasSubstr("initial_soc_percent"));
    setup = wing_setup();
    setup.replan = true;
    EXPECT_THAT(make_predictor(setup).error, HasSubstr("mission_file"));
    setup.mission_file = source("missions/synthetic/survey-path.toml");
    EXPECT_THAT(make_predictor(setup).error, HasSubstr("exclude"));
    EXPECT_THAT(make_predictor({}).error, HasSubstr("no model"));
    EXPECT_EQ(make_predictor(setup).predictor, nullptr);
}

TEST(Predictor, IncludesTheStandardLibraryAlone) {
    std::istringstream header(read_file(test::source_dir() / "include/flightwatt/predictor.h"));
    for (std::string line; std::getline(header, line);) {
        if (!line.starts_with("#include")) continue;
        EXPECT_THAT(line, HasSubstr("<"));
    }
}

TEST(Predictor, CountsWhatItDoesNotTake) {
    const auto made = make_predictor(wing_setup());
    ASSERT_TRUE(made.predictor) << made.error;
    auto& predictor = *made.predictor;
    EXPECT_FALSE(predictor.push_sample({.time_s = 1.0, .voltage_v = 12.0}));  // it takes messages
    EXPECT_FALSE(predictor.push_message(std::nan(""), "7 ENERGY 0 12 0 0 0 0"));
    EXPECT_TRUE(predictor.push_line("not a message"));
    EXPECT_TRUE(predictor.push_message(9.0, "7 ENERGY 0 12 0 0 0 0"));
    EXPECT_EQ(predictor.update().dropped, 2U);
    EXPECT_EQ(predictor.state().unusable, 1U);
    EXPECT_EQ(predictor.state().rows, 1U);
}

TEST(Predictor, TakesPacketsOfMavlink) {
    auto setup = wing_setup();
    setup.input = PredictorInput::mavlink;
    EXPECT_THAT(make_predictor(setup).error, HasSubstr("MAVLink's are known"));
    setup.definitions_file.clear();
    const auto made = make_predictor(setup);
    ASSERT_TRUE(made.predictor) << made.error;
    auto& predictor = *made.predictor;
    test::MavlinkSender vehicle;
    double drawn_wh = 0.0;
    for (int i = 0; i < 1200; ++i) {
        const double time_s = 0.1 * i;
        const bool flies = time_s >= 10.0;
        const auto bytes = vehicle.heartbeat(1) + vehicle.status(11'800, flies ? (i % 2 == 0 ? 190 : 210) : 5) +
                           vehicle.position(time_s, flies ? std::min(4.0 * (time_s - 10.0), 60.0) : 0.0);
        EXPECT_TRUE(predictor.push_frames(time_s, bytes));
        if (flies) drawn_wh += 0.1 * 11.8 * 2.0 / 3600.0;
    }
    EXPECT_FALSE(predictor.push_line("1 20 PING")) << "lines are another kind of input";
    const auto& state = predictor.update();
    EXPECT_EQ(state.phase, FlightPhase::cruise);
    EXPECT_NEAR(state.energy_wh.value_or(0.0), drawn_wh, 0.02 * drawn_wh);
    EXPECT_TRUE(state.landing) << state.waits_for;
}

}  // namespace
}  // namespace flightwatt::live

#pragma once

#include "base/atomic_file.h"
#include "battery/battery_toml.h"
#include "flight/load_flight.h"
#include "flight/select.h"
#include "helpers/flight_progress.h"
#include "helpers/test_paths.h"
#include "live/live_flight.h"

#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

/// Logs through the live watch.
namespace flightwatt::test {

inline live::PredictionInput wing_basis(double remaining_s = 300.0) {
    live::PredictionInput basis;
    basis.model = mechanical::read_mechanical_model(source_dir() / "fits/mechanical/synthetic-wing.toml");
    basis.takeoff_s = basis.model.phases[flight::Phase::takeoff].duration_s;
    basis.landing_s = basis.model.phases[flight::Phase::landing].duration_s;
    basis.remaining_s = remaining_s;
    basis.battery = battery::read_battery(source_dir() / "fits/battery/synthetic-3s.toml");
    basis.initial_soc_percent = 90.0;
    return basis;
}

/// The messages of a log until a time.
inline std::vector<live::IncomingMessage> messages_of(const std::filesystem::path& log, double until_s,
                                                      double from_s = 0.0) {
    std::vector<live::IncomingMessage> messages;
    std::istringstream text(read_file(log));
    for (std::string line; std::getline(text, line);) {
        auto message = live::parse_message_line(line);
        if (message && message->time_s >= from_s && message->time_s <= until_s) messages.push_back(std::move(*message));
    }
    return messages;
}

inline live::LiveOptions options_of(const std::filesystem::path& log) {
    live::LiveOptions options;
    options.flight = telemetry::flight_name(log);
    auto definitions = log;
    options.configuration = telemetry::read_log_configuration(definitions.replace_extension(".log"));
    return options;
}

inline void receive_all(live::LiveFlight& flight, const std::vector<live::IncomingMessage>& messages) {
    for (const auto& message : messages) flight.receive(message, 0.0);
}

/// What predict states of the log at a moment.
inline live::Prediction predicted(const std::filesystem::path& log, double until_s,
                                  const live::PredictionInput& basis) {
    const auto series = truncate_series(flight::read_flight(log), until_s);
    live::Remarks remarks;
    return predict_flight(basis, progress_at(series, until_s), select_tracks(series), remarks);
}

inline void expect_same(const live::Prediction& watched, const live::Prediction& expected) {
    EXPECT_EQ(watched.flown.lift_off_s, expected.flown.lift_off_s);
    EXPECT_EQ(watched.flown.cruise_start_s, expected.flown.cruise_start_s);
    EXPECT_EQ(watched.flown.energy_wh, expected.flown.energy_wh);
    EXPECT_EQ(watched.remaining_energy.energy_wh, expected.remaining_energy.energy_wh);
    EXPECT_EQ(watched.interval.low, expected.interval.low);
    EXPECT_EQ(watched.interval.high, expected.interval.high);
    ASSERT_EQ(watched.battery.has_value(), expected.battery.has_value());
    if (!watched.battery) return;
    EXPECT_EQ(watched.battery->expected.soc_now_percent, expected.battery->expected.soc_now_percent);
    EXPECT_EQ(watched.battery->expected.soc_percent, expected.battery->expected.soc_percent);
    EXPECT_EQ(watched.battery->expected.voltage_v, expected.battery->expected.voltage_v);
    EXPECT_EQ(watched.battery->worst.soc_percent, expected.battery->worst.soc_percent);
}

}  // namespace flightwatt::test

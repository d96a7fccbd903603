#include "live/state/telemetry_store.h"

#include "flight/telemetry_series.h"
#include "helpers/selected_tracks.h"
#include "live/sources.h"
#include "telemetry/log_reader.h"

#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::live {
namespace {

std::string energy_line(double time_s, const std::string& sender = "20") {
    return fmt::format("{} {} ENERGY 60 11.5 2 23 0.5 5.5\n", time_s, sender);
}

void add(TelemetryStore& store, const std::string& lines) {
    std::istringstream text(lines);
    for (std::string line; std::getline(text, line);) {
        const auto message = parse_message_line(line).value();
        store.add(message.time_s.value(), message.text);
    }
}

TEST(TelemetryStore, HoldsAtEachMomentWhatReadingALogThatEndsThereGives) {
    TelemetryStore store("live", std::nullopt);
    std::string text;
    for (int i = 0; i < 20; ++i) {
        const auto lines = energy_line(i) + energy_line(i, "7") + fmt::format("{} 20 ESTIMATOR 100 0.5\n", i);
        text += lines;
        add(store, lines);
        const auto log = telemetry::parse_telemetry(text, "live", std::nullopt, flight::flight_messages());
        for (const auto* sender : {"20", "7"}) EXPECT_EQ(store.series(sender), flight::flight_series(log, sender));
    }
    EXPECT_EQ(store.senders(), (std::vector<std::string>{"20", "7"}));
    EXPECT_EQ(store.rows(), 60U);
    EXPECT_EQ(power_track(store.series("20")).time_s.size(), 20U);
}

TEST(TelemetryStore, CountsWhatItCannotUse) {
    TelemetryStore store("live", std::nullopt);
    store.add(0.0, "rubbish");
    add(store, "1 20 ENERGY 1 2 3\n" + energy_line(2) + "3 20 ENERGY 60 11.5 2 nan 0.5 5.5\n");
    EXPECT_EQ(store.skipped().size(), 3U);
    EXPECT_EQ(store.rows(), 2U);
}

TEST(TelemetryStore, ThinsTheMessageThatHasMostAndWhatComesOfIt) {
    TelemetryStore store("live", std::nullopt);
    for (int i = 0; i < 100; ++i) add(store, energy_line(i) + energy_line(i + 0.5));
    for (int i = 0; i < 50; ++i) add(store, fmt::format("{} 20 ESTIMATOR 100 0.5\n", i));
    store.thin();
    EXPECT_EQ(store.rows(), 150U);
    for (int i = 100; i < 200; ++i) add(store, energy_line(i));
    EXPECT_EQ(store.rows(), 200U);
    EXPECT_EQ(store.thinned().at("ENERGY"), 2U);
    const auto power = power_track(store.series("20"));
    EXPECT_EQ(power.time_s[1] - power.time_s[0], 1.0);
    EXPECT_EQ(power.time_s.back() - power.time_s[power.time_s.size() - 2], 2.0);
}

TEST(TelemetryStore, ThinsEachDeviceByItself) {
    TelemetryStore store("live", std::nullopt);
    for (int i = 0; i < 100; ++i)
        for (int motor = 0; motor < 4; ++motor)
            add(store, fmt::format("{} 20 ESC 1.5 12 18 5000 12 40 {}\n", i, motor));
    const auto tracks_before = store.series("20").tracks.size();
    store.thin();
    EXPECT_EQ(store.rows(), 200U);
    const auto series = store.series("20");
    EXPECT_EQ(series.tracks.size(), tracks_before);
    for (const auto& track : series.tracks) EXPECT_EQ(track.time_s.size(), 50U) << track.device;
}

TEST(TelemetryStore, DropsFromItsBeginningAndOtherSenders) {
    TelemetryStore store("live", std::nullopt);
    for (int i = 0; i < 10; ++i) add(store, energy_line(i) + energy_line(i, "7"));
    store.drop_before(6.0);
    EXPECT_EQ(store.rows(), 8U);
    store.keep_only("7");
    EXPECT_EQ(store.rows(), 4U);
    add(store, energy_line(11) + energy_line(11, "7"));
    EXPECT_EQ(store.rows(), 5U);
    store.clear();
    EXPECT_EQ(store.rows(), 0U);
}

TEST(TelemetryStore, HoldsFewSenders) {
    TelemetryStore store("live", std::nullopt);
    for (int sender = 0; sender < 20; ++sender) add(store, energy_line(1, std::to_string(sender)));
    EXPECT_EQ(store.rows(), TelemetryStore::max_senders);
    EXPECT_FALSE(store.skipped().empty());
}

}  // namespace
}  // namespace flightwatt::live

#include "batch/flight_record.h"

#include "base/fingerprint.h"
#include "flight/load_flight.h"
#include "helpers/generated_motion.h"
#include "helpers/sample_logs.h"

#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::batch {
namespace {

/// A record with every field away from its default.
FlightRecord full_record() {
    FlightRecord record;
    record.flight = "20_07_03__12_17_45";
    record.log = "logs/20_07_03__12_17_45.data";
    record.fingerprint = "0123456789abcdef";
    record.results = "fedcba9876543210";
    record.accepted = true;
    record.aircraft_id = "20";
    record.kind = "fixedwing";
    record.pack_voltage_v = 12.4;
    record.cruise_power_w = 41.5;
    record.payload_kg = 0.25;
    record.power_source = "ENERGY.power";
    record.current_origin = "computed from throttle";
    RecordedPhase takeoff{1, flight::Phase::takeoff, 147.0, 178.1, 0.5, 1.0 / 3.0, false, {}};
    takeoff.statistics.samples = 25;
    takeoff.statistics.mean_power_w = 83.1;
    takeoff.statistics.energy_wh = 0.1;
    takeoff.statistics.gaps = 2;
    takeoff.statistics.max_gap_s = 22.5;
    auto landing = takeoff;
    landing.sortie = 2;
    landing.phase = flight::Phase::landing;
    landing.complete = true;
    landing.statistics.counter_energy_wh = 0.7;
    record.phases = {takeoff, landing};
    auto& measured = record.measured.flights.emplace_back();
    measured.samples.flight = record.flight;
    measured.motion = test::made_up_motions(1, 3, {}, 1).front();
    measured.motion.flight = record.flight;
    record.measured.sorties = {0};
    record.diagnostics = {{Severity::note, "a kind", "a \"quoted\" one"}, {Severity::warning, "another", "another"}};
    return record;
}

TEST(FlightRecord, SurvivesJson) {
    const auto text = to_json_text(full_record());
    const auto read = record_from_json(text);
    ASSERT_TRUE(read);
    EXPECT_EQ(to_json_text(*read), text);
    EXPECT_EQ(read->flight, "20_07_03__12_17_45");
    EXPECT_EQ(read->results, "fedcba9876543210");
    EXPECT_TRUE(read->accepted);
    EXPECT_EQ(read->current_origin, "computed from throttle");
    ASSERT_EQ(read->phases.size(), 2U);
    EXPECT_EQ(read->phases[0].phase, flight::Phase::takeoff);
    EXPECT_EQ(read->phases[0].end_gap_s, 1.0 / 3.0);
    EXPECT_FALSE(read->phases[0].complete);
    EXPECT_EQ(read->phases[0].statistics.counter_energy_wh, std::nullopt);
    EXPECT_EQ(read->phases[1].sortie, 2U);
    EXPECT_EQ(read->phases[1].statistics.counter_energy_wh, 0.7);
    EXPECT_EQ(read->phases[1].statistics.samples, 25U);
    EXPECT_EQ(read->diagnostics, full_record().diagnostics);
    const auto& motion = read->measured.flights.at(0).motion;
    EXPECT_EQ(motion.flight, "20_07_03__12_17_45");
    EXPECT_TRUE(motion.bank_measured);
    const auto bins = test::made_up_motions(1, 3, {}, 1).front().bins;
    ASSERT_EQ(motion.bins.size(), 3U);
    EXPECT_EQ(motion.bins[0].phase, flight::Phase::takeoff);
    EXPECT_EQ(motion.bins[2].values.values, bins[2].values.values);
    EXPECT_EQ(motion.bins[2].power_w, bins[2].power_w);
    EXPECT_EQ(motion.bins[2].samples, 27U);
}

/// As a record would be written that states this: with a seal that is right.
std::string sealed(nlohmann::ordered_json json) {
    json.erase("seal");
    auto text = json.dump(1);
    text.resize(text.size() - std::string_view("\n}").size());
    Fingerprint fingerprint;
    fingerprint.add(text);
    return fmt::format("{},\n \"seal\": \"{}\"\n}}\n", text, fingerprint.hex());
}

TEST(FlightRecord, IsNoneWhereAnythingIsMissingOrWrong) {
    const auto text = to_json_text(full_record());
    EXPECT_FALSE(record_from_json(""));
    EXPECT_FALSE(record_from_json("[]"));
    EXPECT_FALSE(record_from_json(text.substr(0, text.size() / 2)));
    const auto json = nlohmann::ordered_json::parse(text);
    ASSERT_TRUE(record_from_json(sealed(json)));
    EXPECT_FALSE(record_from_json(json.dump(1))) << "its seal is of another text";
    for (const auto& [key, value] : json.items()) {
        if (key == "seal") continue;
        auto lacking = json;
        lacking.erase(key);
        EXPECT_FALSE(record_from_json(sealed(lacking))) << key;
        auto wrong = json;
        wrong[key] = value.is_array() ? nlohmann::json("x") : nlohmann::json::array({1});
        EXPECT_FALSE(record_from_json(sealed(wrong))) << key;
    }
    auto other_phase = json;
    other_phase["phases"][0]["phase"] = "taxi";
    EXPECT_FALSE(record_from_json(sealed(other_phase)));
}

TEST(FlightRecord, IsNoneWhereACountIsNoWholeNumber) {
    const auto json = nlohmann::ordered_json::parse(to_json_text(full_record()));
    for (const double number : {2.85192e19, -1.0, 0.5, 1e300}) {
        for (const auto* place : {"/phases/0/samples", "/content/fingerprint", "/phases/0/sortie",
                                  "/measured/flights/0/motion/bins/0/samples"}) {
            auto wrong = json;
            wrong[nlohmann::ordered_json::json_pointer(place)] = number;
            EXPECT_FALSE(record_from_json(sealed(wrong))) << place << " " << number;
        }
    }
}

TEST(FlightRecord, HoldsNamesThatAreNotUtf8) {
    auto record = full_record();
    record.flight = "caf\xE9";
    const auto read = record_from_json(to_json_text(record));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->flight, "caf\xEF\xBF\xBD");
}

TEST(FlightRecord, HoldsWhatAFitTakes) {
    const auto loaded = flight::load_flight(test::sample(1));
    const auto record = record_of(loaded);
    EXPECT_TRUE(record.accepted);
    EXPECT_EQ(record.flight, "opterra_synthetic_01");
    EXPECT_EQ(record.aircraft_id, "7");
    const auto measured = mechanical::extract_flights(loaded);
    const auto back = record_from_json(to_json_text(record)).value().measured;
    ASSERT_EQ(back.flights.size(), 1U);
    EXPECT_EQ(back.sorties, measured.sorties);
    for (const auto phase : flight::all_phases) {
        const auto& a = measured.flights[0].samples.phases[phase].value();
        const auto& b = back.flights[0].samples.phases[phase].value();
        EXPECT_EQ(a.flight, b.flight);
        EXPECT_EQ(a.duration_s, b.duration_s);
        EXPECT_EQ(a.start_s, b.start_s);
        EXPECT_EQ(a.tau, b.tau);
        EXPECT_EQ(a.power_w, b.power_w);
        EXPECT_EQ(measured.flights[0].energy_wh[phase], back.flights[0].energy_wh[phase]);
        EXPECT_EQ(measured.flights[0].counter_energy_wh[phase], back.flights[0].counter_energy_wh[phase]);
    }
}

}  // namespace
}  // namespace flightwatt::batch

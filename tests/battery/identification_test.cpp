// Batteries identified from flights: whether the intervals hold the truth, and how the voltage is foretold.

#include "battery/identification.h"

#include "base/error.h"
#include "battery/battery_toml.h"
#include "flight/load_flight.h"
#include "helpers/battery_coverage.h"
#include "helpers/rejected.h"
#include "helpers/synthetic_discharge.h"

#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace flightwatt::battery {
namespace {

using test::known_pack;
using test::rejected;
using test::synthetic_discharge;
using test::SyntheticDischarge;

constexpr std::size_t all_seeds = 20;
constexpr std::size_t enough_seeds = 18;

/// In how many of seeds 1..20 each parameter's interval holds the truth. A seed is `flights` flights.
std::map<std::string, std::size_t> held(const Battery& pack, const SyntheticDischarge& settings, std::size_t flights) {
    std::map<std::string, std::size_t> counts;
    for (std::size_t seed = 1; seed <= all_seeds; ++seed) {
        std::vector<DischargeRecord> records;
        for (std::size_t f = 0; f < flights; ++f) {
            auto flown = settings;
            flown.duration_s -= 150.0 * static_cast<double>(f);
            records.push_back(test::discharge_record(synthetic_discharge(pack, flown, seed + 1000 * f)));
        }
        IdentificationOptions options;
        options.capacity_ah = pack.capacity_ah;
        const auto found = identify_battery(records, options);
        const auto count = [&](const std::string& name, double truth, const Interval& interval) {
            counts[name] += truth >= interval.low && truth <= interval.high ? 1 : 0;
        };
        count("resistance", pack.resistance_ohm, found.errors.resistance_ohm);
        count("rc_resistance", pack.thevenin->rc_resistance_ohm, found.errors.rc_resistance_ohm);
        count("rc_time_constant", pack.thevenin->rc_time_constant_s, found.errors.rc_time_constant_s);
        const auto& curve = found.battery.thevenin->open_circuit;
        const auto& error_v = found.battery.intervals.open_circuit_standard_error_v;
        const std::size_t knots[] = {curve.soc_percent.size() - 1,
                                     curve.soc_percent.size() - 1 - found.fit.knots_ah.size() / 2,
                                     curve.soc_percent.size() - found.fit.knots_ah.size()};
        for (std::size_t k = 0; k < 3; ++k) {
            const double truth_v = open_circuit_voltage_v(pack, curve.soc_percent[knots[k]]);
            const double half_v = 1.96 * error_v[knots[k]];
            count(fmt::format("open_circuit_{}", std::array{"full", "middle", "last"}.at(k)), truth_v,
                  {curve.voltage_v[knots[k]] - half_v, curve.voltage_v[knots[k]] + half_v});
        }
    }
    for (const auto& [name, count] : counts) {
        fmt::print("{} flights: {} inside its interval in {} of {}\n", flights, name, count, all_seeds);
    }
    return counts;
}

TEST(Identification, IntervalsHoldTheTruthOfAFlight) {
    for (const auto& [name, count] : held(known_pack(), {}, 1)) EXPECT_GE(count, enough_seeds) << name;
}

TEST(Identification, IntervalsHoldTheTruthOfThreeFlights) {
    for (const auto& [name, count] : held(known_pack(), {}, 3)) EXPECT_GE(count, enough_seeds) << name;
}

TEST(Identification, IntervalsHoldTheTruthBehindACoarseSensor) {
    SyntheticDischarge coarse;
    coarse.voltage_step_v = 0.1;
    coarse.voltage_noise_v = 0.02;
    coarse.current_step_a = 0.1;
    for (const auto& [name, count] : held(known_pack(), coarse, 2)) EXPECT_GE(count, enough_seeds) << name;
}

TEST(Identification, FindsItselfWithoutNoise) {
    SyntheticDischarge clean;
    clean.voltage_noise_v = clean.current_noise_a = clean.lost_fraction = 0.0;
    clean.voltage_step_v = clean.current_step_a = 1e-9;
    auto pack = known_pack();
    pack.thevenin->open_circuit = {{0.0, 100.0}, {10.2, 12.4}};
    const std::vector records{test::discharge_record(synthetic_discharge(pack, clean, 3))};
    const auto found = identify_battery(records, {2.4, 3, "clean"});
    EXPECT_NEAR(found.fit.resistance_ohm, 0.08, 1e-4);
    EXPECT_NEAR(found.fit.rc_resistance_ohm, 0.05, 2e-4);
    EXPECT_NEAR(found.fit.rc_time_constant_s, 35.0, 0.2);
    EXPECT_LT(found.fit.rms_v, 1e-3);
    EXPECT_EQ(found.battery.name, "clean");
    EXPECT_EQ(found.battery.capacity_ah, 2.4);
    // What is written is read again as the same battery.
    const auto file = test::write_text(test::scratch_dir() / "b.toml", to_toml(found.battery));
    const auto again = read_battery(file);
    EXPECT_EQ(to_toml(again), to_toml(found.battery));
}

TEST(Identification, FindsOneResistanceWhereTheVoltageLags) {
    auto pack = known_pack();
    pack.resistance_ohm = -0.01;  // a sensor that lags hides the series resistance
    pack.thevenin->rc_resistance_ohm = 0.1;
    pack.thevenin->rc_time_constant_s = 2.5;
    SyntheticDischarge noisy;
    noisy.voltage_noise_v = 0.05;
    const auto found =
        identify_battery(std::vector{test::discharge_record(synthetic_discharge(pack, noisy, 1))}, {2.4, 3, ""});
    EXPECT_EQ(found.fit.rc_resistance_ohm, 0.0);
    EXPECT_NEAR(found.fit.resistance_ohm, 0.08, 0.02);
}

TEST(Identification, AlignsFlightsByTheirVoltage) {
    SyntheticDischarge late;
    late.initial_charge_ah = 0.4;
    const std::vector records{test::discharge_record(synthetic_discharge(known_pack(), {}, 1)),
                              test::discharge_record(synthetic_discharge(known_pack(), late, 2))};
    const auto found = identify_battery(records, {2.4, {}, ""});
    EXPECT_EQ(found.flights[0].initial_charge_interval_ah.low, 0.0);
    EXPECT_NEAR(found.flights[1].initial_depletion_ah - found.flights[0].initial_depletion_ah, 0.4, 0.02);
    EXPECT_LT(found.flights[1].initial_charge_interval_ah.low, 0.4);
    EXPECT_GT(found.flights[1].initial_charge_interval_ah.high, 0.4);
    EXPECT_NEAR(found.fit.knots_ah.back(), 0.4 + found.flights[1].drawn_ah, 0.03);
    EXPECT_LT(found.fit.rms_v, 0.015);
    std::vector<std::size_t> done;
    const auto checks =
        leave_one_out(records, {2.4, {}, ""}, [&](std::size_t so_many, std::size_t) { done.push_back(so_many); });
    EXPECT_EQ(done, (std::vector<std::size_t>{1, 2}));
    ASSERT_EQ(checks.size(), 2U);
    EXPECT_EQ(checks[0].flight, "synthetic_1");
    EXPECT_GT(checks[1].extrapolated_percent, 20.0);  // its end was never flown before
}

/// Packs that begin at 40 to 100 %: capacity and initial charge are within their intervals.
TEST(Identification, IntervalsHoldInitialChargeAndCapacity) {
    for (const auto curve : {test::PackCurve::known, test::PackCurve::polymer}) {
        const bool full = curve == test::PackCurve::polymer;
        const auto coverage = test::battery_coverage({curve, full ? 2U : 3U, full, false, 0.0, 0.0}, 1, all_seeds);
        fmt::print("{}, {}: capacity {}, all initial charges {} of {}\n", to_string(curve),
                   full ? "one full" : "none full", coverage.capacities_held, coverage.all_initial_charges_held,
                   coverage.packs);
        EXPECT_EQ(coverage.without_answer, 0U);
        EXPECT_GE(coverage.capacities_held, enough_seeds);
        EXPECT_GE(coverage.all_initial_charges_held, enough_seeds);
    }
}

TEST(Identification, SaysThatOneFlightDoesNotTellCapacityAndInitialCharge) {
    SyntheticDischarge late;
    late.initial_charge_ah = 1.2;  // half
    late.duration_s = 900.0;
    const std::vector records{test::discharge_record(synthetic_discharge(known_pack(), late, 5))};
    const auto found = identify_battery(records, {});
    ASSERT_TRUE(found.capacity.interval_ah);
    EXPECT_GT(found.capacity.interval_ah->high, 2.0 * found.capacity.interval_ah->low);
    const auto& missing = found.flights[0].initial_charge_interval_ah;
    EXPECT_GT(missing.high, 2.0 * missing.low);
}

/// Three flights of the known pack of 2.4 Ah; the first leaves little.
std::vector<DischargeRecord> flights_of_known_pack() {
    std::vector<DischargeRecord> records;
    for (const std::uint64_t seed : {1, 2, 3}) {
        SyntheticDischarge settings;
        settings.duration_s = 2600.0 - 400.0 * static_cast<double>(seed);
        records.push_back(test::discharge_record(synthetic_discharge(known_pack(), settings, seed)));
    }
    return records;
}

TEST(Identification, KeepsWhatTheFlightsIndicateBesideAGivenCapacity) {
    const auto records = flights_of_known_pack();
    const auto own = identify_battery(records, {});
    ASSERT_TRUE(own.battery.flight_estimate);
    EXPECT_EQ(own.battery.flight_estimate->capacity_ah, own.battery.capacity_ah);
    EXPECT_TRUE(own.battery.flight_estimate->open_circuit.soc_percent.empty()) << "it is the pack's own";
    EXPECT_EQ(own.battery.flight_estimate->flights,
              (std::vector<std::string>{"synthetic_1", "synthetic_2", "synthetic_3"}));
    EXPECT_EQ(capacity_warning(own.battery), "");
    EXPECT_EQ(own.battery.cells, 3);
    for (const double given_ah : {2.4, 10.0}) {
        const auto given = identify_battery(records, {given_ah, {}, ""});
        ASSERT_TRUE(given.battery.flight_estimate) << given_ah;
        const auto& estimate = *given.battery.flight_estimate;
        EXPECT_EQ(given.battery.capacity_ah, given_ah);
        EXPECT_EQ(estimate.capacity_ah, own.battery.capacity_ah) << given_ah;
        EXPECT_EQ(estimate.capacity_interval_ah, own.capacity.interval_ah.value()) << given_ah;
        EXPECT_EQ(estimate.open_circuit.voltage_v, own.battery.thevenin->open_circuit.voltage_v) << given_ah;
        EXPECT_EQ(capacity_warning(given.battery).empty(), given_ah == 2.4) << given_ah;
        const auto estimated = estimated_by_flights(given.battery);
        EXPECT_EQ(full_energy_wh(estimated.value_or(own.battery)), full_energy_wh(own.battery)) << given_ah;
    }
}

TEST(Identification, ChecksTheNumberOfCells) {
    const std::vector records{test::discharge_record(synthetic_discharge(known_pack(), {}, 1))};  // rests at 12.36 V
    EXPECT_EQ(identify_battery(records, {2.4, 4, ""}).battery.cells, 4);
    EXPECT_THROW(identify_battery(records, {2.4, 2, ""}), UsageError);
    EXPECT_THROW(identify_battery(records, {2.4, 5, ""}), UsageError);
}

TEST(Identification, HasTheCellsThatTheLogsStateIfTheyArePossible) {
    std::vector records(2, test::discharge_record(synthetic_discharge(known_pack(), {}, 1)));  // rest at 12.36 V
    const auto found = [&] { return identify_battery(records, {2.4, {}, ""}); };
    EXPECT_EQ(found().cells_warning, "");
    records[0].stated_cells = 3;
    EXPECT_EQ(found().cells, 3);
    EXPECT_EQ(found().cells_warning, "");
    records[0].stated_cells = records[1].stated_cells = 2;
    EXPECT_EQ(found().cells, 3);
    EXPECT_EQ(found().cells_warning,
              "the logs state 2 cells, which would rest at 6.18 V each: 3 are assumed; --cells states the number");
    records[1].stated_cells = 3;
    EXPECT_EQ(found().cells_warning, "the logs state 2 and 3 cells: 3 are assumed; --cells states the number");
    EXPECT_EQ(identify_battery(records, {2.4, 3, ""}).cells_warning, "") << "given";
}

TEST(Identification, PrefersStatedCellsToThoseOfAFullPack) {
    auto pack = known_pack();
    for (auto& voltage_v : pack.thevenin->open_circuit.voltage_v) voltage_v *= 4.0;  // 12 cells
    SyntheticDischarge used;
    used.initial_charge_ah = 1.2;
    used.duration_s = 900.0;
    std::vector records{test::discharge_record(synthetic_discharge(pack, used, 1))};
    const auto full = identify_battery(records, {2.4, {}, ""});
    EXPECT_EQ(full.cells, 11);
    records[0].stated_cells = 12;
    const auto found = identify_battery(records, {2.4, {}, ""});
    EXPECT_EQ(found.battery.cells, 12);
    EXPECT_GT(found.flights[0].initial_depletion_ah, full.flights[0].initial_depletion_ah + 0.6) << "not full";
    EXPECT_NE(found.cells_warning.find("the logs state 12 cells, which are used; by"), std::string::npos);
    EXPECT_NE(found.cells_warning.find("they would be 11: --cells states another number"), std::string::npos);
}

TEST(Identification, ForetellsAFlightWithinItsNoise) {
    std::vector<DischargeRecord> records;
    for (const std::uint64_t seed : {1, 2, 3}) {
        records.push_back(test::discharge_record(synthetic_discharge(known_pack(), {}, seed)));
    }
    const double noise_v = std::hypot(SyntheticDischarge{}.voltage_noise_v, 0.006 / std::sqrt(12.0));
    for (const auto& check : leave_one_out(records, {2.4, {}, ""})) {
        EXPECT_LT(check.voltage_rms_v, 1.3 * noise_v) << check.flight;
        EXPECT_GT(check.voltage_rms_v, 0.8 * noise_v) << check.flight;
    }
    EXPECT_TRUE(leave_one_out(std::span(records).first(1), {2.4, {}, ""}).empty());
}

TEST(Identification, SaysWhereNoRcPairIsSeen) {
    auto pack = known_pack();
    pack.thevenin->rc_resistance_ohm = 0.0;
    std::vector<DischargeRecord> records;
    for (const std::uint64_t seed : {1, 2, 3}) {
        records.push_back(test::discharge_record(synthetic_discharge(pack, {}, seed)));
    }
    const auto found = identify_battery(records, {2.4, {}, ""});
    EXPECT_EQ(found.errors.rc_resistance_ohm.low, 0.0);
    EXPECT_LT(found.fit.rc_resistance_ohm, 0.003);
    EXPECT_GE(found.errors.resistance_ohm.high, 0.08);
    EXPECT_LE(found.errors.resistance_ohm.low, 0.08);
}

TEST(Identification, GivesAStraightCurveOneSegment) {
    for (const auto& [curve, knots] : {std::pair{test::PackCurve::straight, 2U}, {test::PackCurve::polymer, 7U}}) {
        const auto drawn = test::drawn_flights({curve, 3, true, false, 0.0, 0.0}, 31);
        EXPECT_EQ(identify_battery(drawn.records, {}).fit.knots_ah.size(), knots) << to_string(curve);
    }
}

TEST(Identification, GivesBackWhatSynthesizedLogsWereMadeOf) {
    // 12.5 V falling by 1.4 V over 3.2 Ah behind 0.06 ohm, and no RC pair.
    std::vector<DischargeRecord> records;
    for (const auto* name : {"01", "02", "03", "04", "05", "06"}) {
        records.push_back(test::discharge_record(
            flight::read_flight(test::source_dir() / "logs" / (std::string("opterra_synthetic_") + name + ".data"))));
    }
    const auto found = identify_battery(records, {3.2, {}, ""});
    EXPECT_LE(found.errors.resistance_ohm.low, 0.06);
    EXPECT_GE(found.errors.resistance_ohm.high, 0.06);
    EXPECT_LT(found.errors.resistance_ohm.high - found.errors.resistance_ohm.low, 0.01 * 0.06);
    EXPECT_EQ(found.errors.rc_resistance_ohm.low, 0.0);
    EXPECT_LT(found.errors.rc_resistance_ohm.high, 0.0001);
    EXPECT_NEAR(found.fit.open_circuit_v.front(), 12.5, 0.001);
    const double slope = (found.fit.open_circuit_v.front() - found.fit.open_circuit_v.back()) /
                         (found.fit.knots_ah.back() - found.fit.knots_ah.front());
    EXPECT_NEAR(slope, 1.4 / 3.2, 0.01 * 1.4 / 3.2);
    for (const auto& check : leave_one_out(records, {3.2, {}, ""})) EXPECT_LT(check.voltage_rms_v, 0.001);
    std::vector<std::size_t> done;
    const auto in_groups = leave_one_out(
        records, {3.2, {}, ""}, [&](std::size_t so_many, std::size_t) { done.push_back(so_many); }, 3);
    EXPECT_EQ(done, (std::vector<std::size_t>{1, 2, 3}));
    ASSERT_EQ(in_groups.size(), records.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
        EXPECT_EQ(in_groups[i].flight, records[i].flight);
        EXPECT_LT(in_groups[i].voltage_rms_v, 0.001);
    }
}

/// A cold pack has three times the resistance, and both lose some of it as the current heats them.
TEST(Identification, AlignsColdAndWarmPacks) {
    constexpr double warming_per_j = 2e-4;
    std::vector<DischargeRecord> records;
    for (const std::size_t f : {0U, 1U, 2U, 3U}) {
        SyntheticDischarge flown;
        flown.initial_charge_ah = 0.3 * static_cast<double>(f);
        auto record = test::discharge_record(synthetic_discharge(known_pack(), flown, f + 1));
        auto own = known_pack();
        own.resistance_ohm *= f % 2 == 1 ? 3.0 : 1.0;
        const auto heat = heat_a2s(record);
        for (std::size_t i = 0; i < heat.size(); ++i)
            record.voltage_v[i] -= (warmed_resistance_ohm(own, warming_per_j, heat[i]) - known_pack().resistance_ohm) *
                                   record.current_a[i];
        records.push_back(std::move(record));
    }
    const auto found = identify_battery(records, {2.4, {}, ""});
    EXPECT_LT(found.fit.rms_v, 0.02);
    EXPECT_NEAR(found.fit.warming_per_j, warming_per_j, 0.4 * warming_per_j);
    for (const std::size_t f : {1U, 2U, 3U})
        EXPECT_NEAR(found.flights[f].initial_depletion_ah - found.flights[0].initial_depletion_ah,
                    0.3 * static_cast<double>(f), 0.08);
    for (const auto& check : leave_one_out(records, {2.4, {}, ""}))
        EXPECT_LT(check.load_mean_error_v, 0.2) << check.flight << ": three times the resistance is 0.5 V";
}

TEST(Identification, FollowsThePackInFlight) {
    std::vector<DischargeRecord> records;
    for (const std::size_t seed : {1U, 2U, 3U})
        records.push_back(test::discharge_record(synthetic_discharge(known_pack(), {}, seed)));
    auto& other = records.back();  // a pack with half as much resistance again
    for (std::size_t i = 0; i < other.time_s.size(); ++i)
        other.voltage_v[i] -= 0.5 * known_pack().resistance_ohm * other.current_a[i];
    const auto check = leave_one_out(records, {}).back();
    EXPECT_GT(check.load_mean_error_v, 0.05);
    EXPECT_GT(check.ahead_error_v, 0.0);
    EXPECT_LT(check.ahead_error_v, 0.5 * check.load_mean_error_v);
}

TEST(Identification, StatesAnIntervalThatHoldsForAPackThatDoesNotBeginFull) {
    auto pack = known_pack();
    std::size_t held = 0;
    for (std::uint64_t seed = 1; seed <= all_seeds; ++seed) {
        std::vector<DischargeRecord> records;
        for (std::uint64_t f = 0; f < 4; ++f) {
            SyntheticDischarge flown;
            flown.slow_resistance_ohm = 0.03;
            if (f == 3) {  // its pack rested for a few minutes after another flight
                flown.initial_charge_ah = 0.25 * pack.capacity_ah;
                flown.initial_slow_v = 0.04;
            }
            pack.resistance_ohm = known_pack().resistance_ohm * (0.85 + 0.1 * static_cast<double>((f + seed) % 4));
            records.push_back(test::discharge_record(synthetic_discharge(pack, flown, seed + 1000 * f)));
        }
        const auto check = leave_one_out(records, {}).back();
        EXPECT_LT(check.load_half_width_v, 1.0) << "an interval that holds everything states nothing";
        held += check.load_held_percent >= 90.0 ? 1 : 0;
    }
    EXPECT_GE(held, enough_seeds);
}

TEST(IdentificationStudy, RestsNoCapacityOnFlightsOfUnknownInitialCharge) {
    FLIGHTWATT_NEEDS_SHARED();
    std::vector<DischargeRecord> records;
    for (int number = 1; number <= 209; number += 7) {  // of which the folder has two in three
        const auto file = test::shared_dir() / "m100" / fmt::format("{}.csv", number);
        if (!std::filesystem::exists(file)) continue;
        try {
            records.push_back(test::discharge_record(flight::read_flight(file)));
        } catch (const InputError&) {  // no rest, no load
        }
    }
    ASSERT_GE(records.size(), 10U);
    const auto found = identify_battery(records, {});
    const auto& interval = found.capacity.interval_ah.value();
    fmt::print("{} flights: {:.2f} Ah, {:.2f} to {:.2f}\n", records.size(), found.capacity.value_ah, interval.low,
               interval.high);
    EXPECT_TRUE(interval.low < 5.7 && 5.7 < interval.high) << "what the pack is thought to hold";
}

// 29 s of hover on six cells: 0.03 Ah indicated 0.04 to 0.98 Ah, which contradicted any label.
TEST(Identification, RestsNoCapacityOnAVoltageThatTheLoadMayHaveTaken) {
    FLIGHTWATT_NEEDS_SHARED();
    const auto log = test::shared_dir() / "archives" / "autopilots" / "px4" / "copter_upgrade.ulg";
    const std::vector records{test::discharge_record(flight::read_flight(log))};
    const auto given = identify_battery(records, {5.0, {}, ""});
    EXPECT_FALSE(given.battery.flight_estimate);
    EXPECT_EQ(capacity_warning(given.battery), "");
}

TEST(Identification, ForetellsRealFlights) {
    FLIGHTWATT_NEEDS_SHARED();
    std::vector<DischargeRecord> records;
    for (const auto* name : {"20_07_03__12_17_45", "20_07_05__10_26_44", "20_07_10__06_53_03"}) {
        records.push_back(test::discharge_record(
            flight::read_flight(test::shared_dir() / "flights" / (std::string(name) + ".data"))));
        EXPECT_GT(records.back().resting_voltage_v, 12.3);  // a pack of 11.1 V that starts full
    }
    for (const auto& check : leave_one_out(records, {})) {
        fmt::print("{} left out: {:.1f} mV RMS, {:.1f} under load, {:.0f} % of it beyond the others\n", check.flight,
                   1e3 * check.voltage_rms_v, 1e3 * check.load_rms_v, check.extrapolated_percent);
        EXPECT_LT(check.voltage_rms_v, 0.090) << check.flight;
        EXPECT_GE(check.load_held_percent, 90.0) << check.flight << ": its 95 % interval before take-off";
    }
    const auto found = identify_battery(records, {});
    fmt::print("resistance {:.4f} ohm [{:.4f}, {:.4f}]\n", found.fit.resistance_ohm, found.errors.resistance_ohm.low,
               found.errors.resistance_ohm.high);
    EXPECT_EQ(found.cells, 3);
    EXPECT_EQ(found.capacity.origin, CapacityOrigin::chart);
    EXPECT_GT(found.fit.resistance_ohm, 0.05);
    EXPECT_LT(found.fit.resistance_ohm, 0.2);
}

}  // namespace
}  // namespace flightwatt::battery

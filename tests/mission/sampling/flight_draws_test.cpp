#include "mission/sampling/flight_draws.h"

#include "base/statistics.h"
#include "battery/identification.h"
#include "helpers/drawn_mission.h"
#include "helpers/paper_missions.h"
#include "helpers/steady_mission.h"
#include "mission/sampling/flight_spreads.h"
#include "mission/simulation/load_segments.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

/// Flights of the cruise of a steady mission: mean powers and durations.
Mission of_flights(const std::vector<double>& levels_w, const std::vector<double>& durations_s) {
    auto mission = test::steady_mission();
    auto& cruise = mission.setup.mechanical->phases[flight::Phase::cruise];
    cruise.level_spread = mechanical::VarianceComponents{levels_w.size(), sample_sd(levels_w), 0.0, 1.0};
    for (std::size_t i = 0; i < levels_w.size(); ++i) {
        mechanical::FlightContribution flight;
        flight.phases[flight::Phase::cruise] = mechanical::PhaseContribution{1.0 / static_cast<double>(levels_w.size()),
                                                                             durations_s[i], 1.0, 100, levels_w[i]};
        mission.setup.mechanical->flights.push_back(flight);
    }
    return mission;
}

double level_w(const MissionSetup& flight) { return flight.mechanical->phases[flight::Phase::cruise].fourier.a0_w; }

TEST(FlightDraws, TakeLevelsOfFewFlightsByStudentT) {
    auto mission = of_flights({19.0, 20.0, 21.0}, {1000.0, 1000.0, 1000.0});
    const auto spreads = collect_uncertainty(mission.setup);
    const double sd_w = std::sqrt(1.0 + 1.0 / 3.0);
    EXPECT_NEAR(spreads.level_sd_w[flight::Phase::cruise], sd_w, 1e-12);
    EXPECT_NE(describe(spreads.sources)
                  .find("cruise level (sd 1.155 W, of 3 flights, Student t with 2 degrees of "
                        "freedom"),
              std::string::npos)
        << describe(spreads.sources);
    std::vector<double> normals(count_normals(mission.setup));
    normals[level_index(flight::Phase::cruise)] = normal_half_width();
    EXPECT_NEAR(level_w(apply_draw(mission.setup, spreads, normals)), 20.0 + sd_w * student_t_half_width(2.0), 1e-9);
    mission.setup.uncertainty.level_sd_percent[flight::Phase::cruise] = 5.0;
    EXPECT_NEAR(level_w(apply_draw(mission.setup, collect_uncertainty(mission.setup), normals)),
                20.0 + normal_half_width(), 1e-9)
        << "what is stated is normal";
}

TEST(FlightDraws, DrawNoLevelFurtherThanAQuarterAboveTheHighestMeasured) {
    auto mission = of_flights({19.0, 20.0, 21.0}, {1000.0, 1000.0, 1000.0});
    const auto drawn_w = [&](double normal) {
        std::vector<double> normals(count_normals(mission.setup));
        normals[level_index(flight::Phase::cruise)] = normal;
        return level_w(apply_draw(mission.setup, collect_uncertainty(mission.setup), normals));
    };
    const double limit_t = 6.25 / std::sqrt(1.0 + 1.0 / 3.0);
    const double limit_z =
        normal_quantile(0.5 * (1.0 + limit_t / std::sqrt(2.0 + limit_t * limit_t)));  // of 2 degrees of freedom
    EXPECT_NEAR(drawn_w(0.99 * limit_z), 26.1, 0.15);
    EXPECT_LT(drawn_w(0.99 * limit_z), 26.25);
    EXPECT_NEAR(drawn_w(1.01 * limit_z), 26.25, 1e-9);
    EXPECT_NEAR(drawn_w(5.0), 26.25, 1e-9);
    auto& cruise = mission.setup.mechanical->phases[flight::Phase::cruise];
    cruise.spread = mechanical::FlightEnvelope{{18.0}, {40.0}, {1.0}};
    EXPECT_NEAR(drawn_w(5.0), 50.0, 1e-9) << "a curve went higher";
    EXPECT_EQ(highest_measured_power_w(mechanical::MechanicalModel()), std::numeric_limits<double>::infinity());
}

TEST(FlightDraws, MoveTogetherWhatWentTogether) {
    // Strong flights were short ones, and their energy the same but for a second order: so is that of flights to come.
    const auto mission = of_flights({19.0, 21.0}, {1050.0, 950.0});
    const auto spreads = collect_uncertainty(mission.setup);
    for (std::uint64_t i = 0; i < 200; ++i) {
        const auto flight = apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 5, i));
        const double duration_s = flight.duration_s[flight::Phase::cruise];
        if (duration_s <= 100.0 || duration_s >= 10000.0 || level_w(flight) > 26.24) continue;  // cut off there
        EXPECT_NEAR(level_w(flight) * duration_s, 20.0 * 1000.0, 0.05);
    }
}

TEST(FlightDraws, TakeNoPowerBack) {
    auto mission = of_flights({10.0, 30.0}, {1000.0, 1000.0});
    auto& curve = mission.setup.mechanical->phases[flight::Phase::cruise].fourier;
    for (const double swing_w : {0.0, 5.0, 25.0}) {  // the last is below 0 as planned
        curve = {0.01, 20.0, {swing_w}, {0.0}};
        const double planned_w = min_power_w(curve, {0.0, 1000.0}).power_w;
        const auto spreads = collect_uncertainty(mission.setup);
        for (std::uint64_t i = 0; i < 100; ++i) {
            const auto flown = apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 1, i))
                                   .mechanical->phases[flight::Phase::cruise]
                                   .fourier;
            EXPECT_GE(min_power_w(flown, {0.0, 1000.0}).power_w, std::min(0.0, planned_w) - 1e-6);
            EXPECT_GE(energy_j(flown, 1000.0), -1e-6);
        }
    }
}

TEST(FlightDraws, LeaveOutFlightsThatDoNotCount) {
    auto mission = of_flights({19.0, 20.0, 21.0}, {1000.0, 1100.0, 4000.0});
    const auto cruise = flight::Phase::cruise;
    mission.setup.mechanical->flights[2].phases[cruise]->weight = 0.0;
    const auto printed = describe(collect_uncertainty(mission.setup).sources);
    EXPECT_NE(printed.find("of 2 flights, Student t with 1 degree of freedom"), std::string::npos) << printed;
}

TEST(FlightDraws, SayWhereCorrelationsAreNotKnown) {
    auto mission = of_flights({19.0, 20.0, 21.0}, {1000.0, 1000.0, 1000.0});
    const std::string unknown = "correlated with nothing: the model has no mean_power_w";
    EXPECT_EQ(describe(collect_uncertainty(mission.setup).sources).find(unknown), std::string::npos);
    for (auto& flight : mission.setup.mechanical->flights) flight.phases[flight::Phase::cruise]->mean_power_w.reset();
    EXPECT_NE(describe(collect_uncertainty(mission.setup).sources).find(unknown), std::string::npos);
}

TEST(FlightDraws, TakeWhatTheModelsKnow) {
    auto mission = test::paper_mission("phased");
    mission.setup.uncertainty.level_sd_percent = {};
    auto& cruise = mission.setup.mechanical->phases[flight::Phase::cruise];
    cruise.level_spread = mechanical::VarianceComponents{3, 1.0, 0.0, 1.0};
    cruise.flights = 3;
    for (const double duration_s : {570.0, 600.0, 630.0}) {
        mechanical::FlightContribution flight;
        flight.phases[flight::Phase::cruise] = mechanical::PhaseContribution{1.0 / 3.0, duration_s, 1.0, 100};
        mission.setup.mechanical->flights.push_back(flight);
    }
    auto& detection = mission.setup.compute.components[0].profile;
    detection.standard_error_w.assign(detection.power_w.size(), 0.5);
    mission.setup.battery.intervals.capacity_ah = Interval{3.0, 3.3};
    const auto spreads = collect_uncertainty(mission.setup);
    const double new_flight = std::sqrt(1.0 + 1.0 / 3.0);
    EXPECT_NEAR(spreads.level_sd_w[flight::Phase::cruise], new_flight, 1e-12);
    EXPECT_NEAR(spreads.duration_sd_s[flight::Phase::cruise], 30.0 * new_flight, 1e-9);
    double capacity_below = 0.0;
    double power_square_sum = 0.0;
    constexpr int flights = 4000;
    for (int i = 0; i < flights; ++i) {
        const auto flight = apply_draw(mission.setup, spreads,
                                       draw_normals(count_normals(mission.setup), 1, static_cast<std::uint64_t>(i)));
        capacity_below += flight.battery.capacity_ah < 3.0 ? 1.0 : 0.0;
        const double off_w = flight.compute.components[0].profile.power_w[0] - detection.power_w[0];
        power_square_sum += off_w * off_w;
    }
    EXPECT_NEAR(capacity_below / flights, 0.025, 0.01) << "each side of the interval has 2.5 %";
    EXPECT_NEAR(std::sqrt(power_square_sum / flights), 0.5, 0.025);
}

/// How often the resistances of a file's draws hold those of flights to come, in the middle 95 %: `flights` of a pack
/// whose flights differ by a normal `sd_part`; their own resistances are known.
double share_of_flights_to_come(std::size_t flights, double sd_part) {
    constexpr std::size_t phase_numbers = 6;
    constexpr std::size_t of_resistance = phase_numbers + 2;  // after capacity and voltage
    constexpr int packs = 400;
    constexpr double mean_ohm = 0.1;
    std::mt19937 random(7);
    std::normal_distribution<double> own(mean_ohm, sd_part * mean_ohm);
    int held = 0;
    for (int pack = 0; pack < packs; ++pack) {
        std::vector<std::optional<battery::FlightResistance>> known;
        std::vector<double> known_ohm;
        for (std::size_t f = 0; f < flights; ++f) {
            known_ohm.push_back(own(random));
            known.push_back(battery::FlightResistance{known_ohm.back(), 0.0, 10.0, {}});
        }
        auto mission = test::paper_mission("phased");
        auto& battery = mission.setup.battery;
        battery.resistance_ohm = mean(known_ohm);
        const double half_ohm = normal_half_width() * sample_sd(known_ohm) / std::sqrt(static_cast<double>(flights));
        battery.intervals.resistance_ohm = {battery.resistance_ohm - half_ohm, battery.resistance_ohm + half_ohm};
        battery.intervals.resistance_scatter = resistance_scatter(known, battery.resistance_ohm);
        const auto spreads = collect_uncertainty(mission.setup);
        std::vector<double> normals(count_normals(mission.setup), 0.0);
        const auto quantile_ohm = [&](double z) {
            normals[of_resistance] = z;
            return apply_draw(mission.setup, spreads, normals).battery.resistance_ohm;
        };
        const double to_come_ohm = own(random);
        held += quantile_ohm(-1.96) <= to_come_ohm && to_come_ohm <= quantile_ohm(1.96) ? 1 : 0;
    }
    return static_cast<double>(held) / packs;
}

// 400 packs: 95 % +- 1.1 points. By the interval of the mean alone it were 30 to 57 %.
TEST(FlightDraws, HoldTheResistancesOfFlightsToCome) {
    for (const std::size_t flights : {2U, 4U, 12U})
        for (const double sd_part : {0.05, 0.15, 0.3})
            EXPECT_GE(share_of_flights_to_come(flights, sd_part), 0.90)
                << flights << " flights that differ by " << sd_part;
    EXPECT_LE(share_of_flights_to_come(12, 0.15), 0.98);
}

TEST(FlightDraws, DrawCurvesThatRiseThoughTheirLowEndIsUncertain) {
    auto mission = test::paper_mission("phased");
    constexpr std::size_t of_voltage = 7;
    battery::TheveninCircuit circuit;
    circuit.open_circuit = {{0.0, 5.0, 50.0, 100.0}, {9.8, 10.8, 11.5, 12.6}};
    mission.setup.battery.thevenin = circuit;
    mission.setup.battery.intervals.open_circuit_standard_error_v = {0.9, 0.5, 0.02, 0.01};
    const auto drawn_v = [&](double z) {
        std::vector<double> normals(count_normals(mission.setup), 0.0);
        normals[of_voltage] = z;
        return apply_draw(mission.setup, collect_uncertainty(mission.setup), normals)
            .battery.thevenin->open_circuit.voltage_v;
    };
    EXPECT_EQ(drawn_v(2.0), (std::vector<double>{11.54, 11.54, 11.54, 12.62})) << "no knot above one that is certain";
    EXPECT_EQ(drawn_v(0.0), circuit.open_circuit.voltage_v);
    const auto low_v = drawn_v(-2.0);
    EXPECT_NEAR(low_v[0], 8.0, 1e-12);
    EXPECT_NEAR(low_v[2], 11.46, 1e-12);
    EXPECT_GT(drawn_v(-20.0).front(), 0.0);
}

TEST(FlightDraws, DrawTheInitialChargeThatIsStated) {
    auto mission = test::paper_mission("phased");
    mission.setup.initial_soc_percent = 90.0;
    const auto certain = count_normals(mission.setup);
    mission.setup.uncertainty.initial_soc_sd_percent = 4.0;
    ASSERT_EQ(count_normals(mission.setup), certain + 1);
    const auto drawn_percent = [&](double z) {
        std::vector<double> normals(count_normals(mission.setup), 0.0);
        normals.back() = z;
        return apply_draw(mission.setup, collect_uncertainty(mission.setup), normals).initial_soc_percent;
    };
    EXPECT_DOUBLE_EQ(drawn_percent(-1.5), 84.0);
    EXPECT_EQ(drawn_percent(3.0), 100.0) << "no battery is more than full";
    EXPECT_GT(drawn_percent(-50.0), 0.0);
    EXPECT_NE(describe(collect_uncertainty(mission.setup).sources).find("initial charge (sd 4 points, stated)"),
              std::string::npos);
}

TEST(FlightDraws, DrawTheResistanceOfFilesOfBeforeByItsInterval) {
    auto mission = test::paper_mission("phased");
    constexpr std::size_t of_resistance = 8;
    const double ohm = mission.setup.battery.resistance_ohm;
    mission.setup.battery.intervals.resistance_ohm = Interval{0.8 * ohm, 1.1 * ohm};
    const auto drawn_ohm = [&](double z) {
        std::vector<double> normals(count_normals(mission.setup), 0.0);
        normals[of_resistance] = z;
        return apply_draw(mission.setup, collect_uncertainty(mission.setup), normals).battery.resistance_ohm;
    };
    EXPECT_NEAR(drawn_ohm(-1.96), 0.8 * ohm, 1e-12);
    EXPECT_NEAR(drawn_ohm(1.96), 1.1 * ohm, 1e-12);
    EXPECT_NE(describe(collect_uncertainty(mission.setup).sources)
                  .find("battery resistance (the battery's interval; not how flights"),
              std::string::npos);
    mission.setup.battery.intervals.resistance_scatter = battery::ResistanceScatter{0.0, 4};
    EXPECT_NEAR(drawn_ohm(1.96), 1.1 * ohm, 1e-12) << "flights that do not differ";
    mission.setup.battery.intervals.resistance_scatter = battery::ResistanceScatter{ohm, 4};
    EXPECT_EQ(drawn_ohm(0.0), ohm);
    EXPECT_EQ(drawn_ohm(-3.0), 0.0);
    EXPECT_NEAR(drawn_ohm(1.96), ohm * (1.0 + std::hypot(0.1, 2.776)), 0.01 * ohm);
    EXPECT_NE(
        describe(collect_uncertainty(mission.setup).sources).find("of 4 flights, Student t with 4 degrees of freedom"),
        std::string::npos);
}

TEST(FlightDraws, KeepAnUnknownTimeConstantLongEnoughToBeStepped) {
    auto mission = test::steady_mission();
    battery::TheveninCircuit circuit;
    circuit.open_circuit = {{0.0, 100.0}, {9.0, 12.6}};
    circuit.rc_resistance_ohm = 0.01;
    circuit.rc_time_constant_s = 110.0;
    mission.setup.battery.thevenin = circuit;
    mission.setup.battery.intervals.rc_time_constant_s = Interval{0.005, 2.4e6};
    double shortest_s = std::numeric_limits<double>::infinity();
    double longest_s = 0.0;
    for (std::uint64_t i = 0; i < 500; ++i) {
        const auto normals = draw_normals(count_normals(mission.setup), 1, i);
        const double drawn_s =
            apply_draw(mission.setup, collect_uncertainty(mission.setup), normals).battery.thevenin->rc_time_constant_s;
        shortest_s = std::min(shortest_s, drawn_s);
        longest_s = std::max(longest_s, drawn_s);
    }
    EXPECT_EQ(shortest_s, battery::min_time_constant_s) << "less took minutes to simulate";
    EXPECT_EQ(longest_s, battery::max_time_constant_s);
}

TEST(FlightDraws, LeaveAloneWhatTheMissionStates) {
    auto mission = test::paper_mission("phased");
    for (const double duration_s : {570.0, 630.0}) {
        mechanical::FlightContribution flight;
        flight.phases[flight::Phase::cruise] = mechanical::PhaseContribution{0.5, duration_s, 1.0, 100};
        mission.setup.mechanical->flights.push_back(flight);
    }
    mission.setup.battery.intervals.capacity_ah = Interval{3.0, 3.3};
    EXPECT_GT(collect_uncertainty(mission.setup).duration_sd_s[flight::Phase::cruise], 0.0);
    mission.setup.duration_is_stated[flight::Phase::cruise] = true;
    mission.setup.capacity_is_stated = true;
    auto spreads = collect_uncertainty(mission.setup);
    EXPECT_EQ(spreads.duration_sd_s[flight::Phase::cruise], 0.0);
    EXPECT_EQ(apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 1, 1)).battery.capacity_ah,
              mission.setup.battery.capacity_ah);
    const auto printed = describe(spreads.sources);
    EXPECT_NE(printed.find("not drawn: "), std::string::npos);
    EXPECT_NE(printed.find("cruise duration (fixed, as the mission states it without duration_sd_s)"),
              std::string::npos);
    EXPECT_NE(printed.find("capacity (fixed, as the mission states capacity_ah without capacity_sd_percent)"),
              std::string::npos);
    mission.setup.uncertainty.duration_sd_s[flight::Phase::cruise] = 7.0;
    mission.setup.uncertainty.capacity_sd_percent = 2.0;
    spreads = collect_uncertainty(mission.setup);
    EXPECT_EQ(spreads.duration_sd_s[flight::Phase::cruise], 7.0);
    EXPECT_NE(apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 1, 1)).battery.capacity_ah,
              mission.setup.battery.capacity_ah);
}

}  // namespace
}  // namespace flightwatt::mission

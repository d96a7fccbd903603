#include "mission/sampling/flight_draws.h"

#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/prediction.h"
#include "mission/sampling/level_deviation.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <boost/random/normal_distribution.hpp>
#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double shortest_part = 0.1;    ///< of a planned duration
constexpr double least_part = 1e-3;      ///< of what must stay positive
constexpr double sd_per_half_95 = 1.96;  ///< half the width of a normal 95 % interval, in deviations

/// Notes down a source, as drawn or not.
void note_source(FlightSpreads& spreads, bool is_drawn, const std::string& source, const std::string& basis) {
    (is_drawn ? spreads.drawn : spreads.not_drawn).push_back(fmt::format("{} ({})", source, basis));
}

std::string basis_of(const LevelDeviation& deviation) {
    const auto sd = fmt::format("sd {:.4g} W, ", deviation.sd_w);
    switch (deviation.source) {
        case DeviationSource::none:
            return "the model has no spread: fit two flights or more";
        case DeviationSource::stated:
            return sd + "stated";
        case DeviationSource::conditions:
            return sd + "of the flights about what the conditions say";
        case DeviationSource::flights:
            return sd + fmt::format("of {} flights", deviation.flights);
        case DeviationSource::fit_error:
            return sd + "the fit's standard error; not how flights differ";
    }
    throw std::logic_error("basis_of: no such source of a deviation");
}

void find_duration(const MissionSetup& mission, Phase phase, FlightSpreads& spreads) {
    const auto source = fmt::format("{} duration", to_string(phase));
    auto& sd_s = spreads.duration_sd_s[phase];
    std::vector<double> flown_s;
    if (mission.mechanical) {
        for (const auto& flight : mission.mechanical->flights)
            if (const auto& part = flight.phases[phase]) flown_s.push_back(part->duration_s);
    }
    std::string basis = "no flights that differ: state duration_sd_s";
    if (const auto stated_s = mission.uncertainty.duration_sd_s[phase]) {
        sd_s = *stated_s;
        basis = fmt::format("sd {:.4g} s, stated", sd_s);
    } else if (flown_s.size() >= 2) {
        const double relative = sample_sd(flown_s) / mean(flown_s);
        sd_s = mission.duration_s[phase] * relative *
               std::sqrt(1.0 + forecast_of(*mission.mechanical, phase).weight_square_sum);
        basis = fmt::format("sd {:.4g} s, of {} flights", sd_s, flown_s.size());
    }
    note_source(spreads, sd_s > 0.0, source, basis);
}

void find_compute(const MissionSetup& mission, FlightSpreads& spreads) {
    const auto& components = mission.compute.components;
    for (std::size_t i = 0; i < components.size(); ++i) {
        const auto stated_percent = mission.uncertainty.compute_sd_percent.at(i);
        const bool has_errors = !components[i].profile.standard_error_w.empty();
        note_source(spreads, stated_percent ? *stated_percent > 0.0 : has_errors,
                    fmt::format("power of {}", components[i].name),
                    stated_percent ? fmt::format("sd {:.4g} %, stated", *stated_percent)
                    : has_errors   ? "standard errors of its profile"
                                   : "its profile has no standard errors: profile it, or state compute_sd_percent");
    }
}

void find_battery(const MissionSetup& mission, FlightSpreads& spreads) {
    const auto& battery = mission.battery;
    const auto& intervals = battery.intervals;
    const auto find = [&](const std::string& source, bool has_interval) {
        note_source(spreads, has_interval, source,
                    has_interval ? "the battery's interval" : "the battery's file has no interval");
    };
    if (const auto percent = mission.uncertainty.capacity_sd_percent) {
        note_source(spreads, *percent > 0.0, "battery capacity", fmt::format("sd {:.4g} %, stated", *percent));
    } else {
        find("battery capacity", intervals.capacity_ah.has_value());
    }
    if (battery.thevenin) {
        find("open-circuit voltage", !intervals.open_circuit_standard_error_v.empty());
        if (battery.thevenin->rc_resistance_ohm > 0.0) {
            find("battery RC resistance", intervals.rc_resistance_ohm.has_value());
            find("battery RC time constant", intervals.rc_time_constant_s.has_value());
        }
    } else {
        find("battery voltage", intervals.voltage_v.has_value());
    }
    find("battery resistance", intervals.resistance_ohm.has_value());
}

/// `value` moved by `z` deviations of an interval.
double moved(double value, const std::optional<battery::Interval>& interval, double z, double least) {
    if (!interval) return value;
    const double sd = (z < 0.0 ? value - interval->low : interval->high - value) / sd_per_half_95;
    return std::max(least, value + z * sd);
}

/// The same in the logarithm.
double moved_logarithm(double value, const std::optional<battery::Interval>& interval, double z) {
    if (!interval || interval->low <= 0.0) return moved(value, interval, z, least_part * value);
    const double sd = std::log(z < 0.0 ? value / interval->low : interval->high / value) / sd_per_half_95;
    return value * std::exp(z * sd);
}

/// Standard normal numbers, the same wherever they are drawn.
class Normals {
  public:
    Normals(std::uint64_t seed, std::uint64_t index) {
        std::seed_seq words{seed & 0xFFFFFFFFU, seed >> 32U, index & 0xFFFFFFFFU, index >> 32U};
        engine_.seed(words);
    }
    double operator()() { return normal_(engine_); }

  private:
    std::mt19937_64 engine_;
    boost::random::normal_distribution<double> normal_;
};

/// Every number is drawn, needed or not: missions that differ in one source have the others in common.
void draw_battery(const Uncertainty& stated, Normals& normal, battery::Battery& battery) {
    const auto& intervals = battery.intervals;
    const double capacity_z = normal();
    const double voltage_z = normal();
    const double resistance_z = normal();
    const double rc_resistance_z = normal();
    const double time_constant_z = normal();
    if (const auto percent = stated.capacity_sd_percent) {
        battery.capacity_ah *= std::max(least_part, 1.0 + units::part_of(capacity_z, *percent));
    } else {
        battery.capacity_ah =
            moved(battery.capacity_ah, intervals.capacity_ah, capacity_z, least_part * battery.capacity_ah);
    }
    battery.voltage_v = moved(battery.voltage_v, intervals.voltage_v, voltage_z, least_part * battery.voltage_v);
    battery.resistance_ohm = moved(battery.resistance_ohm, intervals.resistance_ohm, resistance_z, 0.0);
    if (!battery.thevenin) return;
    auto& circuit = *battery.thevenin;
    circuit.rc_resistance_ohm = moved(circuit.rc_resistance_ohm, intervals.rc_resistance_ohm, rc_resistance_z, 0.0);
    circuit.rc_time_constant_s =
        moved_logarithm(circuit.rc_time_constant_s, intervals.rc_time_constant_s, time_constant_z);
    auto& voltage_v = circuit.open_circuit.voltage_v;
    double below_v = least_part * voltage_v.front();  // the curve never falls
    for (std::size_t k = 0; k < intervals.open_circuit_standard_error_v.size(); ++k) {
        voltage_v[k] = std::max(below_v, voltage_v[k] + voltage_z * intervals.open_circuit_standard_error_v[k]);
        below_v = voltage_v[k];
    }
}

void draw_compute(const Uncertainty& stated, Normals& normal, compute::ComputeModel& compute) {
    for (std::size_t i = 0; i < compute.components.size(); ++i) {
        auto& profile = compute.components[i].profile;
        const double common_z = normal();
        const auto percent = stated.compute_sd_percent.at(i);
        const double factor = std::max(0.0, 1.0 + units::part_of(common_z, percent.value_or(0.0)));
        const bool own_errors = !percent && !profile.standard_error_w.empty();
        for (std::size_t k = 0; k < profile.power_w.size(); ++k) {
            const double node_z = normal();
            profile.power_w[k] *= factor;
            if (own_errors) profile.power_w[k] += node_z * profile.standard_error_w[k];
        }
    }
}

}  // namespace

FlightSpreads find_spreads(const MissionSetup& mission) {
    FlightSpreads spreads;
    for (const auto phase : all_phases) {
        if (mission.duration_s[phase] == 0.0) continue;
        if (mission.mechanical) {
            const auto deviation = level_deviation(mission, phase);
            spreads.level_sd_w[phase] = deviation.sd_w;
            note_source(spreads, deviation.sd_w > 0.0, fmt::format("{} level", to_string(phase)), basis_of(deviation));
        }
        find_duration(mission, phase, spreads);
    }
    find_compute(mission, spreads);
    find_battery(mission, spreads);
    return spreads;
}

MissionSetup draw_flight(const MissionSetup& mission, const FlightSpreads& spreads, std::uint64_t seed,
                         std::uint64_t index) {
    Normals normal(seed, index);
    auto flight = mission;
    for (const auto phase : all_phases) {
        const double level_z = normal();
        const double duration_z = normal();
        if (flight.mechanical) flight.mechanical->phases[phase].fourier.a0_w += level_z * spreads.level_sd_w[phase];
        const double planned_s = mission.duration_s[phase];
        flight.duration_s[phase] =
            std::max(shortest_part * planned_s, planned_s + duration_z * spreads.duration_sd_s[phase]);
    }
    draw_battery(mission.uncertainty, normal, flight.battery);
    draw_compute(mission.uncertainty, normal, flight.compute);
    return flight;
}

}  // namespace flightwatt::mission

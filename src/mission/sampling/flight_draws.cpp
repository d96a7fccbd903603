#include "mission/sampling/flight_draws.h"

#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/prediction.h"
#include "mission/sampling/level_deviation.h"
#include "mission/sampling/student.h"
#include "mission/simulation/least_power.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include <boost/random/normal_distribution.hpp>
#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double shortest_part = 0.1;    ///< of a planned duration
constexpr double longest_part = 10.0;    ///< of it too
constexpr double least_part = 1e-3;      ///< of what must stay positive
constexpr double sd_per_half_95 = 1.96;  ///< half the width of a normal 95 % interval, in deviations

/// Notes down a source, as drawn or not.
void note_source(FlightSpreads& spreads, bool is_drawn, const std::string& source, const std::string& basis) {
    auto& [drawn, not_drawn] = spreads.sources;
    (is_drawn ? drawn : not_drawn).push_back(fmt::format("{} ({})", source, basis));
}

std::string student_words(double degrees_of_freedom) {
    return fmt::format("Student t with {:.4g} degree{} of freedom", degrees_of_freedom,
                       degrees_of_freedom == 1.0 ? "" : "s");
}

std::string basis_of(const LevelDeviation& deviation) {
    const auto sd = fmt::format("sd {:.4g} W, ", deviation.sd_w);
    switch (deviation.source) {
        case DeviationSource::none:
            return "the model has no spread: fit two flights or more";
        case DeviationSource::stated:
            return sd + "stated";
        case DeviationSource::conditions:
            return sd + "of the flights about what the conditions say, " + student_words(deviation.degrees_of_freedom);
        case DeviationSource::path:
            return sd + "of the flights about what their motion says, " + student_words(deviation.degrees_of_freedom);
        case DeviationSource::flights:
            return sd +
                   fmt::format("of {} flights, {}", deviation.flights, student_words(deviation.degrees_of_freedom));
        case DeviationSource::fit_error:
            return sd + "the fit's standard error; not how flights differ";
    }
    throw std::logic_error("basis_of: no such source of a deviation");
}

bool has_wind_spread(const MissionSetup& mission) {
    if (!mission.cruise_path) return false;
    const auto& wind = mission.cruise_path->plan->wind;
    return wind.speed_sd_m_per_s > 0.0 || wind.direction_sd_deg > 0.0;
}

void find_wind(const MissionSetup& mission, FlightSpreads& spreads) {
    if (!mission.cruise_path) return;
    const auto& wind = mission.cruise_path->plan->wind;
    const auto note = [&](double sd, const std::string& what, std::string_view unit, std::string_view key) {
        note_source(spreads, sd > 0.0, what,
                    sd > 0.0 ? fmt::format("sd {:.4g} {}, stated", sd, unit) : fmt::format("[wind] states no {}", key));
    };
    note(wind.speed_sd_m_per_s, "wind speed", "m/s", "speed_sd_m_per_s");
    note(wind.direction_sd_deg, "wind direction", "degrees", "direction_sd_deg");
}

/// What each of the model's flights that count in a phase shows of it.
template <typename Shown>
std::vector<std::optional<double>> of_flights(const MissionSetup& mission, Phase phase, const Shown& shown) {
    std::vector<std::optional<double>> values;
    for (const auto& flight : mission.mechanical->flights) {
        const auto& part = flight.phases[phase];
        values.push_back(part && part->weight > 0.0 ? shown(*part) : std::nullopt);
    }
    return values;
}

/// Notes how often a level stands at 0, because a flight takes no power back, where one in 2000 flights or more does.
std::string at_zero_words(const MissionSetup& mission, Phase phase, const LevelDeviation& deviation) {
    constexpr double least_share = 5e-4;
    const auto& model = mission.mechanical->phases[phase];
    const auto curve = flown_model(model, mission.duration_s[phase], mission.phase_clock);
    const double mean_w = energy_j(curve, mission.duration_s[phase]) / mission.duration_s[phase];
    if (!(mean_w > 0.0) || !(deviation.sd_w > 0.0)) return "";
    const double share = chance_beyond(normal_of_student(mean_w / deviation.sd_w, deviation.degrees_of_freedom));
    return share < least_share ? "" : fmt::format(", 0 W in {:.2g} % of flights", units::percent_of(share, 1.0));
}

void find_level(const MissionSetup& mission, Phase phase, FlightSpreads& spreads,
                std::vector<EstimatedSpread>& estimated) {
    const auto deviation = level_deviation(mission, phase);
    spreads.level_sd_w[phase] = deviation.sd_w;
    auto basis = basis_of(deviation) + at_zero_words(mission, phase, deviation);
    if (deviation.degrees_of_freedom < as_if_known) {
        EstimatedSpread spread{level_of(phase), deviation.sd_w, deviation.degrees_of_freedom, {}};
        if (deviation.source == DeviationSource::flights) {
            spread.of_flights = of_flights(mission, phase, [](const auto& part) { return part.mean_power_w; });
            if (!is_known_of_flights(spread)) basis += ", correlated with nothing: the model has no mean_power_w";
        }
        estimated.push_back(std::move(spread));
    }
    note_source(spreads, deviation.sd_w > 0.0, fmt::format("{} level", to_string(phase)), basis);
}

/// Throughout, what the mission states is fixed, and [uncertainty] alone gives it a spread.
void find_duration(const MissionSetup& mission, Phase phase, FlightSpreads& spreads,
                   std::vector<EstimatedSpread>& estimated) {
    const auto source = fmt::format("{} duration", to_string(phase));
    if (phase == Phase::cruise && mission.cruise_path)
        return note_source(spreads, has_wind_spread(mission), source, "as the path and the wind make it");
    auto& sd_s = spreads.duration_sd_s[phase];
    EstimatedSpread spread{duration_of(phase), 0.0, as_if_known, {}};
    if (mission.mechanical)
        spread.of_flights = of_flights(mission, phase, [](const auto& part) { return std::optional(part.duration_s); });
    std::string basis = "no flights that differ: state duration_sd_s";
    if (const auto stated_s = mission.uncertainty.duration_sd_s[phase]) {
        sd_s = *stated_s;
        basis = fmt::format("sd {:.4g} s, stated", sd_s);
    } else if (mission.duration_is_stated[phase]) {
        basis = "fixed, as the mission states it without duration_sd_s";
    } else if (is_known_of_flights(spread)) {
        std::vector<double> flown_s;
        for (const auto& value : spread.of_flights)
            if (value) flown_s.push_back(*value);
        const double relative = sample_sd(flown_s) / mean(flown_s);
        sd_s = mission.duration_s[phase] * relative *
               std::sqrt(1.0 + forecast_of(*mission.mechanical, phase).weight_square_sum);
        spread.sd = sd_s;
        spread.degrees_of_freedom = static_cast<double>(flown_s.size() - 1);
        basis = fmt::format("sd {:.4g} s, of {} flights, {}", sd_s, flown_s.size(),
                            student_words(spread.degrees_of_freedom));
        estimated.push_back(std::move(spread));
    }
    note_source(spreads, sd_s > 0.0, source, basis);
}

void find_compute(const MissionSetup& mission, FlightSpreads& spreads) {
    for (std::size_t i = 0; i < mission.compute.components.size(); ++i) {
        const auto& component = mission.compute.components[i];
        const auto& errors_w = component.profile.standard_error_w;
        ComponentSpread spread;
        std::string basis = "its profile has no standard errors: profile it, or state compute_sd_percent";
        if (const auto stated_percent = mission.uncertainty.compute_sd_percent.at(i)) {
            spread.common_sd_percent = *stated_percent;
            basis = fmt::format("sd {:.4g} %, stated", *stated_percent);
        } else if (!errors_w.empty()) {
            spread.node_sd_w = errors_w;
            basis = "standard errors of its profile";
        }
        note_source(spreads, spread.common_sd_percent > 0.0 || !spread.node_sd_w.empty(),
                    fmt::format("power of {}", component.name), basis);
        spreads.components.push_back(std::move(spread));
    }
}

void find_capacity(const MissionSetup& mission, FlightSpreads& spreads) {
    auto& interval = spreads.battery.capacity_ah;
    std::string basis = interval ? "the battery's interval" : "the battery's file has no interval";
    if (const auto percent = mission.uncertainty.capacity_sd_percent) {
        const double reach_ah = sd_per_half_95 * units::part_of(mission.battery.capacity_ah, *percent);
        interval.reset();
        if (*percent > 0.0) interval = {mission.battery.capacity_ah - reach_ah, mission.battery.capacity_ah + reach_ah};
        basis = fmt::format("sd {:.4g} %, stated", *percent);
    } else if (mission.capacity_is_stated) {
        interval.reset();
        basis = "fixed, as the mission states capacity_ah without capacity_sd_percent";
    }
    note_source(spreads, interval.has_value(), "battery capacity", basis);
}

void find_battery(const MissionSetup& mission, FlightSpreads& spreads) {
    const auto& battery = mission.battery;
    const auto& intervals = spreads.battery = battery.intervals;
    const auto find = [&](const std::string& source, bool has_interval) {
        note_source(spreads, has_interval, source,
                    has_interval ? "the battery's interval" : "the battery's file has no interval");
    };
    find_capacity(mission, spreads);
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

/// A phase's level, `moved_w` from the model's.
void move_level(mechanical::PhaseModel& phase, double moved_w, double shown_s) {
    auto& curve = phase.fourier;
    const auto as_planned = curve;
    curve.a0_w += moved_w;
    if (moved_w >= 0.0) return;
    const double mean_w = energy_j(as_planned, shown_s) / shown_s;
    if (mean_w <= 0.0 || least_power_w(curve, {0.0, shown_s}).power_w >= 0.0) return;
    const double factor = std::max(0.0, (mean_w + moved_w) / mean_w);
    curve.a0_w = factor * as_planned.a0_w;
    for (auto* terms_w : {&curve.cos_w, &curve.sin_w})
        for (auto& term_w : *terms_w) term_w *= factor;
}

/// The cruise along a path in the wind of its flight, its level moved as a part of the planned.
void fly_drawn_path(double moved_w, double speed_z, double direction_z, const MissionSetup& planned,
                    MissionSetup& flight) {
    const auto& plan = planned.cruise_path->plan;
    auto wind = plan->wind;
    wind.speed_m_per_s = std::max(0.0, wind.speed_m_per_s + speed_z * wind.speed_sd_m_per_s);
    wind.from_deg += direction_z * wind.direction_sd_deg;
    const double factor = std::max(0.0, 1.0 + moved_w / mean_power_w(*planned.cruise_path));
    flight.cruise_path = fly_cruise(plan, wind, ForbiddenLeg::crawl, factor);
    flight.duration_s[Phase::cruise] = duration_s(*flight.cruise_path);
}

/// How far a flight's phases are from the planned.
struct PhaseDeviations {
    std::array<double, phase_quantities> of{};  ///< level [W] and duration [s] of each
    std::array<bool, phase_quantities> is_joint{};
};

PhaseDeviations phase_deviations(const FlightSpreads& spreads, std::span<const double> normals) {
    PhaseDeviations deviations;
    for (const auto phase : all_phases) {
        deviations.of.at(level_of(phase)) = normals[level_of(phase)] * spreads.level_sd_w[phase];
        deviations.of.at(duration_of(phase)) = normals[duration_of(phase)] * spreads.duration_sd_s[phase];
    }
    for (const auto& joint : spreads.of_flights) {
        std::vector<double> own;
        for (const auto quantity : joint.quantities) own.push_back(normals[quantity]);
        const auto students = student_vector(own, joint.degrees_of_freedom);
        for (std::size_t k = 0; k < own.size(); ++k) {
            double& deviation = deviations.of.at(joint.quantities[k]);
            deviation = 0.0;
            for (std::size_t i = 0; i < own.size(); ++i)
                deviation += joint.factor(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) * students[i];
            deviations.is_joint.at(joint.quantities[k]) = true;
        }
    }
    return deviations;
}

void move_phases(const MissionSetup& mission, const PhaseDeviations& deviations, MissionSetup& flight) {
    for (const auto phase : all_phases) {
        const double planned_s = mission.duration_s[phase];
        if (planned_s == 0.0) continue;
        const auto level = level_of(phase);
        const auto duration = duration_of(phase);
        const double flown_s =
            std::clamp(planned_s + deviations.of.at(duration), shortest_part * planned_s, longest_part * planned_s);
        flight.duration_s[phase] = flown_s;
        if (!flight.mechanical) continue;
        double moved_w = deviations.of.at(level);
        if (deviations.is_joint.at(level) && deviations.is_joint.at(duration)) moved_w *= planned_s / flown_s;
        auto& model = flight.mechanical->phases[phase];
        const bool stretched = mission.phase_clock == mechanical::PhaseClock::stretched;
        move_level(model, moved_w, stretched ? model.duration_s : flown_s);
    }
}

/// The numbers that make a flight, in their order.
class Normals {
  public:
    explicit Normals(std::span<const double> numbers) : numbers_(numbers) {}
    double operator()() { return numbers_[next_++]; }

  private:
    std::span<const double> numbers_;
    std::size_t next_ = 0;
};

/// Every number is taken, needed or not: missions that differ in one source have the others in common.
void move_battery(const battery::BatteryIntervals& intervals, Normals& normal, battery::Battery& battery) {
    const double capacity_z = normal();
    const double voltage_z = normal();
    const double resistance_z = normal();
    const double rc_resistance_z = normal();
    const double time_constant_z = normal();
    battery.capacity_ah =
        moved(battery.capacity_ah, intervals.capacity_ah, capacity_z, least_part * battery.capacity_ah);
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

void move_component(const ComponentSpread& spread, Normals& normal, std::vector<double>& power_w) {
    const double factor = std::max(0.0, 1.0 + units::part_of(normal(), spread.common_sd_percent));
    for (std::size_t k = 0; k < power_w.size(); ++k) {
        const double node_z = normal();
        const double least_w = std::min(0.0, power_w[k]);
        power_w[k] *= factor;
        if (!spread.node_sd_w.empty()) power_w[k] = std::max(least_w, power_w[k] + node_z * spread.node_sd_w[k]);
    }
}

}  // namespace

FlightSpreads find_spreads(const MissionSetup& mission) {
    FlightSpreads spreads;
    std::vector<EstimatedSpread> estimated;
    for (const auto phase : all_phases) {
        if (mission.duration_s[phase] == 0.0) continue;
        if (mission.mechanical) find_level(mission, phase, spreads, estimated);
        find_duration(mission, phase, spreads, estimated);
    }
    spreads.of_flights = joint_spreads(estimated);
    find_wind(mission, spreads);
    find_compute(mission, spreads);
    find_battery(mission, spreads);
    return spreads;
}

std::size_t count_normals(const MissionSetup& mission) {
    constexpr std::size_t of_battery = 5;
    std::size_t count = phase_quantities + of_battery + (mission.cruise_path ? 2 : 0);
    for (const auto& component : mission.compute.components) count += 1 + component.profile.power_w.size();
    return count;
}

std::vector<double> draw_normals(std::size_t count, std::uint64_t seed, std::uint64_t index) {
    std::seed_seq words{seed & 0xFFFFFFFFU, seed >> 32U, index & 0xFFFFFFFFU, index >> 32U};
    std::mt19937_64 engine(words);
    boost::random::normal_distribution<double> normal;
    std::vector<double> normals(count);
    for (auto& number : normals) number = normal(engine);
    return normals;
}

MissionSetup flight_of(const MissionSetup& mission, const FlightSpreads& spreads, std::span<const double> normals) {
    auto flight = mission;
    const auto deviations = phase_deviations(spreads, normals);
    move_phases(mission, deviations, flight);
    Normals normal(normals.subspan(phase_quantities));
    move_battery(spreads.battery, normal, flight.battery);
    for (std::size_t i = 0; i < spreads.components.size(); ++i)
        move_component(spreads.components[i], normal, flight.compute.components[i].profile.power_w);
    if (!mission.cruise_path) return flight;
    const double wind_speed_z = normal();
    const double wind_direction_z = normal();
    fly_drawn_path(deviations.of.at(level_of(Phase::cruise)), wind_speed_z, wind_direction_z, mission, flight);
    return flight;
}

MissionSetup draw_flight(const MissionSetup& mission, const FlightSpreads& spreads, std::uint64_t seed,
                         std::uint64_t index) {
    return flight_of(mission, spreads, draw_normals(count_normals(mission), seed, index));
}

MissionSetup without_evidence(MissionSetup mission) {
    if (mission.mechanical) {
        mission.mechanical->flights.clear();
        mission.mechanical->physical.reset();
        for (const auto phase : all_phases) {
            const auto& model = mission.mechanical->phases[phase];
            mechanical::PhaseModel curve;
            curve.fourier = model.fourier;
            curve.duration_s = model.duration_s;
            mission.mechanical->phases[phase] = std::move(curve);
        }
    }
    mission.battery.intervals = {};
    for (auto& component : mission.compute.components) {
        component.profile.standard_error_w.clear();
        component.profile.is_measured.clear();
    }
    return mission;
}

}  // namespace flightwatt::mission

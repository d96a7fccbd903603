#include "mission/sampling/flight_draws.h"

#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/prediction.h"
#include "mission/sampling/joint_spread.h"
#include "mission/simulation/load_segments.h"
#include "path/cruise_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <boost/random/normal_distribution.hpp>

namespace flightwatt::mission {
namespace {

constexpr double shortest_fraction = 0.1;  ///< of a planned duration
constexpr double max_part = 10.0;          ///< of it too
constexpr double min_part = 1e-3;          ///< of what must stay positive

/// `value` moved by `z` deviations of an interval.
double moved(double value, const std::optional<Interval>& interval, double z, double least) {
    if (!interval) return value;
    const double sd = (z < 0.0 ? value - interval->low : interval->high - value) / sd_per_half_95;
    return std::max(least, value + z * sd);
}

/// The same in the logarithm.
double moved_logarithm(double value, const std::optional<Interval>& interval, double z) {
    if (!interval || interval->low <= 0.0) return moved(value, interval, z, min_part * value);
    const double sd = std::log(z < 0.0 ? value / interval->low : interval->high / value) / sd_per_half_95;
    return value * std::exp(z * sd);
}

/// The resistance of a flight to come: each quantile is as far off as those of the flights' mean and of how a flight
/// differs from it together. Not below 0.
double moved_resistance_ohm(double mean_ohm, const battery::BatteryIntervals& intervals, double z) {
    const double of_mean_ohm = moved(mean_ohm, intervals.resistance_ohm, z, 0.0);
    const auto& scatter = intervals.resistance_scatter;
    if (!scatter) return of_mean_ohm;
    const double of_flight_ohm = scatter->sd_ohm * student_from_normal(z, static_cast<double>(scatter->flights));
    return std::max(0.0, mean_ohm + std::copysign(std::hypot(of_mean_ohm - mean_ohm, of_flight_ohm), z));
}

/// Numbers of one flight: Steele, Lea and Flood's SplitMix64 (OOPSLA 2014), which is begun in no time.
class FlightNumbers {
  public:
    using result_type = std::uint64_t;

    FlightNumbers(std::uint64_t seed, std::uint64_t index) : state_(mixed(mixed(seed) + step * (index + 1))) {}

    static constexpr result_type min() { return 0; }
    static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
    result_type operator()() { return mixed(state_ += step); }

  private:
    static constexpr std::uint64_t step = 0x9e3779b97f4a7c15;

    static std::uint64_t mixed(std::uint64_t bits) {
        bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9;
        bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111eb;
        return bits ^ (bits >> 31U);
    }

    std::uint64_t state_;
};

/// A phase's level, `moved_w` from the model's.
void move_level(mechanical::PhaseModel& phase, double moved_w, double shown_s) {
    auto& curve = phase.fourier;
    const double planned_a0_w = curve.a0_w;
    curve.a0_w += moved_w;
    if (moved_w >= 0.0 || min_power_w(curve, {0.0, shown_s}).power_w >= 0.0) return;
    const double mean_w = energy_j(curve, shown_s) / shown_s - moved_w;
    if (mean_w <= 0.0) return;
    const double factor = std::max(0.0, (mean_w + moved_w) / mean_w);
    curve.a0_w = factor * planned_a0_w;
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
    flight.cruise_path = compute_cruise(plan, wind, path::InfeasibleLegPolicy::crawl, factor);
    flight.duration_s[Phase::cruise] = duration_s(*flight.cruise_path);
}

/// How far a flight's phases are from the planned.
struct PhaseDeviations {
    std::array<double, phase_quantities> of{};  ///< level [W] and duration [s] of each
    std::array<bool, phase_quantities> is_joint{};
};

PhaseDeviations phase_deviations(const FlightUncertainty& spreads, std::span<const double> normals) {
    PhaseDeviations deviations;
    for (const auto phase : all_phases) {
        deviations.of.at(level_index(phase)) = normals[level_index(phase)] * spreads.level_sd_w[phase];
        deviations.of.at(duration_index(phase)) = normals[duration_index(phase)] * spreads.duration_sd_s[phase];
    }
    for (const auto& joint : spreads.joint) {
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

void move_phases(const MissionSetup& mission, const PhaseDeviations& deviations, const PerPhase<double>& max_rise_w,
                 MissionSetup& flight) {
    for (const auto phase : all_phases) {
        const double planned_s = mission.duration_s[phase];
        if (planned_s == 0.0) continue;
        const auto level = level_index(phase);
        const auto duration = duration_index(phase);
        const double flown_s =
            std::clamp(planned_s + deviations.of.at(duration), shortest_fraction * planned_s, max_part * planned_s);
        flight.duration_s[phase] = flown_s;
        if (!flight.mechanical) continue;
        double moved_w = deviations.of.at(level);
        if (deviations.is_joint.at(level) && deviations.is_joint.at(duration)) moved_w *= planned_s / flown_s;
        moved_w = std::min(moved_w, max_rise_w[phase]);
        auto& model = flight.mechanical->phases[phase];
        model.fourier = mission.mechanical->phases[phase].fourier;
        const bool is_scaled = mission.phase_clock == mechanical::PhaseTimeScaling::scaled;
        move_level(model, moved_w, is_scaled ? model.duration_s : flown_s);
    }
}

/// Each number has its place, needed or not: missions that differ in one source have the others in common.
void move_battery(const battery::BatteryIntervals& intervals, std::span<const double> z, battery::Battery& battery) {
    battery.capacity_ah = moved(battery.capacity_ah, intervals.capacity_ah, z[0], min_part * battery.capacity_ah);
    battery.voltage_v = moved(battery.voltage_v, intervals.voltage_v, z[1], min_part * battery.voltage_v);
    battery.resistance_ohm = moved_resistance_ohm(battery.resistance_ohm, intervals, z[2]);
    if (!battery.thevenin) return;
    auto& circuit = *battery.thevenin;
    circuit.rc_resistance_ohm = moved(circuit.rc_resistance_ohm, intervals.rc_resistance_ohm, z[3], 0.0);
    // An unknown time constant is drawn over many decades: steps of a discharge are shorter than it.
    circuit.rc_time_constant_s =
        std::clamp(moved_logarithm(circuit.rc_time_constant_s, intervals.rc_time_constant_s, z[4]),
                   battery::min_time_constant_s, battery::max_time_constant_s);
    auto& voltage_v = circuit.open_circuit.voltage_v;
    const double min_v = min_part * voltage_v.front();
    // Knots near an empty pack are least certain: the curve never falls, so the ones above limit them.
    double above_v = std::numeric_limits<double>::infinity();
    for (std::size_t k = intervals.open_circuit_standard_error_v.size(); k-- > 0;) {
        const double moved_v = voltage_v[k] + z[1] * intervals.open_circuit_standard_error_v[k];
        above_v = voltage_v[k] = std::clamp(moved_v, min_v, std::max(min_v, above_v));
    }
}

void move_component(const ComponentSpread& spread, std::span<const double> z, std::vector<double>& power_w) {
    const double factor = std::max(0.0, 1.0 + units::amount_from_percent(z[0], spread.common_sd_percent));
    for (std::size_t k = 0; k < power_w.size(); ++k) {
        const double min_w = std::min(0.0, power_w[k]);
        power_w[k] *= factor;
        if (!spread.node_sd_w.empty()) power_w[k] = std::max(min_w, power_w[k] + z[k + 1] * spread.node_sd_w[k]);
    }
}

// Numbers that each flight needs for the battery and for the wind.
constexpr std::size_t battery_draws = 5;
constexpr std::size_t wind_draws = 2;
constexpr double min_initial_soc_percent = 0.1;

bool initial_charge_varies(const MissionSetup& mission) { return mission.uncertainty.initial_soc_sd_percent > 0.0; }

}  // namespace

std::size_t count_normals(const MissionSetup& mission) {
    std::size_t count = phase_quantities + battery_draws;
    for (const auto& component : mission.compute.components) count += 1 + component.profile.power_w.size();
    return count + (mission.cruise_path ? wind_draws : 0) + (initial_charge_varies(mission) ? 1 : 0);
}

std::vector<double> draw_normals(std::size_t count, std::uint64_t seed, std::uint64_t index) {
    FlightNumbers engine(seed, index);
    boost::random::normal_distribution<double> normal;
    std::vector<double> normals(count);
    for (auto& number : normals) number = normal(engine);
    return normals;
}

void apply_draw(const MissionSetup& mission, const FlightUncertainty& spreads, std::span<const double> normals,
                MissionSetup& flight) {
    const auto deviations = phase_deviations(spreads, normals);
    move_phases(mission, deviations, spreads.max_rise_w, flight);
    flight.battery = mission.battery;
    move_battery(spreads.battery, normals.subspan(phase_quantities), flight.battery);
    auto left = normals.subspan(phase_quantities + battery_draws);
    for (std::size_t i = 0; i < spreads.components.size(); ++i) {
        auto& power_w = flight.compute.components[i].profile.power_w;
        power_w = mission.compute.components[i].profile.power_w;
        move_component(spreads.components[i], left, power_w);
        left = left.subspan(1 + power_w.size());
    }
    if (mission.cruise_path) {
        const double moved_w =
            std::min(deviations.of.at(level_index(Phase::cruise)), spreads.max_rise_w[Phase::cruise]);
        fly_drawn_path(moved_w, left[0], left[1], mission, flight);
    }
    if (initial_charge_varies(mission))
        flight.initial_soc_percent =
            std::clamp(mission.initial_soc_percent + normals.back() * mission.uncertainty.initial_soc_sd_percent,
                       min_initial_soc_percent, units::percent_per_whole);
}

}  // namespace flightwatt::mission

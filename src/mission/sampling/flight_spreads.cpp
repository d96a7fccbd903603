#include "mission/sampling/flight_spreads.h"

#include "base/statistics.h"
#include "base/units.h"
#include "mechanical/prediction.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

/// Notes down a source, as drawn or not.
void note_source(FlightUncertainty& spreads, bool is_drawn, const std::string& source, const std::string& basis) {
    auto& [drawn, not_drawn] = spreads.sources;
    (is_drawn ? drawn : not_drawn).push_back(fmt::format("{} ({})", source, basis));
}

std::string student_words(double degrees_of_freedom) {
    return fmt::format("Student t with {:.4g} degree{} of freedom", degrees_of_freedom,
                       degrees_of_freedom == 1.0 ? "" : "s");
}

bool has_wind_spread(const MissionSetup& mission) {
    if (!mission.cruise_path) return false;
    const auto& wind = mission.cruise_path->plan->wind;
    return wind.speed_sd_m_per_s > 0.0 || wind.direction_sd_deg > 0.0;
}

void find_wind(const MissionSetup& mission, FlightUncertainty& spreads) {
    if (!mission.cruise_path) return;
    const auto& wind = mission.cruise_path->plan->wind;
    const auto note = [&](double sd, const std::string& what, std::string_view unit, std::string_view key) {
        note_source(spreads, sd > 0.0, what,
                    sd > 0.0 ? fmt::format("sd {:.4g} {}, stated", sd, unit) : fmt::format("[wind] states no {}", key));
    };
    note(wind.speed_sd_m_per_s, "wind speed", "m/s", "speed_sd_m_per_s");
    note(wind.direction_sd_deg, "wind direction", "degrees", "direction_sd_deg");
}

/// A quantity of each flight that counts in a phase.
template <typename Shown>
std::vector<std::optional<double>> flight_values(const MissionSetup& mission, Phase phase, const Shown& shown) {
    std::vector<std::optional<double>> values;
    for (const auto& flight : mission.mechanical->flights) {
        const auto& part = flight.phases[phase];
        values.push_back(part && part->weight > 0.0 ? shown(*part) : std::nullopt);
    }
    return values;
}

void find_level(const MissionSetup& mission, Phase phase, FlightUncertainty& spreads,
                std::vector<EstimatedSpread>& estimated) {
    const auto deviation = level_deviation(mission, phase);
    spreads.level_sd_w[phase] = deviation.sd_w;
    auto basis = deviation.basis;
    if (deviation.degrees_of_freedom < infinite_dof) {
        EstimatedSpread spread{level_index(phase), deviation.sd_w, deviation.degrees_of_freedom, {}};
        if (deviation.flights > 0) {
            spread.flight_values = flight_values(mission, phase, [](const auto& part) { return part.mean_power_w; });
            if (!is_known_of_flights(spread)) basis += ", correlated with nothing: the model has no mean_power_w";
        }
        estimated.push_back(std::move(spread));
    }
    note_source(spreads, deviation.sd_w > 0.0, fmt::format("{} level", phase_word(phase)), basis);
}

/// Durations that the mission states are fixed, unless [uncertainty] varies them.
void find_duration(const MissionSetup& mission, Phase phase, FlightUncertainty& spreads,
                   std::vector<EstimatedSpread>& estimated) {
    const auto source = fmt::format("{} duration", phase_word(phase));
    if (phase == Phase::cruise && mission.cruise_path)
        return note_source(spreads, has_wind_spread(mission), source, "as the path and the wind make it");
    auto& sd_s = spreads.duration_sd_s[phase];
    EstimatedSpread spread{duration_index(phase), 0.0, infinite_dof, {}};
    if (mission.mechanical)
        spread.flight_values =
            flight_values(mission, phase, [](const auto& part) { return std::optional(part.duration_s); });
    std::string basis = "no flights that differ: state duration_sd_s";
    if (const auto stated_s = mission.uncertainty.duration_sd_s[phase]) {
        sd_s = *stated_s;
        basis = fmt::format("sd {:.4g} s, stated", sd_s);
    } else if (mission.duration_is_stated[phase]) {
        basis = "fixed, as the mission states it without duration_sd_s";
    } else if (is_known_of_flights(spread)) {
        const auto estimate = estimate_duration(*mission.mechanical, phase, mission.duration_s[phase]);
        spread.sd = sd_s = estimate.sd_s;
        spread.degrees_of_freedom = estimate.degrees_of_freedom;
        basis = fmt::format("sd {:.4g} s, of {:.0f} flights, {}", sd_s, spread.degrees_of_freedom + 1.0,
                            student_words(spread.degrees_of_freedom));
        estimated.push_back(std::move(spread));
    }
    note_source(spreads, sd_s > 0.0, source, basis);
}

void find_compute(const MissionSetup& mission, FlightUncertainty& spreads) {
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

void find_capacity(const MissionSetup& mission, FlightUncertainty& spreads) {
    auto& interval = spreads.battery.capacity_ah;
    std::string basis = interval ? "the battery's interval" : "the battery's file has no interval";
    if (const auto percent = mission.uncertainty.capacity_sd_percent)
        basis = fmt::format("sd {:.4g} %, stated", *percent);
    else if (mission.capacity_is_stated)
        basis = "fixed, as the mission states capacity_ah without capacity_sd_percent";
    interval = capacity_interval_ah(mission);
    note_source(spreads, interval.has_value(), "battery capacity", basis);
}

void find_resistance(const battery::BatteryIntervals& intervals, FlightUncertainty& spreads) {
    std::string basis = "the battery's file has no interval";
    if (const auto& scatter = intervals.resistance_scatter)
        basis = fmt::format("sd {:.4g} ohm, of {} flights, {}, {}", scatter->sd_ohm, scatter->flights,
                            student_words(static_cast<double>(scatter->flights)),
                            intervals.resistance_ohm ? "with the interval of their mean" : "their mean as if known");
    else if (intervals.resistance_ohm)
        basis = "the battery's interval; not how flights differ";
    note_source(spreads, intervals.resistance_scatter || intervals.resistance_ohm, "battery resistance", basis);
}

void find_battery(const MissionSetup& mission, FlightUncertainty& spreads) {
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
    find_resistance(intervals, spreads);
}

}  // namespace

double mean_level_w(const MissionSetup& mission, Phase phase) {
    if (phase == Phase::cruise && mission.cruise_path) return mean_power_w(*mission.cruise_path);
    const double duration_s = mission.duration_s[phase];
    const auto flown = time_scaled_model(mission.mechanical->phases[phase], duration_s, mission.phase_clock);
    return std::abs(energy_j(flown, duration_s) / duration_s);
}

double highest_measured_power_w(const mechanical::MechanicalModel& model) {
    double highest_w = -std::numeric_limits<double>::infinity();
    for (const auto phase : all_phases) {
        if (const auto& spread = model.phases[phase].spread; spread && !spread->high_w.empty())
            highest_w = std::max(highest_w, std::ranges::max(spread->high_w));
        for (const auto& flight : model.flights)
            if (const auto& part = flight.phases[phase])
                highest_w = std::max(highest_w, part->mean_power_w.value_or(highest_w));
    }
    return highest_w > 0.0 ? highest_w : std::numeric_limits<double>::infinity();
}

bool has_flight_variability(const MissionSetup& mission) {
    return mission.mechanical && std::ranges::all_of(all_phases, [&](Phase phase) {
               return !(mission.duration_s[phase] > 0.0) || level_deviation(mission, phase).is_between_flights;
           });
}

bool has_known_probability(const MissionSetup& mission) {
    return !mission.mechanical || has_flight_variability(mission);
}

MeanPowerDeviation level_deviation(const MissionSetup& mission, Phase phase) {
    const auto& model = mission.mechanical->phases[phase];
    const auto of = [](double sd_w, const std::string& basis) { return fmt::format("sd {:.4g} W, {}", sd_w, basis); };
    if (const auto percent = mission.uncertainty.level_sd_percent[phase]) {
        const double sd_w = units::amount_from_percent(mean_level_w(mission, phase), *percent);
        return {sd_w, of(sd_w, "stated"), true};
    }
    if (phase == Phase::cruise && mission.cruise_level && mission.cruise_level->sd_w) {
        const auto& [mean_w, sd_w, freedom] = *mission.cruise_level;
        return {*sd_w, of(*sd_w, "of the flights' deviations from the physical model, " + student_words(freedom)), true,
                0, freedom};
    }
    if (const auto& spread = model.level_spread) {
        const double sd_w =
            spread->between_flight_sd_w * std::sqrt(1.0 + forecast_of(*mission.mechanical, phase).weight_square_sum);
        const auto freedom = static_cast<double>(spread->flights - 1);
        return {sd_w, of(sd_w, fmt::format("of {} flights, {}", spread->flights, student_words(freedom))), true,
                spread->flights, freedom};
    }
    if (const auto& errors = model.errors)
        return {errors->curve_w, of(errors->curve_w, "the fit's standard error; not how flights differ"), false, 0,
                errors->degrees_of_freedom};
    return {0.0, "the model has no spread: fit two flights or more"};
}

void require_flight_variability(const MissionSetup& mission) {
    for (const auto phase : all_phases) {
        if (!(mission.duration_s[phase] > 0.0) || level_deviation(mission, phase).is_between_flights) continue;
        throw InputError({mission.file},
                         fmt::format("the mechanical model does not show how the power of flights differs in {}{}",
                                     phase_word(phase),
                                     mission.mechanical && mission.mechanical->phases[phase].flights == 1
                                         ? ", as one flight alone shows the whole of it"
                                         : ""),
                         "fit it to two flights or more (flightwatt fit FLIGHT... -o MODEL.toml), or state it: "
                         "[uncertainty] with level_sd_percent");
    }
}

double energy_degrees_of_freedom(const MissionSetup& mission, const FlightUncertainty& spreads) {
    if (!mission.mechanical) return infinite_dof;
    mechanical::EnergyEstimate energy;
    for (const auto phase : all_phases) {
        if (mission.duration_s[phase] == 0.0) continue;
        const auto add = [&](std::size_t quantity, double sd_j) {
            double freedom = infinite_dof;
            for (const auto& joint : spreads.joint)
                if (std::ranges::count(joint.quantities, quantity) > 0) freedom = joint.degrees_of_freedom;
            add_variance(energy, sd_j * sd_j, freedom);
        };
        add(level_index(phase), spreads.level_sd_w[phase] * mission.duration_s[phase]);
        add(duration_index(phase), mean_level_w(mission, phase) * spreads.duration_sd_s[phase]);
    }
    return energy.satterthwaite_sum > 0.0 ? energy.variance_wh2 * energy.variance_wh2 / energy.satterthwaite_sum
                                          : infinite_dof;
}

FlightUncertainty collect_uncertainty(const MissionSetup& mission) {
    FlightUncertainty spreads;
    std::vector<EstimatedSpread> estimated;
    const double highest_w =
        mission.mechanical ? highest_measured_power_w(*mission.mechanical) : std::numeric_limits<double>::infinity();
    for (const auto phase : all_phases) {
        if (mission.duration_s[phase] == 0.0) continue;
        if (mission.mechanical) {
            find_level(mission, phase, spreads, estimated);
            spreads.max_rise_w[phase] = std::max(0.0, power_margin * highest_w - mean_level_w(mission, phase));
        }
        find_duration(mission, phase, spreads, estimated);
    }
    spreads.joint = estimate_joint_distributions(estimated);
    find_wind(mission, spreads);
    find_compute(mission, spreads);
    find_battery(mission, spreads);
    if (const double sd_percent = mission.uncertainty.initial_soc_sd_percent; sd_percent > 0.0)
        note_source(spreads, true, "initial charge", fmt::format("sd {:.4g} points, stated", sd_percent));
    return spreads;
}

}  // namespace flightwatt::mission

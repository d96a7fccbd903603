#include "live/prediction.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "live/state/voltage_check.h"
#include "path/path.h"
#include "path/trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

using battery::ConstantLoad;
using flight::Phase;
using mechanical::DurationEstimate;
using mechanical::FlightProgress;
using path::PathFix;

/// Throws NoResultError for a motion whose power the model does not know.
void require_predictable(const mechanical::PhysicalModel& model, const mechanical::FlightState& motion,
                         bool is_rotorcraft) {
    if (may_predict_power(model, motion, is_rotorcraft)) return;
    const auto& speeds = model.airspeed_m_per_s;
    throw NoResultError(fmt::format(
        "the power at {:.3g} m/s with {:+.3g} m/s of climb is unknown: the model's flights flew {:.1f} to {:.1f} m/s, "
        "with {:+.1f} to {:+.1f} m/s of climb; state a motion near these",
        motion.airspeed_m_per_s, motion.climb_m_per_s, speeds.low, speeds.high, model.climb_m_per_s.low,
        model.climb_m_per_s.high));
}

void warn_of_extrapolation(const mechanical::PhysicalModel& model, const mechanical::FlightState& motion,
                           Remarks& remarks) {
    if (is_within_flown_range(model, motion)) return;
    const auto& speeds = model.airspeed_m_per_s;
    remarks.warnings.push_back(
        fmt::format("{:.1f} m/s at {:+.1f} m/s of climb is outside the range of the model's flights: {:.1f} to {:.1f} "
                    "m/s, {:+.1f} to {:+.1f} m/s of climb",
                    motion.airspeed_m_per_s, motion.climb_m_per_s, speeds.low, speeds.high, model.climb_m_per_s.low,
                    model.climb_m_per_s.high));
}

/// `level`: relative deviation of the flight's power from the model.
void warn_of_level(const mechanical::PhysicalModel& model, double level, Remarks& remarks) {
    constexpr double max_sds = 3.0;
    const double sd = model.level_sd.value_or(0.0);
    if (std::abs(level) <= max_sds * sd) return;
    remarks.warnings.push_back(fmt::format(
        "the power of this flight differs from the model by {:+.1f} %, its flights by {:.1f} % (1 sd): check aircraft, "
        "load and propeller",
        units::percentage(level, 1.0), units::percentage(sd, 1.0)));
}

/// The position on the path, at most its end: by the aircraft's positions, by the time since the cruise began, or by
/// --remaining.
double seconds_on_path(const PredictionInput& input, const FlightProgress& flown, const std::optional<PathFix>& fix,
                       double takeoff_s) {
    const auto& path = input.path->flown();
    if (input.remaining_s) {
        const double left_s = std::max(0.0, *input.remaining_s - takeoff_s);
        if (left_s <= path.duration_s) return path.duration_s - left_s;
        throw UsageError(fmt::format("--remaining {:g}: the mission's path takes only {:.1f} s", *input.remaining_s,
                                     path.duration_s));
    }
    return std::min(fix && fix->path_time_s ? *fix->path_time_s : flown.cruise_s(), path.duration_s);
}

double length_m(const path::LocalPosition& of) { return std::hypot(of.east_m, of.north_m); }

/// The way from a place of the path to its start; std::nullopt where the wind is too strong.
std::optional<path::TrajectorySegment> way_home(const path::PlannedPath& plan, const path::PathPosition& position,
                                                const path::LocalPosition& away) {
    constexpr double least_m = 1.0;
    const auto at = local_position_at(plan.path, position);
    const path::LocalPosition home{-at.east_m - away.east_m, -at.north_m - away.north_m};
    auto way = plan.path.elements[std::min(position.element, plan.path.elements.size() - 1)];
    way.shape =
        path::Leg{std::max(length_m(home), least_m), std::atan2(home.east_m, home.north_m) * units::degree_per_rad};
    way.altitude_change_m = 0.0;
    const auto flown = compute_trajectory({{way}}, plan.wind, path::InfeasibleLegPolicy::crawl);
    if (!flown.infeasible_elements.empty()) return std::nullopt;
    auto segment = flown.pieces.front();
    if (length_m(home) < least_m) segment.time_s = 0.0;
    return segment;
}

/// A cruise that continues beyond the mission's, at its mean power until now; from away of the path's end the way home
/// is still ahead.
mechanical::RemainingCruise predict_overtime(const PredictionInput& input, const FlightProgress& flown,
                                             double overtime_s, Prediction& prediction, Remarks& remarks) {
    mechanical::RemainingCruise rest;
    rest.measured_w = units::joule_from_wh(flown.cruise_energy_wh) / flown.cruise_s();
    rest.remaining_mean_w = rest.measured_w;
    prediction.overtime_s = std::max(overtime_s, 0.0);
    std::string from = "a landing from now";
    if (input.path && length_m(prediction.away) > 0.0) {
        const auto& plan = input.path->plan();
        const auto home = way_home(plan, {plan.path.elements.size(), 0.0}, prediction.away);
        if (!home)
            throw NoResultError(fmt::format("the wind is too strong for the way home, {:.0f} m from the path's end",
                                            length_m(prediction.away)));
        from = fmt::format("the way home, from {:.0f} m off the path's end, and a landing", length_m(prediction.away));
        prediction.remaining_s = home->time_s;
        auto ahead = predict_remaining_physical(plan.power, flown,
                                                {term_values(home->motion, plan.power.load), prediction.remaining_s});
        rest.energy = ahead.energy;
        rest.gain = ahead.gain;
        rest.expected_w = ahead.expected_w;
    }
    remarks.warnings.push_back(fmt::format(
        "the mission's cruise was completed {:.0f} s ago: the charge at landing is that of {}, and the time "
        "to the reserve is at the mean power of this cruise, {:.1f} W",
        *prediction.overtime_s, from, rest.measured_w));
    return rest;
}

void remark_on(const PathFix& fix, double away_m, double cruise_s, Remarks& remarks) {
    if (!fix.path_time_s) {
        remarks.warnings.emplace_back(
            "the positions of this flight are not on the mission's path: its position on the path is by the time since "
            "the cruise began");
        return;
    }
    if (!fix.is_on_path) {
        remarks.warnings.push_back(fmt::format(
            "the flight is {:.0f} m from where it left the mission's path: predicted from there on, without "
            "the way back",
            away_m));
    }
    constexpr double min_noted_s = 30.0;
    const double ahead_s = *fix.path_time_s - cruise_s;
    if (std::abs(ahead_s) < min_noted_s) return;
    remarks.notes.push_back(fmt::format("by its position the flight is {:.0f} s {} the mission's plan",
                                        std::abs(ahead_s), ahead_s > 0.0 ? "ahead of" : "behind"));
}

mechanical::RemainingCruise predict_along_path(const PredictionInput& input, const FlightProgress& flown,
                                               const std::optional<PathFix>& fix, Prediction& prediction,
                                               Remarks& remarks) {
    prediction.on_path_s = seconds_on_path(input, flown, fix, prediction.takeoff_s);
    prediction.is_from_position = fix && fix->path_time_s;
    if (fix && fix->at && !(fix->is_on_path && fix->path_time_s))
        prediction.away = *fix->at - local_position_at(input.path->plan().path,
                                                       position_at(input.path->flown(), *prediction.on_path_s));
    const double path_s = input.path->flown().duration_s;
    if (!input.remaining_s && *prediction.on_path_s >= path_s)
        return predict_overtime(input, flown, flown.cruise_s() - path_s, prediction, remarks);
    if (fix) remark_on(*fix, length_m(prediction.away), flown.cruise_s(), remarks);
    const auto rest = input.path->predict(flown, position_at(input.path->flown(), *prediction.on_path_s));
    if (rest.infeasible_fraction > 0.0) {
        remarks.warnings.push_back(fmt::format(
            "the remaining path is infeasible in {:.0f} % of the likely winds of [wind], which are excluded",
            units::percentage(rest.infeasible_fraction, 1.0)));
    }
    prediction.remaining_s = rest.duration_s;
    for (const auto& segment : rest.trajectory.pieces)
        prediction.remaining_power.push_back({power_w(input.path->plan().power, segment.motion), segment.time_s});
    return rest.cruise;
}

/// Cruise and landing by what was measured of take-off and cruise.
mechanical::RemainingCruise predict_phases(const PredictionInput& input, const FlightProgress& flown,
                                           Prediction& prediction) {
    flight::PerPhase<std::optional<mechanical::WeightedPhase>> model;
    auto of_flight = flown.phases;
    if (flown.cruise_s() > 0.0) of_flight[Phase::cruise] = {flown.cruise_s(), flown.cruise_energy_wh};
    for (const auto phase : flight::all_phases) {
        model[phase] = forecast_of(input.model, phase);
        if (phase != Phase::cruise && !model[phase]->model.level_spread) of_flight[phase] = {};
    }
    const auto rest =
        predict_remaining_flight(model, correlate_phases(input.model), of_flight,
                                 {{prediction.takeoff_s, prediction.remaining_s, prediction.landing_s}}, input.prior);
    prediction.takeoff = rest.phases[Phase::takeoff].energy;
    prediction.landing = rest.phases[Phase::landing].energy;
    prediction.remaining_energy = rest.total;
    return rest.phases[Phase::cruise];
}

mechanical::RemainingCruise predict_cruise(const PredictionInput& input, const FlightProgress& flown,
                                           const std::optional<PathFix>& fix, Prediction& prediction,
                                           Remarks& remarks) {
    prediction.uses_physical_model = input.path || input.motion;
    if (prediction.uses_physical_model && !flown.motion.no_bins_reason.empty())
        remarks.warnings.push_back(
            fmt::format("the deviation of this flight from the model is unknown: {}", flown.motion.no_bins_reason));
    if (input.path) return predict_along_path(input, flown, fix, prediction, remarks);
    const double left_s =
        input.remaining_s ? *input.remaining_s - prediction.takeoff_s : input.cruise_s.value() - flown.cruise_s();
    if (left_s < 0.0 && !input.remaining_s) return predict_overtime(input, flown, -left_s, prediction, remarks);
    prediction.remaining_s = std::max(0.0, left_s);
    if (!input.motion) return predict_phases(input, flown, prediction);
    auto model = input.model.physical.value();
    if (flown.motion.payload_known) model.load.payload_kg = flown.motion.load.payload_kg;
    require_predictable(model, *input.motion, input.model.is_rotorcraft);
    warn_of_extrapolation(model, *input.motion, remarks);
    return predict_remaining_physical(model, flown, {term_values(*input.motion, model.load), prediction.remaining_s});
}

bool is_taking_off(const FlightProgress& flown) { return !(flown.cruise_s() > 0.0); }

/// Estimates the duration of a phase ahead: as it is stated, else by the flights of the model, and by the take-off of
/// this flight where that was received.
DurationEstimate duration_ahead(const PredictionInput& input, Phase phase, double planned_s,
                                const FlightProgress& flown) {
    if (const auto& stated_s = input.duration_sd_s[phase]) return {planned_s, *stated_s};
    const double takeoff_s = flown.phases[Phase::takeoff].duration_s;
    return takeoff_s > 0.0 && !is_taking_off(flown)
               ? estimate_duration_after_takeoff(input.model, phase, planned_s, takeoff_s)
               : estimate_duration(input.model, phase, planned_s);
}

/// Estimates the rest of a take-off in progress, at least 0 s. Throws NoResultError where the model has no variability of
/// take-offs.
DurationEstimate takeoff_ahead(const PredictionInput& input, const FlightProgress& flown, Remarks& remarks) {
    remarks.notes.emplace_back(
        "the aircraft has not held its height yet: when its take-off ends is by the model's flights, and the power of "
        "its cruise is known by its take-off only");
    auto rest = duration_ahead(input, Phase::takeoff, input.takeoff_s, flown);
    rest.mean_s = std::max(0.0, rest.mean_s - (flown.until_s - flown.lift_off_s));
    if (rest.mean_s > 0.0 && !input.model.phases[Phase::takeoff].level_spread)
        throw NoResultError("the aircraft takes off, and the model has no variability of take-offs between flights");
    return rest;
}

/// The energies of the remaining take-off and of the landing, next to a cruise that was predicted by itself.
void add_other_phases(const PredictionInput& input, Prediction& prediction) {
    if (prediction.takeoff_s > 0.0)
        prediction.takeoff = mechanical::predict_remaining_before_flight(
            forecast_of(input.model, Phase::takeoff), prediction.flown.until_s - prediction.flown.lift_off_s,
            prediction.takeoff_s);
    if (prediction.landing_s > 0.0)
        prediction.landing =
            mechanical::predict_before_flight(forecast_of(input.model, Phase::landing), prediction.landing_s);
    prediction.remaining_energy = sum_of(sum_of(prediction.takeoff, prediction.cruise.energy), prediction.landing);
}

/// Adds to the variances how long the phases ahead may take. Where the time until the landing is stated, a longer
/// take-off shortens the cruise.
void add_durations(const PredictionInput& input, const DurationEstimate& takeoff, const DurationEstimate& landing,
                   Prediction& prediction) {
    const auto add = [&](const DurationEstimate& duration, double power_w, mechanical::EnergyEstimate& of_phase) {
        const double sd_wh = units::wh_from_joule(power_w * duration.sd_s);
        for (auto* energy : {&of_phase, &prediction.remaining_energy})
            add_variance(*energy, sd_wh * sd_wh, duration.degrees_of_freedom);
    };
    const double cruise_w = prediction.cruise.remaining_mean_w;
    add(takeoff, mean_power_w(input.model.phases[Phase::takeoff]) - (input.remaining_s ? cruise_w : 0.0),
        prediction.takeoff);
    if (landing.mean_s > 0.0)
        add(landing, units::joule_from_wh(prediction.landing.energy_wh) / landing.mean_s, prediction.landing);
    if (!input.path && !input.remaining_s && !prediction.overtime_s)
        add(duration_ahead(input, Phase::cruise, input.cruise_s.value(), prediction.flown), cruise_w,
            prediction.cruise.energy);
}

/// From the whole record of the flight so far.
BatteryPrediction predict_battery(const PredictionInput& input, const flight::FlightData& data,
                                  const Prediction& prediction, Remarks& remarks) {
    for (const auto& warning : battery_warnings(*input.battery))
        remarks.warnings.push_back(fmt::format("{}: {}", input.battery_file, warning));
    const auto records = battery::discharge_records(data);
    remarks.notes.insert(remarks.notes.end(), records.notes.begin(), records.notes.end());
    const auto& record = records.records.back();
    const auto initial = initial_charge(input, record);
    BatteryNow now{state_after(*input.battery, record, initial.soc_percent), record.charge_ah.back(), initial};
    const auto by_voltage = check_voltage(*input.battery, record, initial.soc_percent);
    const bool is_lower = by_voltage && by_voltage->residual_v <= -contradicting_v(by_voltage->explained_v) &&
                          by_voltage->soc_percent < now.state.soc_percent;
    if (is_lower) {
        remarks.warnings.push_back(voltage_warning(now.state.soc_percent, by_voltage->soc_percent));
        now = {
            {by_voltage->soc_percent, now.state.rc_voltage_v}, 0.0, {by_voltage->soc_percent, by_voltage->sd_percent}};
    }
    auto result = forecast_battery(*input.battery, input.limits, now, prediction);
    result.initial_soc_is_current = is_lower;
    return result;
}

/// Throws InputError where the model allows no prediction.
void require_predicting(const PredictionInput& input, const std::string& file) {
    if (input.path || input.motion)
        require_physical(input.model, file, "--mission");
    else
        require_interval(input.model, Phase::cruise, file);
    if (input.landing_s > 0.0) require_interval(input.model, Phase::landing, file);
}

PredictionInput unchecked_input(const mission::MissionSetup& setup) {
    require_single_flight(setup);
    PredictionInput input{setup.mechanical.value(), mechanical::CruisePrior::curve, setup.duration_s[Phase::takeoff],
                          setup.duration_s[Phase::landing]};
    input.limits = {setup.cutoff_voltage_v, setup.reserve_soc_percent};
    input.uncertain = setup.uncertain;
    for (const auto phase : flight::all_phases) {
        input.duration_sd_s[phase] = setup.uncertainty.duration_sd_s[phase];
        if (!input.duration_sd_s[phase] && setup.duration_is_stated[phase]) input.duration_sd_s[phase] = 0.0;
    }
    if (setup.cruise_path)
        input.path = std::make_shared<const path::PathForecast>(*setup.cruise_path->plan);
    else
        input.cruise_s = setup.duration_s[Phase::cruise];
    if (!setup.cruise_path && setup.airspeed_m_per_s)
        input.motion = mechanical::FlightState{.airspeed_m_per_s = *setup.airspeed_m_per_s};
    return input;
}

/// The flight home from a time on the path, or as far away from there as the aircraft is; std::nullopt where the wind is
/// too strong. Without a path the landing begins where the aircraft is.
std::optional<ConstantLoad> flight_home(const PredictionInput& input, double on_path_s, const path::LocalPosition& away,
                                        double power_factor) {
    if (!input.path) return ConstantLoad{};
    const auto& plan = input.path->plan();
    const auto home = way_home(plan, position_at(input.path->flown(), on_path_s), away);
    if (!home) return std::nullopt;
    return ConstantLoad{mechanical::power_w(plan.power, home->motion) * power_factor, home->time_s};
}

double duration_s(const std::vector<ConstantLoad>& loads) {
    double sum_s = 0.0;
    for (const auto& load : loads) sum_s += load.duration_s;
    return sum_s;
}

/// Discharges the battery by the first `time_s` of the loads, which are removed; false where the battery fails.
bool advance(const PredictionInput& input, double time_s, std::vector<ConstantLoad>& ahead,
             battery::BatteryState& state) {
    while (time_s > 0.0 && !ahead.empty()) {
        auto& load = ahead.front();
        const double taken_s = std::min(time_s, load.duration_s);
        if (taken_s > 0.0) {
            const auto end =
                discharge_constant_load(*input.battery, state, {load.power_w, taken_s}, input.limits.cutoff_voltage_v);
            if (end.ended_at_s() || end.undeliverable) return false;
            state = end;
        }
        time_s -= taken_s;
        load.duration_s -= taken_s;
        if (!(load.duration_s > 0.0)) ahead.erase(ahead.begin());
    }
    return true;
}

/// Returns the ratio of the high end of the remaining energy's interval to its expectation.
double high_energy_factor(const Prediction& prediction) {
    const double expected_wh = prediction.remaining_energy.energy_wh;
    return expected_wh > 0.0 ? prediction.interval.high / expected_wh : 1.0;
}

}  // namespace

void require_interval(const mechanical::MechanicalModel& model, Phase phase, const std::string& file) {
    if (model.phases[phase].level_spread) return;
    throw InputError({file},
                     fmt::format("the model does not show how the power of flights differs in {}", phase_word(phase)),
                     "fit it to two flights or more: flightwatt fit FLIGHT... -o MODEL.toml");
}

void require_physical(const mechanical::MechanicalModel& model, const std::string& file, const std::string& option) {
    if (model.physical && model.physical->level_sd) return;
    throw InputError(
        {file}, model.physical ? "its [physical] is fitted to a single flight" : "it has no [physical]",
        fmt::format("{} needs one of two flights or more: flightwatt fit --model-kind physical FLIGHT...", option));
}

ModelDeviation model_deviation(const Prediction& prediction, const PredictionInput& input) {
    if (!(prediction.flown.cruise_s() > 0.0)) return {};
    if (prediction.uses_physical_model) {
        const auto& model = input.model.physical.value();
        const double level = prediction.cruise.gain;
        if (!model.level_sd || prediction.flown.motion.bins.empty()) return {};
        const double reach = *model.level_sd * student_t_half_width(model.degrees_of_freedom);
        return {
            std::abs(level) / reach,
            fmt::format("the power of this flight differs from the model by {:+.1f} %, 95 of 100 flights by {:.1f} %",
                        units::percentage(level, 1.0), units::percentage(reach, 1.0))};
    }
    const auto expected =
        predict_before_flight(forecast_of(input.model, flight::Phase::cruise), prediction.flown.cruise_s());
    const auto interval = interval_95(expected);
    if (!interval) return {};
    const double measured_wh = prediction.flown.cruise_energy_wh;
    return {std::abs(measured_wh - expected.energy_wh) / (interval->high - expected.energy_wh),
            fmt::format("the cruise so far took {:.3f} Wh; 95 of 100 flights of the model take {:.3f} to {:.3f} Wh",
                        measured_wh, interval->low, interval->high)};
}

InitialCharge initial_charge(const PredictionInput& input, const battery::DischargeRecord& flown) {
    return input.initial_soc_percent ? InitialCharge{*input.initial_soc_percent}
                                     : initial_charge_by_voltage(input, flown);
}

InitialCharge initial_charge_by_voltage(const PredictionInput& input, const battery::DischargeRecord& flown) {
    const auto& battery = input.battery.value();
    if (!battery.thevenin) {
        throw InputError({input.battery_file}, "the voltage of this battery does not depend on its state of charge",
                         "give --initial-soc PERCENT");
    }
    const double rest_v = flown.resting_voltage_v + battery.resistance_ohm * flown.resting_current_a;
    constexpr double most_of_full = 1.06;  // high-voltage cells, and sensors that are 2 % off
    constexpr double least_of_empty = 0.85;
    const double full_v = open_circuit_voltage_v(battery, units::percent_per_whole);
    const double empty_v = open_circuit_voltage_v(battery, 0.0);
    if (rest_v > most_of_full * full_v || rest_v < least_of_empty * empty_v)
        throw InputError({input.battery_file},
                         fmt::format("the pack of the flight has {:.1f} V at rest, and this one {:.1f} V when full and "
                                     "{:.1f} V when empty",
                                     rest_v, full_v, empty_v),
                         "give the battery of this aircraft");
    return {battery::resting_soc_percent(battery, rest_v), battery::resting_soc_sd_percent(battery, rest_v)};
}

Prediction predict_flight(const PredictionInput& input, const FlightProgress& flown, const flight::FlightData& data,
                          Remarks& remarks) {
    std::optional<PathFix> fix;
    if (input.path && !input.remaining_s && !is_taking_off(flown))
        fix = locate_on_path(*input.path, data, flown.cruise_start_s, flown.until_s);
    auto prediction = predict_energy(input, flown, fix, remarks);
    if (input.battery) prediction.battery = predict_battery(input, data, prediction, remarks);
    return prediction;
}

Prediction predict_energy(const PredictionInput& input, const FlightProgress& flown, const std::optional<PathFix>& fix,
                          Remarks& remarks) {
    Prediction prediction;
    prediction.flown = flown;
    const auto takeoff = is_taking_off(flown) ? takeoff_ahead(input, flown, remarks) : mechanical::DurationEstimate();
    const auto landing = duration_ahead(input, Phase::landing, input.landing_s, flown);
    prediction.takeoff_s = takeoff.mean_s;
    prediction.landing_s = landing.mean_s;
    prediction.landing_sd_s = landing.sd_s;
    prediction.cruise = predict_cruise(input, flown, fix, prediction, remarks);
    if (prediction.uses_physical_model) warn_of_level(input.model.physical.value(), prediction.cruise.gain, remarks);
    if (prediction.uses_physical_model || prediction.overtime_s) add_other_phases(input, prediction);
    add_durations(input, takeoff, landing, prediction);
    for (const auto& [energy, what] :
         {std::pair{prediction.cruise.energy, "rest of the cruise"}, {prediction.landing, "landing"}})
        if (!(energy.energy_wh >= 0.0))
            throw NoResultError(
                fmt::format("the model predicts {:.3g} Wh for the {}: its flights do not determine that "
                            "power, or this flight differs from them",
                            energy.energy_wh, what));
    prediction.interval = interval_95(prediction.remaining_energy).value();
    return prediction;
}

double energy_j(const std::vector<ConstantLoad>& loads) {
    double sum_j = 0.0;
    for (const auto& load : loads) sum_j += load.power_w * load.duration_s;
    return sum_j;
}

std::vector<ConstantLoad> remaining_power(const Prediction& prediction, double factor) {
    auto ahead = prediction.remaining_power;
    if (const double planned_j = energy_j(ahead); planned_j > 0.0) {
        const double cruise_j = units::joule_from_wh(prediction.cruise.energy.energy_wh);
        for (auto& load : ahead) load.power_w = load.power_w * factor * cruise_j / planned_j;
    } else {
        ahead = {{prediction.cruise.remaining_mean_w * factor, prediction.remaining_s}};
    }
    const double takeoff_j = units::joule_from_wh(prediction.takeoff.energy_wh);
    if (prediction.takeoff_s > 0.0)
        ahead.insert(ahead.begin(), {takeoff_j / prediction.takeoff_s * factor, prediction.takeoff_s});
    const double landing_j = units::joule_from_wh(prediction.landing.energy_wh);
    if (prediction.landing_s > 0.0) ahead.push_back({landing_j / prediction.landing_s * factor, prediction.landing_s});
    return ahead;
}

battery::BatteryState state_for(const BatteryNow& now, double nominal_ah, double capacity_ah, double more_percent) {
    auto state = now.state;
    state.soc_percent +=
        more_percent + units::percentage(now.drawn_ah, nominal_ah) - units::percentage(now.drawn_ah, capacity_ah);
    state.soc_percent = std::clamp(state.soc_percent, 0.0, units::percent_per_whole);
    return state;
}

BatteryPrediction forecast_battery(const battery::Battery& battery, const battery::LandingLimits& limits,
                                   const BatteryNow& now, const Prediction& prediction) {
    const auto forecast = [&](const battery::Battery& pack, const battery::BatteryState& state, double factor) {
        const double cruise_w = prediction.cruise.remaining_mean_w + prediction.cruise.beyond_w;
        return battery::forecast_landing(pack, state, remaining_power(prediction, factor),
                                         cruise_w * (prediction.overtime_s ? 1.0 : factor), limits);
    };
    const auto& interval = battery.intervals.capacity_ah;
    auto smaller = battery;
    if (interval) smaller.capacity_ah = interval->low;
    const auto least =
        state_for(now, battery.capacity_ah, smaller.capacity_ah, -normal_half_width() * now.initial.sd_percent);
    return {forecast(battery, now.state, 1.0), forecast(smaller, least, high_energy_factor(prediction)), limits,
            interval.has_value(), now.initial};
}

ReturnDeadline latest_return(const PredictionInput& input, const Prediction& prediction, battery::BatteryState now) {
    constexpr double min_step_s = 10.0;
    constexpr double max_steps = 40.0;
    auto ahead = remaining_power(prediction, high_energy_factor(prediction));
    ConstantLoad landing;
    if (prediction.landing_s > 0.0) {
        landing = ahead.back();
        ahead.pop_back();
    }
    const double planned_j = energy_j(prediction.remaining_power);
    const double power_factor = planned_j > 0.0 ? energy_j(ahead) / planned_j : 1.0;
    if (prediction.overtime_s) {
        const double cruise_w = prediction.cruise.remaining_mean_w + prediction.cruise.beyond_w;
        ahead = {{cruise_w, 0.0}};
        ahead.front().duration_s = forecast_landing(*input.battery, now, ahead, cruise_w, input.limits).endurance_s;
    }
    const auto keeps_reserve_after = [&](double in_s) {
        const auto home = flight_home(input, prediction.on_path_s.value_or(0.0) + in_s, prediction.away, power_factor);
        if (!home) return false;
        const std::vector<ConstantLoad> loads{*home, landing};
        return forecast_landing(*input.battery, now, loads, 0.0, input.limits).keeps_reserve;
    };
    const double total_s = duration_s(ahead);
    const double step_s = std::max(min_step_s, total_s / max_steps);
    ReturnDeadline deadline;
    double in_s = 0.0;
    while (keeps_reserve_after(in_s)) {
        deadline.latest_in_s = in_s;
        deadline.path_can_be_flown = in_s >= total_s && !prediction.overtime_s;
        const double next_s = std::min(in_s + step_s, total_s);
        if (in_s >= total_s || !advance(input, next_s - in_s, ahead, now)) break;
        in_s = next_s;
    }
    return deadline;
}

TimeCurve predict_soc_curve(const PredictionInput& input, const Prediction& prediction, battery::BatteryState now,
                            double now_s) {
    constexpr double min_step_s = 10.0;
    constexpr double max_points = 100.0;
    auto ahead = remaining_power(prediction);
    const double total_s = duration_s(ahead);
    const double step_s = std::max(min_step_s, total_s / max_points);
    TimeCurve curve{{now_s}, {now.soc_percent}};
    for (double in_s = 0.0; in_s < total_s;) {
        const double next_s = std::min(in_s + step_s, total_s);
        if (!advance(input, next_s - in_s, ahead, now)) break;
        in_s = next_s;
        curve.time_s.push_back(now_s + in_s);
        curve.value.push_back(now.soc_percent);
    }
    return curve;
}

PredictionInput input_from_mission(const mission::MissionSetup& setup, const std::string& file) {
    auto input = unchecked_input(setup);
    input.battery = setup.battery;
    input.battery->intervals.capacity_ah = capacity_interval_ah(setup);
    input.battery_file = file;
    if (!setup.battery.thevenin) input.initial_soc_percent = setup.initial_soc_percent;
    try {
        require_predicting(input, file);
    } catch (const InputError& error) {
        input.no_prediction_reason = error.what();
    }
    return input;
}

PredictionInput energy_input_from_mission(const mission::MissionSetup& setup, const std::string& file) {
    auto input = unchecked_input(setup);
    require_predicting(input, file);
    return input;
}

PredictionInput input_from_model(mechanical::MechanicalModel model, const std::string& file, double remaining_s) {
    for (const auto phase : {Phase::cruise, Phase::landing}) require_interval(model, phase, file);
    const double takeoff_s = model.phases[Phase::takeoff].duration_s;
    const double landing_s = model.phases[Phase::landing].duration_s;
    return {std::move(model), mechanical::CruisePrior::curve, takeoff_s, landing_s, {}, remaining_s};
}

}  // namespace flightwatt::live

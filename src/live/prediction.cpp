#include "live/prediction.h"

#include "base/error.h"
#include "base/units.h"
#include "path/path.h"
#include "path/trajectory.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

using battery::ConstantLoad;
using mechanical::FlightProgress;
using path::PathFix;

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
double seconds_on_path(const PredictionInput& input, const FlightProgress& flown, const std::optional<PathFix>& fix) {
    const auto& path = input.path->flown();
    if (input.remaining_s) {
        if (*input.remaining_s <= path.duration_s) return path.duration_s - *input.remaining_s;
        throw UsageError(fmt::format("--remaining {:g}: the mission's path takes only {:.1f} s", *input.remaining_s,
                                     path.duration_s));
    }
    return std::min(fix && fix->path_time_s ? *fix->path_time_s : flown.cruise_s(), path.duration_s);
}

/// A cruise that continues beyond the mission's, at its mean power until now.
mechanical::RemainingCruise predict_overtime(const FlightProgress& flown, double overtime_s, Prediction& prediction,
                                             Remarks& remarks) {
    mechanical::RemainingCruise rest;
    rest.measured_w = units::joule_from_wh(flown.cruise_energy_wh) / flown.cruise_s();
    rest.remaining_mean_w = rest.measured_w;
    prediction.overtime_s = std::max(overtime_s, 0.0);
    remarks.warnings.push_back(
        fmt::format("the mission's cruise was completed {:.0f} s ago: the charge at landing is that of a landing from "
                    "now, and the time to the reserve is at the mean power of this cruise, {:.1f} W",
                    *prediction.overtime_s, rest.measured_w));
    return rest;
}

void remark_on(const PathFix& fix, double cruise_s, Remarks& remarks) {
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
            fix.distance_m));
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
    prediction.on_path_s = seconds_on_path(input, flown, fix);
    prediction.is_from_position = fix && fix->path_time_s;
    const double path_s = input.path->flown().duration_s;
    if (!input.remaining_s && *prediction.on_path_s >= path_s)
        return predict_overtime(flown, flown.cruise_s() - path_s, prediction, remarks);
    if (fix) remark_on(*fix, flown.cruise_s(), remarks);
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
    for (const auto phase : flight::all_phases) {
        model[phase] = forecast_of(input.model, phase);
        if (phase != flight::Phase::cruise && !model[phase]->model.level_spread) of_flight[phase] = {};
    }
    of_flight[flight::Phase::cruise] = {flown.cruise_s(), flown.cruise_energy_wh};
    const auto rest = predict_remaining_flight(model, correlate_phases(input.model), of_flight,
                                               {{0.0, prediction.remaining_s, input.landing_s}}, input.prior);
    prediction.landing = rest.phases[flight::Phase::landing].energy;
    prediction.remaining_energy = rest.total;
    return rest.phases[flight::Phase::cruise];
}

mechanical::RemainingCruise predict_cruise(const PredictionInput& input, const FlightProgress& flown,
                                           const std::optional<PathFix>& fix, Prediction& prediction,
                                           Remarks& remarks) {
    prediction.uses_physical_model = input.path || input.motion;
    if (prediction.uses_physical_model && !flown.motion.no_bins_reason.empty())
        remarks.warnings.push_back(
            fmt::format("the deviation of this flight from the model is unknown: {}", flown.motion.no_bins_reason));
    if (input.path) return predict_along_path(input, flown, fix, prediction, remarks);
    const double overtime_s = input.remaining_s ? -*input.remaining_s : flown.cruise_s() - input.cruise_s.value();
    if (overtime_s > 0.0) return predict_overtime(flown, overtime_s, prediction, remarks);
    prediction.remaining_s = -overtime_s;
    if (!input.motion) return predict_phases(input, flown, prediction);
    auto model = input.model.physical.value();
    if (flown.motion.payload_known) model.load.payload_kg = flown.motion.load.payload_kg;
    warn_of_extrapolation(model, *input.motion, remarks);
    return predict_remaining_physical(model, flown, {term_values(*input.motion, model.load), prediction.remaining_s});
}

/// From the whole record of the flight so far.
BatteryPrediction predict_battery(const PredictionInput& input, const flight::FlightData& data,
                                  const Prediction& prediction, Remarks& remarks) {
    for (const auto& warning : battery_warnings(*input.battery))
        remarks.warnings.push_back(fmt::format("{}: {}", input.battery_file, warning));
    const auto records = battery::discharge_records(data);
    remarks.notes.insert(remarks.notes.end(), records.notes.begin(), records.notes.end());
    const auto& record = records.records.back();
    const double initial_percent = initial_soc_percent(input, record);
    const auto state_of = [&](const auto& pack) { return state_after(pack, record, initial_percent); };
    auto result = forecast_battery(*input.battery, input.limits, state_of, prediction);
    result.initial_is_measured = !input.initial_soc_percent;
    result.initial_soc_percent = initial_percent;
    return result;
}

/// Throws InputError where the model allows no prediction.
void require_predicting(const PredictionInput& input, const std::string& file) {
    if (input.path || input.motion)
        require_physical(input.model, file, "--mission");
    else
        require_interval(input.model, flight::Phase::cruise, file);
    if (input.landing_s > 0.0) require_interval(input.model, flight::Phase::landing, file);
}

PredictionInput unchecked_input(const mission::MissionSetup& setup) {
    require_single_flight(setup);
    PredictionInput input{setup.mechanical.value(), mechanical::CruisePrior::curve,
                          setup.duration_s[flight::Phase::landing]};
    input.limits = {setup.cutoff_voltage_v, setup.reserve_soc_percent};
    if (setup.cruise_path)
        input.path = std::make_shared<const path::PathForecast>(*setup.cruise_path->plan);
    else
        input.cruise_s = setup.duration_s[flight::Phase::cruise];
    if (!setup.cruise_path && setup.airspeed_m_per_s)
        input.motion = mechanical::FlightState{.airspeed_m_per_s = *setup.airspeed_m_per_s};
    return input;
}

/// The flight home from a time on the path; std::nullopt where the wind is too strong. Without a path the landing
/// begins where the aircraft is.
std::optional<ConstantLoad> flight_home(const PredictionInput& input, double on_path_s, double power_factor) {
    if (!input.path) return ConstantLoad{};
    const auto& plan = input.path->plan();
    const auto position = position_at(input.path->flown(), on_path_s);
    const auto at = local_position_at(plan.path, position);
    const double distance_m = std::hypot(at.east_m, at.north_m);
    const auto& element = plan.path.elements[std::min(position.element, plan.path.elements.size() - 1)];
    const double power_w = mechanical::power_w(plan.power, {.airspeed_m_per_s = element.airspeed_m_per_s});
    if (distance_m < 1.0) return ConstantLoad{power_w * power_factor, 0.0};
    const double course_deg = std::atan2(-at.east_m, -at.north_m) * units::degree_per_rad;
    const auto speed = ground_speed_m_per_s(element.airspeed_m_per_s, course_deg, plan.wind);
    if (!speed) return std::nullopt;
    return ConstantLoad{power_w * power_factor, distance_m / *speed};
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

}  // namespace

void require_interval(const mechanical::MechanicalModel& model, flight::Phase phase, const std::string& file) {
    if (model.phases[phase].level_spread) return;
    throw InputError({file}, fmt::format("[{}] has no spread between flights", to_string(phase)),
                     "fit it to two flights or more: flightwatt fit FLIGHT... -o MODEL.toml");
}

void require_physical(const mechanical::MechanicalModel& model, const std::string& file, const std::string& option) {
    if (model.physical && model.physical->level_sd) return;
    throw InputError(
        {file}, model.physical ? "its [physical] is fitted to a single flight" : "it has no [physical]",
        fmt::format("{} needs one of two flights or more: flightwatt fit --model-kind physical FLIGHT...", option));
}

double initial_soc_percent(const PredictionInput& input, const battery::DischargeRecord& flown) {
    return input.initial_soc_percent ? *input.initial_soc_percent : initial_soc_by_voltage_percent(input, flown);
}

double initial_soc_by_voltage_percent(const PredictionInput& input, const battery::DischargeRecord& flown) {
    const auto& battery = input.battery.value();
    if (!battery.thevenin) {
        throw InputError({input.battery_file}, "the voltage of this battery does not depend on its state of charge",
                         "give --initial-soc PERCENT");
    }
    const double rest_v = flown.resting_voltage_v + battery.resistance_ohm * flown.resting_current_a;
    return battery::resting_soc_percent(battery, rest_v);
}

Prediction predict_flight(const PredictionInput& input, const FlightProgress& flown, const flight::FlightData& data,
                          Remarks& remarks) {
    std::optional<PathFix> fix;
    if (input.path && !input.remaining_s) fix = locate_on_path(*input.path, data, flown.cruise_start_s, flown.until_s);
    auto prediction = predict_energy(input, flown, fix, remarks);
    if (input.battery) prediction.battery = predict_battery(input, data, prediction, remarks);
    return prediction;
}

Prediction predict_energy(const PredictionInput& input, const FlightProgress& flown, const std::optional<PathFix>& fix,
                          Remarks& remarks) {
    Prediction prediction;
    prediction.flown = flown;
    prediction.cruise = predict_cruise(input, flown, fix, prediction, remarks);
    if (prediction.uses_physical_model) warn_of_level(input.model.physical.value(), prediction.cruise.gain, remarks);
    prediction.landing_s = input.landing_s;
    if (prediction.uses_physical_model || prediction.overtime_s) {
        if (input.landing_s > 0.0)
            prediction.landing =
                mechanical::predict_before_flight(forecast_of(input.model, flight::Phase::landing), input.landing_s);
        prediction.remaining_energy = sum_of(prediction.cruise.energy, prediction.landing);
    }
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
    const double landing_j = units::joule_from_wh(prediction.landing.energy_wh);
    if (prediction.landing_s > 0.0) ahead.push_back({landing_j / prediction.landing_s * factor, prediction.landing_s});
    return ahead;
}

double high_energy_factor(const Prediction& prediction) {
    const double expected_wh = prediction.remaining_energy.energy_wh;
    return expected_wh > 0.0 ? prediction.interval.high_wh / expected_wh : 1.0;
}

BatteryPrediction forecast_battery(const battery::Battery& battery, const battery::LandingLimits& limits,
                                   const std::function<battery::BatteryState(const battery::Battery&)>& state_of,
                                   const Prediction& prediction) {
    const auto forecast = [&](const battery::Battery& pack, double factor) {
        return battery::forecast_landing(pack, state_of(pack), remaining_power(prediction, factor),
                                         prediction.cruise.remaining_mean_w * (prediction.overtime_s ? 1.0 : factor),
                                         limits);
    };
    const auto& interval = battery.intervals.capacity_ah;
    auto smaller = battery;
    if (interval) smaller.capacity_ah = interval->low;
    return {forecast(battery, 1.0), forecast(smaller, high_energy_factor(prediction)), limits, interval.has_value()};
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
        const double cruise_w = prediction.cruise.remaining_mean_w;
        ahead = {{cruise_w, 0.0}};
        ahead.front().duration_s = forecast_landing(*input.battery, now, ahead, cruise_w, input.limits).endurance_s;
    }
    const auto keeps_reserve_after = [&](double in_s) {
        const auto home = flight_home(input, prediction.on_path_s.value_or(0.0) + in_s, power_factor);
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

TimeCurve soc_ahead(const PredictionInput& input, const Prediction& prediction, battery::BatteryState now,
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

PredictionInput path_input_from_mission(const mission::MissionSetup& setup, const std::string& file) {
    auto input = unchecked_input(setup);
    require_predicting(input, file);
    return input;
}

PredictionInput input_from_model(mechanical::MechanicalModel model, const std::string& file, double remaining_s) {
    for (const auto phase : {flight::Phase::cruise, flight::Phase::landing}) require_interval(model, phase, file);
    const double landing_s = model.phases[flight::Phase::landing].duration_s;
    return {std::move(model), mechanical::CruisePrior::curve, landing_s, remaining_s};
}

}  // namespace flightwatt::live

#include "live/prediction.h"

#include "base/error.h"
#include "base/units.h"

#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

using mechanical::FlightProgress;

/// A motion that the model's flights did not fly.
void warn_of_motion(const mechanical::PhysicalModel& model, const mechanical::FlightState& motion,
                    Diagnostics& remarks) {
    if (is_within_flown_range(model, motion)) return;
    const auto& speeds = model.airspeed_m_per_s;
    remarks.warnings.push_back(
        fmt::format("{:.1f} m/s at {:+.1f} m/s of climb is beyond what the model's flights flew: {:.1f} to {:.1f} m/s, "
                    "{:+.1f} to {:+.1f} m/s of climb",
                    motion.airspeed_m_per_s, motion.climb_m_per_s, speeds.low, speeds.high, model.climb_m_per_s.low,
                    model.climb_m_per_s.high));
}

/// A flight's own level that no flight of the model's aircraft should have.
void warn_of_level(const mechanical::PhysicalModel& model, double level, Diagnostics& remarks) {
    constexpr double max_sds = 3.0;
    const double sd = model.level_sd.value_or(0.0);
    if (std::abs(level) <= max_sds * sd) return;
    remarks.warnings.push_back(fmt::format(
        "this flight takes {:+.1f} % of what the model says, whose flights differ by {:.1f} % (1 sd): is it "
        "another aircraft, load or propeller?",
        units::percentage(level, 1.0), units::percentage(sd, 1.0)));
}

/// Where on the path the flight is: where it was seen, after as long as it has cruised, or the remaining time before
/// its end.
double seconds_on_path(const PredictionInput& basis, const FlightProgress& flown,
                       const std::optional<path::PathFix>& sighting) {
    const auto& path = basis.path->flown();
    if (basis.remaining_s) {
        if (*basis.remaining_s <= path.duration_s) return path.duration_s - *basis.remaining_s;
        throw UsageError(fmt::format("--remaining {:g}: the mission's path takes only {:.1f} s", *basis.remaining_s,
                                     path.duration_s));
    }
    const bool is_sighted = sighting && sighting->path_time_s;
    if (is_sighted && *sighting->path_time_s < path.duration_s) return *sighting->path_time_s;
    if (is_sighted) {
        throw NoResultError(
            "the flight has flown the mission's path to its end: say with --remaining how long it "
            "flies on");
    }
    if (flown.cruise_s() <= path.duration_s) return flown.cruise_s();
    throw NoResultError(
        fmt::format("the flight has cruised for {:.1f} s and the mission's path takes {:.1f} s: say "
                    "with --remaining how much of it is left",
                    flown.cruise_s(), path.duration_s));
}

void remark_on(const std::optional<path::PathFix>& sighting, double cruise_s, Diagnostics& remarks) {
    if (!sighting) return;
    if (!sighting->path_time_s) {
        remarks.warnings.emplace_back(
            "the positions of this flight are not on the mission's path: it is taken to be as far along it as the time "
            "since its cruise began");
        return;
    }
    if (!sighting->is_on_path) {
        remarks.warnings.push_back(
            fmt::format("the flight has left the mission's path, and is {:.0f} m from where it did: expected to go on "
                        "from there, without the way back",
                        sighting->distance_m));
    }
    constexpr double much_s = 30.0;
    const double ahead_s = *sighting->path_time_s - cruise_s;
    if (std::abs(ahead_s) < much_s) return;
    remarks.notes.push_back(fmt::format("by its position the flight is {:.0f} s {} the mission's plan",
                                        std::abs(ahead_s), ahead_s > 0.0 ? "ahead of" : "behind"));
}

/// The cruise along what is left of the path.
mechanical::RemainingCruise predict_along(const PredictionInput& basis, const FlightProgress& flown,
                                          const std::optional<path::PathFix>& sighting, Prediction& prediction,
                                          Diagnostics& remarks) {
    prediction.on_path_s = seconds_on_path(basis, flown, sighting);
    prediction.is_from_position = sighting && sighting->path_time_s;
    remark_on(sighting, flown.cruise_s(), remarks);
    const auto rest = basis.path->predict(flown, position_at(basis.path->flown(), *prediction.on_path_s));
    if (rest.infeasible_fraction > 0.0) {
        remarks.warnings.push_back(
            fmt::format("{:.0f} % of the winds that [wind] makes likely forbid what is left of the path: they are not "
                        "in what follows",
                        units::percentage(rest.infeasible_fraction, 1.0)));
    }
    prediction.remaining_s = rest.duration_s;
    const auto& pieces = rest.trajectory.pieces;
    prediction.remaining_power.reserve(pieces.size());
    for (const auto& piece : pieces)
        prediction.remaining_power.push_back({power_w(basis.path->plan().power, piece.motion), piece.time_s});
    return rest.cruise;
}

mechanical::RemainingCruise predict_cruise(const PredictionInput& basis, const FlightProgress& flown,
                                           const std::optional<path::PathFix>& sighting, Prediction& prediction,
                                           Diagnostics& remarks) {
    prediction.uses_physical_model = basis.path || basis.motion;
    if (prediction.uses_physical_model && !flown.motion.no_bins_reason.empty())
        remarks.warnings.push_back(
            fmt::format("this flight's own level is not known: {}", flown.motion.no_bins_reason));
    if (basis.path) return predict_along(basis, flown, sighting, prediction, remarks);
    prediction.remaining_s = basis.remaining_s ? *basis.remaining_s : basis.cruise_s.value() - flown.cruise_s();
    if (prediction.remaining_s < 0.0) {
        throw NoResultError(
            fmt::format("the cruise takes {:.0f} s longer than the mission's {:.0f} s: how long it goes on "
                        "is not known (--remaining says it)",
                        -prediction.remaining_s, *basis.cruise_s));
    }
    if (!basis.motion)
        return predict_remaining_cruise(forecast_of(basis.model, flight::Phase::cruise), flown, prediction.remaining_s,
                                        basis.level.value_or(mechanical::CruisePrior::curve));
    const auto& model = basis.model.physical.value();
    warn_of_motion(model, *basis.motion, remarks);
    return predict_remaining_physical(model, flown, {term_values(*basis.motion), prediction.remaining_s});
}

/// The battery through the rest, from what was measured of it until now.
std::optional<BatteryPrediction> predict_battery(const PredictionInput& basis, const flight::FlightSeries& series,
                                                 const Prediction& prediction, Diagnostics& remarks) {
    if (!basis.battery) return std::nullopt;
    const auto& battery = *basis.battery;
    for (const auto& warning : battery_warnings(battery))
        remarks.warnings.push_back(fmt::format("{}: {}", basis.battery_file, warning));
    const auto records = battery::discharge_records(series);
    remarks.notes.insert(remarks.notes.end(), records.notes.begin(), records.notes.end());
    const auto& record = records.records.back();
    const double initial_percent = initial_soc_percent(basis, record);
    const auto state_of = [&](const auto& pack) { return state_after(pack, record, initial_percent); };
    auto of = forecast_battery(battery, basis.limits, state_of, prediction);
    of.initial_is_measured = !basis.initial_soc_percent;
    of.initial_soc_percent = initial_percent;
    return of;
}

/// Throws InputError where the model does not allow a prediction.
void require_predicting(const PredictionInput& basis, const std::string& file) {
    if (basis.path)
        require_physical(basis.model, file, "--mission");
    else
        require_interval(basis.model, flight::Phase::cruise, file);
    if (basis.landing_s > 0.0) require_interval(basis.model, flight::Phase::landing, file);
}

/// Model and path, or time, of a mission.
PredictionInput basis_of(const mission::MissionSetup& setup) {
    PredictionInput basis{setup.mechanical.value(), {}, setup.duration_s[flight::Phase::landing]};
    basis.limits = {setup.cutoff_voltage_v, setup.reserve_soc_percent};
    if (setup.cruise_path) {
        basis.path = std::make_shared<const path::PathForecast>(*setup.cruise_path->plan);
    } else {
        basis.cruise_s = setup.duration_s[flight::Phase::cruise];
    }
    return basis;
}

/// The mission's own battery; and where a schedule is all that the mission can tell, that and why.
void add_mission_battery(const mission::MissionSetup& setup, const std::string& file, PredictionInput& basis) {
    basis.battery = setup.battery;
    basis.battery->intervals.capacity_ah = capacity_interval_ah(setup);
    basis.battery_file = file;
    if (!setup.battery.thevenin) basis.initial_soc_percent = setup.initial_soc_percent;
    try {
        require_predicting(basis, file);
    } catch (const InputError& error) {
        basis.no_prediction_reason = error.what();
    }
}

}  // namespace

void require_interval(const mechanical::MechanicalModel& model, flight::Phase phase, const std::string& file) {
    if (model.phases[phase].level_spread) return;
    throw InputError({file}, fmt::format("[{}] has no spread: how much flights differ", to_string(phase)),
                     "fit it to two flights or more: flightwatt fit FLIGHT... -o MODEL.toml");
}

void require_physical(const mechanical::MechanicalModel& model, const std::string& file, const std::string& option) {
    if (model.physical && model.physical->level_sd) return;
    throw InputError(
        {file}, model.physical ? "its [physical] rests on a single flight" : "it has no [physical]",
        fmt::format("{} needs one of two flights or more: flightwatt fit --model-kind physical FLIGHT...", option));
}

double initial_soc_percent(const PredictionInput& basis, const battery::DischargeRecord& flown) {
    return basis.initial_soc_percent ? *basis.initial_soc_percent : initial_soc_by_voltage_percent(basis, flown);
}

double initial_soc_by_voltage_percent(const PredictionInput& basis, const battery::DischargeRecord& flown) {
    const auto& battery = basis.battery.value();
    if (!battery.thevenin) {
        throw InputError({basis.battery_file}, "a battery of constant voltage does not tell its state of charge",
                         "give --initial-soc PERCENT");
    }
    const double rest_v = flown.resting_voltage_v + battery.resistance_ohm * flown.resting_current_a;
    return battery::resting_soc_percent(battery, rest_v);
}

Prediction predict_flight(const PredictionInput& basis, const mechanical::FlightProgress& flown,
                          const flight::FlightSeries& series, Diagnostics& remarks) {
    auto prediction = predict_energy(basis, flown, find_path_fix(basis, flown, series), remarks);
    prediction.battery = predict_battery(basis, series, prediction, remarks);
    return prediction;
}

std::optional<path::PathFix> find_path_fix(const PredictionInput& basis, const FlightProgress& flown,
                                           const flight::FlightSeries& series) {
    if (!basis.path || basis.remaining_s) return std::nullopt;
    return locate_on_path(*basis.path, series, flown.cruise_start_s, flown.until_s);
}

Prediction predict_energy(const PredictionInput& basis, const FlightProgress& flown,
                          const std::optional<path::PathFix>& sighting, Diagnostics& remarks) {
    Prediction prediction;
    prediction.flown = flown;
    prediction.cruise = predict_cruise(basis, flown, sighting, prediction, remarks);
    if (prediction.uses_physical_model) warn_of_level(basis.model.physical.value(), prediction.cruise.gain, remarks);
    prediction.landing_s = basis.landing_s;
    if (basis.landing_s > 0.0) {
        prediction.landing =
            mechanical::predict_before_flight(forecast_of(basis.model, flight::Phase::landing), basis.landing_s);
    }
    prediction.remaining_energy = sum_of(prediction.cruise.energy, prediction.landing);
    prediction.interval = interval_95(prediction.remaining_energy).value();
    return prediction;
}

std::vector<battery::ConstantLoad> remaining_power(const Prediction& prediction, double part) {
    double along_path_j = 0.0;
    for (const auto& stretch : prediction.remaining_power) along_path_j += stretch.power_w * stretch.duration_s;
    std::vector<battery::ConstantLoad> ahead;
    if (along_path_j > 0.0) {
        const double cruise_j = units::joule_from_wh(prediction.cruise.energy.energy_wh);
        for (const auto& [power_w, duration_s] : prediction.remaining_power)
            ahead.push_back({power_w * part * cruise_j / along_path_j, duration_s});
    } else {
        ahead.push_back({prediction.cruise.remaining_mean_w * part, prediction.remaining_s});
    }
    const double landing_j = units::joule_from_wh(prediction.landing.energy_wh);
    if (prediction.landing_s > 0.0) ahead.push_back({landing_j / prediction.landing_s * part, prediction.landing_s});
    return ahead;
}

BatteryPrediction forecast_battery(const battery::Battery& battery, const battery::LandingLimits& limits,
                                   const std::function<battery::BatteryState(const battery::Battery&)>& state_of,
                                   const Prediction& prediction) {
    const auto forecast = [&](const battery::Battery& of, double part) {
        return battery::forecast_landing(of, state_of(of), remaining_power(prediction, part),
                                         prediction.cruise.remaining_mean_w * part, limits);
    };
    const double rest_wh = prediction.remaining_energy.energy_wh;
    auto least = battery;
    BatteryPrediction result;
    result.limits = limits;
    result.worst_uses_min_capacity = battery.intervals.capacity_ah.has_value();
    if (result.worst_uses_min_capacity) least.capacity_ah = battery.intervals.capacity_ah->low;
    result.expected = forecast(battery, 1.0);
    result.worst = forecast(least, rest_wh > 0.0 ? prediction.interval.high_wh / rest_wh : 1.0);
    return result;
}

PredictionInput input_from_mission(const mission::MissionSetup& setup, const std::string& file) {
    auto basis = basis_of(setup);
    add_mission_battery(setup, file, basis);
    return basis;
}

PredictionInput path_input_from_mission(const mission::MissionSetup& setup, const std::string& file) {
    auto basis = basis_of(setup);
    require_predicting(basis, file);
    return basis;
}

PredictionInput input_from_model(mechanical::MechanicalModel model, const std::string& file, double remaining_s) {
    PredictionInput basis;
    for (const auto phase : {flight::Phase::cruise, flight::Phase::landing}) require_interval(model, phase, file);
    basis.model = std::move(model);
    basis.remaining_s = remaining_s;
    basis.landing_s = basis.model.phases[flight::Phase::landing].duration_s;
    return basis;
}

}  // namespace flightwatt::live

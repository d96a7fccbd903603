#include "base/error.h"
#include "base/units.h"
#include "flight/phase_statistics.h"
#include "flight/segmentation.h"
#include "flight/selected_track.h"
#include "live/state/moment.h"
#include "mechanical/flight_bins.h"
#include "mechanical/flight_progress.h"

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

using flight::Phase;

mechanical::FlightProgress progress_from_air(const flight::FlightSeries& series, const flight::Sortie& sortie) {
    mechanical::FlightProgress flown;
    flown.until_s = mechanical::last_time_s(series);
    flown.lift_off_s = sortie.start_s();
    const auto& first = sortie.phases.front();
    flown.cruise_start_s = first.phase == Phase::takeoff ? first.end.time_s : sortie.start_s();
    const double hold_s = flight::SegmentationOptions{}.hold_s;
    if (sortie.phases.back().phase == Phase::takeoff || flown.cruise_s() < hold_s) {
        throw NoResultError(fmt::format(
            "at {:.1f} s of the log the aircraft, seen from the air on, has not held its height for {:.0f} s",
            flown.until_s, hold_s));
    }
    flown.cruise_energy_wh = integrated_energy_wh(series, flown.cruise_start_s, flown.until_s);
    flown.energy_wh = integrated_energy_wh(series, flown.lift_off_s, flown.cruise_start_s) + flown.cruise_energy_wh;
    const flight::SelectedTracks tracks(series);
    flown.motion = mechanical::bin_flight(tracks, {{Phase::cruise, flown.cruise_start_s, flown.until_s}});
    return flown;
}

/// What may be left of a cruise of which so much was seen.
double max_left_s(const PredictionInput& basis, double seen_s) {
    const double whole_s = basis.path ? basis.path->flown().duration_s : basis.cruise_s.value();
    if (seen_s < whole_s) return whole_s - seen_s;
    throw NoResultError(
        fmt::format("the cruise takes longer than the mission's {:.0f} s: how long it goes on is not known "
                    "(--remaining says it)",
                    whole_s));
}

/// Evenly likely from 0 to that time.
void add_unknown_time(double time_s, Prediction& prediction) {
    constexpr double variance_of_even = 1.0 / 12.0;
    constexpr double known_well = 1e9;
    const double energy_wh = units::wh_from_joule(prediction.cruise.remaining_mean_w * time_s);
    mechanical::add_variance(prediction.remaining_energy, {energy_wh * energy_wh * variance_of_even, known_well});
    prediction.interval = mechanical::interval_95(prediction.remaining_energy).value();
}

/// Where a counter stands; none of one that never counts.
std::optional<double> last_of(const flight::Track& counter) {
    return is_constant(counter) ? std::nullopt : std::optional(counter.value.back());
}

/// What a counter counted from the moment before the restart to a value after it.
double counted_since(double before, double value) { return value >= before ? value - before : value; }

/// The energy from the restart to the first sample after it, by the energy counter or by that of the charge.
std::optional<double> energy_between_wh(const CarriedFlight& before, const flight::SelectedTracks& tracks) {
    const auto& energy = tracks["energy_wh"];
    if (before.counted_wh && !energy.empty()) return counted_since(*before.counted_wh, energy.value.front());
    const auto& charge = tracks["charge_ah"];
    const auto& voltage = tracks["voltage_v"];
    if (!before.counted_ah || charge.empty() || voltage.empty()) return std::nullopt;
    return counted_since(*before.counted_ah, charge.value.front()) * voltage.value.front();
}

}  // namespace

Prediction predict_airborne_start(const PredictionInput& basis, const flight::FlightSeries& series,
                                  const flight::Sortie& sortie, const LiveBattery* battery, path::PathTracker* places,
                                  Diagnostics& remarks) {
    const auto flown = progress_from_air(series, sortie);
    auto ahead = basis;
    if (!ahead.level) ahead.level = mechanical::CruisePrior::constant;  // where on the curve it is, is not known
    double unknown_s = 0.0;
    const bool saw_cruise_begin = sortie.phases.front().phase == Phase::takeoff;
    if (!basis.remaining_s && !saw_cruise_begin) {
        unknown_s = max_left_s(basis, flown.cruise_s());
        ahead.remaining_s = 0.5 * unknown_s;
        remarks.warnings.push_back(fmt::format(
            "watched from the air on: how far the cruise had come is not known. Of the mission's 0 to {:.0f} s "
            "may be left; half of that is expected, and the interval holds all of it",
            unknown_s));
    }
    std::optional<path::PathFix> sighting;
    if (saw_cruise_begin && places != nullptr)
        sighting = places->find(flight::SelectedTracks(series), flown.cruise_start_s, flown.until_s);
    auto prediction = predict_energy(ahead, flown, sighting, remarks);
    prediction.began_in_air = true;
    if (unknown_s > 0.0) add_unknown_time(unknown_s, prediction);
    if (battery != nullptr && battery->state) {
        const auto state_of = [&](const auto&) { return *battery->state; };
        prediction.battery = forecast_battery(*basis.battery, basis.limits, state_of, prediction);
        prediction.battery->initial_soc_percent = battery->state->soc_percent;
        prediction.battery->initial_soc_is_current = true;
        remarks.warnings.emplace_back(
            battery->soc_percent ? "watched from the air on: the state of charge is what --initial-soc (or the "
                                   "mission) leaves by the autopilot's counter"
                                 : "watched from the air on: the state of charge is that of the voltage in flight");
    }
    return prediction;
}

CarriedFlight carried_flight(const LiveState& state, const flight::SelectedTracks& tracks) {
    CarriedFlight carried;
    carried.clock_s = state.time_s;
    carried.energy_wh = state.energy_wh;
    if (state.battery) carried.soc_percent = state.battery->soc_percent;
    carried.counted_wh = last_of(tracks["energy_wh"]);
    carried.counted_ah = last_of(tracks["charge_ah"]);
    return carried;
}

void continue_flight(const CarriedFlight& before, const flight::SelectedTracks& tracks, double now_s,
                     const std::optional<battery::Battery>& battery, LiveState& state) {
    const auto& counter = tracks[before.counted_wh ? "energy_wh" : "charge_ah"];
    const auto between_wh = energy_between_wh(before, tracks);
    std::string known;
    if (before.energy_wh && between_wh && state.energy_wh) {
        const double since_wh = integrated_energy_wh(tracks["power_w"], counter.time_s.front(), now_s);
        state.energy_wh = *before.energy_wh + *between_wh + since_wh;
        known = fmt::format("energy goes on by the autopilot's counter ({:.3f} Wh between)", *between_wh);
    } else {
        known = state.energy_wh
                    ? fmt::format("the energy since the lift-off is unknown ({:.3f} Wh since)", *state.energy_wh)
                    : std::string("the energy since the lift-off is unknown");
        state.energy_wh.reset();
    }
    const auto& charge = tracks["charge_ah"];
    if (battery && state.battery && before.soc_percent && before.counted_ah && !charge.empty() &&
        !state.battery->soc_percent) {
        const double drawn_ah =
            counted_since(*before.counted_ah, charge.value.front()) + charge.value.back() - charge.value.front();
        const double soc_percent = *before.soc_percent - units::percentage(drawn_ah, battery->capacity_ah);
        if (soc_percent > 0.0) {
            state.battery->soc_percent = soc_percent;
            state.battery->state = battery::BatteryState{soc_percent, 0.0};
        }
    }
    if (state.battery && !state.battery->soc_percent) known += ", and so is the state of charge, but for the voltage";
    state.warnings.push_back(fmt::format("the clock began anew in the air, after {:.0f} s: {}", before.clock_s, known));
}

}  // namespace flightwatt::live

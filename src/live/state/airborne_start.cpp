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

/// The longest remaining cruise after `received_s` of it.
double max_remaining_s(const PredictionInput& input, double received_s) {
    const double whole_s = input.path ? input.path->flown().duration_s : input.cruise_s.value();
    if (received_s < whole_s) return whole_s - received_s;
    throw NoResultError(fmt::format(
        "the cruise takes longer than the mission's {:.0f} s: give the remaining cruise with --remaining", whole_s));
}

std::optional<double> last_count(const flight::Track& counter) {
    return is_constant(counter) ? std::nullopt : std::optional(counter.value.back());
}

/// The increase of a counter, which restarts at 0 if the autopilot does.
double counted_since(double before, double value) { return value >= before ? value - before : value; }

/// The energy from the restart to the first sample after it, by the counter of energy or of charge.
std::optional<double> energy_between_wh(const CarriedFlight& before, const flight::SelectedTracks& tracks) {
    const auto& energy = tracks["energy_wh"];
    if (before.counted_wh && !energy.empty()) return counted_since(*before.counted_wh, energy.value.front());
    const auto& charge = tracks["charge_ah"];
    const auto& voltage = tracks["voltage_v"];
    if (!before.counted_ah || charge.empty() || voltage.empty()) return std::nullopt;
    return counted_since(*before.counted_ah, charge.value.front()) * voltage.value.front();
}

}  // namespace

mechanical::FlightProgress airborne_progress(const flight::SelectedTracks& tracks, const flight::Sortie& sortie) {
    mechanical::FlightProgress flown;
    flown.until_s = mechanical::last_time_s(tracks.series());
    flown.lift_off_s = sortie.start_s();
    const auto& first = sortie.phases.front();
    flown.cruise_start_s = first.phase == Phase::takeoff ? first.end.time_s : sortie.start_s();
    const double hold_s = flight::SegmentationOptions{}.hold_s;
    if (sortie.phases.back().phase == Phase::takeoff || flown.cruise_s() < hold_s) {
        throw NoResultError(
            fmt::format("at {:.1f} s of the log, which begins in the air, the aircraft has not held its height for "
                        "{:.0f} s",
                        flown.until_s, hold_s));
    }
    const auto& power = tracks["power_w"];
    flown.cruise_energy_wh = integrated_energy_wh(power, flown.cruise_start_s, flown.until_s);
    flown.energy_wh = integrated_energy_wh(power, flown.lift_off_s, flown.cruise_start_s) + flown.cruise_energy_wh;
    flown.motion = mechanical::bin_flight(tracks, {{Phase::cruise, flown.cruise_start_s, flown.until_s}});
    return flown;
}

Prediction predict_airborne_start(const PredictionInput& input, const mechanical::FlightProgress& flown,
                                  bool has_cruise_start, const std::optional<path::PathFix>& fix,
                                  Diagnostics& remarks) {
    auto ahead = input;
    if (!ahead.level) ahead.level = mechanical::CruisePrior::constant;  // the position on the curve is not known
    const bool is_remaining_known = input.remaining_s || has_cruise_start;
    const double max_s = is_remaining_known ? 0.0 : max_remaining_s(input, flown.cruise_s());
    if (!is_remaining_known) {
        ahead.remaining_s = 0.5 * max_s;
        remarks.warnings.push_back(
            fmt::format("the telemetry begins in the air: 0 to {:.0f} s of the mission's cruise may remain; half of "
                        "that is expected, and the interval contains all of it",
                        max_s));
    }
    auto prediction = predict_energy(ahead, flown, fix, remarks);
    prediction.began_in_air = true;
    if (is_remaining_known) return prediction;
    constexpr double uniform_variance = 1.0 / 12.0;
    constexpr double degrees_of_freedom = 1e9;  // known exactly
    const double energy_wh = units::wh_from_joule(prediction.cruise.remaining_mean_w * max_s);
    mechanical::add_variance(prediction.remaining_energy, energy_wh * energy_wh * uniform_variance, degrees_of_freedom);
    prediction.interval = mechanical::interval_95(prediction.remaining_energy).value();
    return prediction;
}

CarriedFlight carried_flight(const LiveState& state, const flight::SelectedTracks& tracks) {
    return {state.time_s, state.energy_wh, state.battery ? state.battery->soc_percent : std::nullopt,
            last_count(tracks["energy_wh"]), last_count(tracks["charge_ah"])};
}

void estimate_soc_from_counter(const flight::Track& charge_ah, double capacity_ah, double soc_percent,
                               double counted_ah, LiveBattery& result) {
    if (charge_ah.empty() || result.soc_percent) return;
    const double first_ah = charge_ah.value.front();
    const double drawn_ah = counted_since(counted_ah, first_ah) + charge_ah.value.back() - first_ah;
    const double left_percent = soc_percent - units::percentage(drawn_ah, capacity_ah);
    if (!(drawn_ah > 0.0) || !(left_percent > 0.0)) return;  // it does not count, restarted, or counts another pack
    result.drawn_ah = drawn_ah;
    result.initial_soc_percent = soc_percent;
    result.soc_percent = left_percent;
    result.state = battery::BatteryState{left_percent, 0.0};
}

void continue_flight(const CarriedFlight& before, const flight::SelectedTracks& tracks, double now_s,
                     const battery::Battery* battery, LiveState& state) {
    const auto& counter = tracks[before.counted_wh ? "energy_wh" : "charge_ah"];
    const auto between_wh = energy_between_wh(before, tracks);
    std::string known;
    if (before.energy_wh && between_wh && state.energy_wh) {
        const double since_wh = integrated_energy_wh(tracks["power_w"], counter.time_s.front(), now_s);
        state.energy_wh = *before.energy_wh + *between_wh + since_wh;
        known = fmt::format("energy continues by the autopilot's counter ({:.3f} Wh between)", *between_wh);
    } else {
        known = "the energy since the lift-off is unknown";
        if (state.energy_wh) known += fmt::format(" ({:.3f} Wh since the restart)", *state.energy_wh);
        state.energy_wh.reset();
    }
    if (battery != nullptr && before.soc_percent && before.counted_ah)
        estimate_soc_from_counter(tracks["charge_ah"], battery->capacity_ah, *before.soc_percent, *before.counted_ah,
                                  *state.battery);
    if (state.battery && !state.battery->soc_percent) known += "; the state of charge is known by voltage only";
    state.warnings.push_back(fmt::format("the clock restarted in the air, after {:.0f} s: {}", before.clock_s, known));
}

}  // namespace flightwatt::live

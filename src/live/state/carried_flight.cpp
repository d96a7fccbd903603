#include "live/state/carried_flight.h"

#include "base/units.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

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

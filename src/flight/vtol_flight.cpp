#include "flight/vtol_flight.h"

#include "base/units.h"
#include "flight/phase_statistics.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

VtolFlight flight_of(double state) {
    if (state == static_cast<double>(VtolState::hover)) return VtolFlight::hover;
    return state == static_cast<double>(VtolState::wing) ? VtolFlight::wing : VtolFlight::transition;
}

bool is_wing(const VtolSpan& span) { return span.flight == VtolFlight::wing; }

}  // namespace

std::string_view to_string(VtolFlight flight) {
    constexpr std::array<std::string_view, 3> names{"hover", "transition", "wing"};
    return names[static_cast<std::size_t>(flight)];
}

std::vector<VtolSpan> vtol_spans(const FlightData& data, double start_s, double end_s) {
    const auto& state = data.vtol_state;
    std::vector<VtolSpan> spans;
    if (state.empty() || !(start_s < end_s)) return spans;
    spans.push_back({{start_s, end_s}, flight_of(state_at(state, start_s))});
    for (auto i = first_after(state.time_s, start_s); i < state.time_s.size() && state.time_s[i] < end_s; ++i) {
        const double time_s = state.time_s[i];
        const auto flight = flight_of(state.value[i]);
        if (flight == spans.back().flight) continue;
        spans.back().end_s = time_s;
        spans.push_back({{time_s, end_s}, flight});
    }
    return spans;
}

bool is_on_wing(const FlightData& data, double start_s, double end_s) {
    return std::ranges::all_of(vtol_spans(data, start_s, end_s), is_wing);
}

std::optional<TimeInterval> wing_flight(const FlightData& data, double start_s, double end_s) {
    const auto spans = vtol_spans(data, start_s, end_s);
    const auto first = std::ranges::find_if(spans, is_wing);
    if (first == spans.end()) return std::nullopt;
    return TimeInterval{first->start_s, std::find_if(spans.rbegin(), spans.rend(), is_wing)->end_s};
}

bool only_hovers(const FlightData& data, const Sortie& sortie) {
    return !data.vtol_state.empty() && !wing_flight(data, sortie.start_s(), sortie.end_s()).has_value();
}

std::string hover_in_cruise(const FlightData& data, const Sortie& sortie) {
    double lifted_s = 0.0;
    double wing_s = 0.0;
    for (const auto& phase : sortie.phases) {
        if (phase.phase != Phase::cruise) continue;
        for (const auto& span : vtol_spans(data, phase.start.time_s, phase.end.time_s))
            (is_wing(span) ? wing_s : lifted_s) += span.duration_s();
    }
    if (data.vtol_state.empty() || lifted_s == 0.0) return "";
    if (wing_s == 0.0)
        return fmt::format(
            "sortie {}: it never flies on its wing: its cruise is hover; a fit with flights on the wing leaves it out",
            sortie.number);
    return fmt::format(
        "sortie {}: {:.0f} of {:.0f} s of the cruise are hover or transitions: its mean power is that of both",
        sortie.number, lifted_s, lifted_s + wing_s);
}

std::string describe_vtol(const FlightData& data, const Sortie& sortie) {
    if (data.vtol_state.empty()) return "";
    const PowerStatistics power(data);
    std::array<double, 3> duration_s{};
    std::array<double, 3> energy_wh{};
    for (const auto& span : vtol_spans(data, sortie.start_s(), sortie.end_s())) {
        const auto flight = static_cast<std::size_t>(span.flight);
        duration_s[flight] += span.duration_s();
        energy_wh[flight] += power.between(span.start_s, span.end_s).energy_wh;
    }
    std::vector<std::string> parts;
    for (const auto flight : {VtolFlight::hover, VtolFlight::transition, VtolFlight::wing}) {
        const auto i = static_cast<std::size_t>(flight);
        if (duration_s[i] == 0.0) continue;
        parts.push_back(fmt::format("{} {:.0f} s", to_string(flight), duration_s[i]));
        if (power.has_power())
            parts.back() +=
                fmt::format(", {:.2f} Wh, {:.0f} W", energy_wh[i], units::joule_from_wh(energy_wh[i]) / duration_s[i]);
    }
    return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace flightwatt::flight

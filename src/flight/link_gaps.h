#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"

#include <span>
#include <string>
#include <vector>

/// Times in flight without any message, as after a loss of the link: no sample shows the energy that the aircraft draws
/// in them, and a straight line from the sample before to the one after is a guess.
namespace flightwatt::flight {

/// An interval without a sample of the power.
struct LinkGap : TimeInterval {
    bool is_counted = false;  ///< its energy was taken from an on-board counter
};

/// Fills a gap of the power with samples, and the current likewise. The energy is that of the on-board counter, else
/// that of the charge counter at the mean of the voltages around the gap. Returns false, and leaves it unchanged,
/// without such a counter, and if it ran back or did not count.
bool bridge_gap(FlightData& data, const TimeInterval& gap);

/// Fills each gap of the power of more than a minute as bridge_gap(), and returns these gaps.
std::vector<LinkGap> bridge_link_gaps(FlightData& data);

/// Returns whether a counter restarts between two times, as with its autopilot: it falls to less than a tenth, and
/// counts on from there.
bool restarts(const Track& counter, double from_s, double to_s);

/// Returns a warning for each gap within these sorties.
std::vector<std::string> gap_warnings(const std::vector<LinkGap>& gaps, std::span<const Sortie> sorties);

/// Returns a text about the first gap within these sorties whose energy is unknown; empty without one.
std::string unknown_energy_reason(const std::vector<LinkGap>& gaps, std::span<const Sortie> sorties);

}  // namespace flightwatt::flight

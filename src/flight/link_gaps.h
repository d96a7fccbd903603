#pragma once

#include "flight/flight_data.h"
#include "flight/flight_phases.h"

#include <span>
#include <string>
#include <vector>

/// Times in flight in which nothing arrived, as where a link was lost: the aircraft draws energy in them that
/// no sample shows, and a straight line from the sample before to the one after is a guess.
namespace flightwatt::flight {

/// A time without a sample of the power.
struct LinkGap : TimeInterval {
    bool is_counted = false;  ///< its energy is by an on-board counter
};

/// Fills each gap of the power of more than a minute with samples that have the energy of the on-board counter, or of
/// that of charge at the mean of the voltages around the gap, and the current likewise; returns these gaps. One without
/// such a counter, or with one that ran back or did not count in it, is left as it is.
std::vector<LinkGap> bridge_link_gaps(FlightData& data);

/// Returns a warning for each gap within these sorties.
std::vector<std::string> gap_warnings(const std::vector<LinkGap>& gaps, std::span<const Sortie> sorties);

/// Names the first gap within these sorties whose energy is unknown; empty without one.
std::string unknown_energy_reason(const std::vector<LinkGap>& gaps, std::span<const Sortie> sorties);

}  // namespace flightwatt::flight

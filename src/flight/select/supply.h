#pragma once

#include "flight/flight_series.h"

#include <optional>

namespace flightwatt::flight {

/// A source of power that gives less than the ESCs draw, which it should supply. Means over the log.
struct SupplyShortfall {
    double supply_w = 0.0;
    double escs_w = 0.0;
    bool is_other_supply = false;  ///< it does not rise with the ESCs: it supplies something else
};

/// Compares a source of power with the sum over the ESCs; std::nullopt if that is at most 15 % larger, as ESCs measure
/// roughly. Compares means over some seconds, and loads less those at rest, so that neither noise nor offsets of ESCs
/// count.
std::optional<SupplyShortfall> compare_with_escs(const Track& supply_w, const Track& escs_w);

/// Returns how many times as much a source of power rises from rest to load as the ESCs of all motors; std::nullopt
/// within 15 %, and for five times or more, which is that of ESCs that measure no current.
std::optional<double> rise_beyond_escs(const Track& supply_w, const Track& escs_w);

}  // namespace flightwatt::flight

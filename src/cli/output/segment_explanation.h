#pragma once

#include "base/text_table.h"
#include "flight/edge_witness.h"
#include "flight/power_check.h"
#include "flight/segmentation.h"

#include <string>

namespace flightwatt::cli {

/// What the autopilot says of an edge: its witnesses, then events nearby; '-' for nothing.
std::string witness_text(const flight::ExplainedEdge& edge);

/// A row an edge: where it is, what altitude and throttle are there, and what the autopilot says of it.
TextTable edges_table(const flight::FlightSeries& series, const flight::FlightPhases& phases);

/// What `segment --explain` prints: the edges, what is no flight and what was found of the power record.
std::string explanation(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                        const flight::PowerReport& power);

}  // namespace flightwatt::cli

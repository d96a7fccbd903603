#pragma once

#include "base/text_table.h"
#include "cli/screen_table.h"
#include "flight/edge_events.h"
#include "flight/power_check.h"
#include "flight/segmentation.h"

#include <string>
#include <vector>

/// What flightwatt segment says of a flight.
namespace flightwatt::cli {

/// What the autopilot says of an edge: its witnesses, then events nearby; '-' for nothing.
std::string witness_text(const flight::EdgeReport& edge);

/// The flight, its aircraft and how many sorties it holds: the title of its tables.
std::string describe_flight(const flight::FlightSeries& series, const flight::FlightPhases& phases);

/// A row an edge: where it is, what altitude and throttle are there, and what the autopilot says of it.
TextTable edges_table(const flight::FlightSeries& series, const flight::FlightPhases& phases);

/// What `segment --explain` prints: the edges, what is no flight and what was found of the power record.
std::string explanation(const flight::FlightSeries& series, const flight::FlightPhases& phases,
                        const flight::PowerReport& power, const Screen& screen);

/// What `segment --json` prints: sorties with phases and edges, what is no flight, the power check and the
/// warnings. null stands for what is not known.
Json to_json(const flight::FlightSeries& series, const flight::FlightPhases& phases, const flight::PowerReport& power,
             const std::vector<std::string>& warnings);

}  // namespace flightwatt::cli

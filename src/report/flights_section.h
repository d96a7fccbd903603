#pragma once

#include "base/text_table.h"
#include "mechanical/mechanical_model.h"
#include "report/batch_content.h"
#include "report/html.h"
#include "report/in_flight.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// One row a sortie of the flights that were not rejected: durations, power, energy, closure, gaps, warnings.
TextTable flights_table(std::span<const ReportFlight> flights);

/// That one, and what was excluded with the reasons: the section's tables.
std::vector<CaptionedTable> flights_tables(std::span<const ReportFlight> flights);

/// All flights as a table (durations, power, energy, closure of integral and counter, gaps, warnings), those
/// that are excluded with their reasons, and a part a flight that is drawn when it is opened, with what would have
/// been predicted in flight where that is known. `models` are those of the flights' batches, by their places.
Section flights_section(std::span<const ReportFlight> flights,
                        std::span<const std::optional<mechanical::MechanicalModel>> models,
                        const std::map<std::string, PredictedFlight>& predicted = {}, const Progress& progress = {});

}  // namespace flightwatt::report

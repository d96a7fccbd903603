#pragma once

#include "report/batch_content.h"
#include "report/html.h"

#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// Returns the section of the flights: a table with a row for each sortie, exclusions, and a part for each flight with
/// the model of the batch.
Section flights_section(const BatchContent& batch, const Progress& progress = {});

/// Returns unique names of files and anchors: "flight-20_07_03__12_17_45".
std::vector<std::string> flight_ids(std::span<const ReportFlight> flights);

}  // namespace flightwatt::report

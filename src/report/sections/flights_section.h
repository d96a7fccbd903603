#pragma once

#include "report/batch_content.h"
#include "report/html.h"

#include <span>
#include <string>
#include <vector>

namespace flightwatt::report {

/// A table with a row for each sortie, exclusions, and a part for each flight, with the model of the batch.
Section flights_section(const BatchContent& batch, const Progress& progress = {});

/// "flight-20_07_03__12_17_45": unique names of files and anchors.
std::vector<std::string> flight_ids(std::span<const ReportFlight> flights);

}  // namespace flightwatt::report

#pragma once

#include "cli/output/answer_output.h"
#include "report/html.h"

#include <string>
#include <utility>
#include <vector>

namespace flightwatt::report {

/// Returns the first section of the page of an answer: the lines of the terminal, without files of this computer, and
/// texts to paste, each below its name.
Section answer_section(const cli::AircraftAnswer& answer,
                       const std::vector<std::pair<std::string, std::string>>& pastes);

}  // namespace flightwatt::report

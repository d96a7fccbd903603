#pragma once

#include "cli/output/answer_output.h"
#include "record/json_type.h"

#include <string>
#include <utility>
#include <vector>

namespace flightwatt::report {

/// Returns the answers about one aircraft (AnswerDocument of web/app/src/documents.ts): its JSON and the lines of the
/// terminal, both without files of this computer, and texts to paste, each with its name.
Json answer_json(const cli::AircraftAnswer& answer, const std::vector<std::pair<std::string, std::string>>& pastes);

}  // namespace flightwatt::report

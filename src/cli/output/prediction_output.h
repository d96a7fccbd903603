#pragma once

#include "cli/stage.h"
#include "live/prediction.h"

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

/// What predict says of a flight in the air.
namespace flightwatt::cli {

using live::Prediction;

/// A line each for what was flown, what lies ahead and the sum; two for the battery.
std::string text_of(const Prediction& prediction);

/// The same; null for what is not known, and for a battery that does not fail.
nlohmann::ordered_json json_of(const Prediction& prediction);

/// The remarks on a prediction, on the standard error.
void warn_of(const StageCall& call, const live::Diagnostics& remarks);

}  // namespace flightwatt::cli

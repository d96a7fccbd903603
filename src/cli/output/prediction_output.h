#pragma once

#include "cli/screen_table.h"
#include "cli/stage.h"
#include "live/prediction.h"
#include "mechanical/validation.h"

#include <string>
#include <vector>

namespace flightwatt::live {
Fields<Prediction> record_fields(const Prediction*);
}

/// Output of predict and validate.
namespace flightwatt::cli {

using live::Prediction;

/// A line each for the energy so far, the remaining energy and the sum; two for the battery.
std::string text_of(const Prediction& of);

/// Prints the diagnostics of a prediction on the standard error.
void warn_of(const StageCall& call, const live::Remarks& remarks);

/// One row a flight, phase and model.
TextTable flights_table(const std::vector<mechanical::ValidatedFlight>& flights);

/// One row a phase and model.
TextTable scores_table(const std::vector<mechanical::ValidatedFlight>& flights);

/// Both tables.
std::string validation_text(const std::vector<mechanical::ValidatedFlight>& flights, const Screen& screen);

/// JSON of validate: scores by phase and model.
struct ValidationOutput {
    const std::vector<mechanical::ValidatedFlight>& flights;
    std::size_t folds = 0;
};
Fields<ValidationOutput> record_fields(const ValidationOutput*);

}  // namespace flightwatt::cli

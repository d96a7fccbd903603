#pragma once

#include "cli/output/json_document.h"
#include "cli/screen_table.h"
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
std::string text_of(const Prediction& prediction);

/// Prints the diagnostics of a prediction on the standard error.
void warn_of(const StageCall& call, const live::Diagnostics& remarks);

/// One row a flight, phase and model.
TextTable flights_table(const std::vector<mechanical::ValidatedFlight>& flights);

/// One row a phase and model.
TextTable scores_table(const std::vector<mechanical::ValidatedFlight>& flights);

/// One sentence a phase: whether `challenger` has the lower mean absolute error; none for ties.
std::string comparison_sentences(const std::vector<mechanical::ValidatedFlight>& flights, const std::string& challenger,
                                 const std::string& baseline);

/// Both tables and the comparisons of the models; `in_flight`: also of the one in flight.
std::string validation_text(const std::vector<mechanical::ValidatedFlight>& flights, bool in_flight,
                            const Screen& screen);

/// JSON of validate: scores by phase and model.
struct ValidationOutput {
    const std::vector<mechanical::ValidatedFlight>& flights;
    std::size_t folds = 0;
};
Fields<ValidationOutput> record_fields(const ValidationOutput*);

}  // namespace flightwatt::cli

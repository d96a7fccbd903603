#pragma once

#include "base/text_table.h"
#include "cli/screen_table.h"
#include "cli/stage.h"
#include "live/prediction.h"
#include "mechanical/validation.h"

#include <string>
#include <vector>

/// Output of predict, and of validate, which compares predictions with measured energies.
namespace flightwatt::cli {

using live::Prediction;

/// A line each for what was flown, what lies ahead and the sum; two for the battery.
std::string text_of(const Prediction& prediction);

/// The same; null for what is not known, and for a battery that does not fail.
Json json_of(const Prediction& prediction);

/// The remarks on a prediction, on the standard error.
void warn_of(const StageCall& call, const live::Diagnostics& remarks);

/// One row a flight, part and model.
TextTable flights_table(const std::vector<mechanical::ValidatedFlight>& flights);

/// One row a part and model.
TextTable scores_table(const std::vector<mechanical::ValidatedFlight>& flights);

/// One sentence a phase: whether `challenger` has the lower mean absolute error; none for ties.
std::string verdict(const std::vector<mechanical::ValidatedFlight>& flights, const std::string& challenger,
                    const std::string& baseline);

/// Both tables, and the verdicts on the models and on the one in flight where it was tried.
std::string validation_text(const std::vector<mechanical::ValidatedFlight>& flights, bool in_flight,
                            const Screen& screen);

/// The scores by phase and model.
Json scores_json(const std::vector<mechanical::ValidatedFlight>& flights);

}  // namespace flightwatt::cli

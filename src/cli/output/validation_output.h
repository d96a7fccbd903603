#pragma once

#include "base/text_table.h"
#include "cli/screen_table.h"
#include "mechanical/covariates.h"
#include "mechanical/validation.h"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// What flightwatt validate shows.
namespace flightwatt::cli {

/// One row a flight, part and model.
TextTable flights_table(const std::vector<mechanical::ValidatedFlight>& flights);

/// One row a part and model.
TextTable scores_table(const std::vector<mechanical::ValidatedFlight>& flights);

/// One sentence a phase: whether `challenger` has the lower mean absolute error; none for ties.
std::string verdict(const std::vector<mechanical::ValidatedFlight>& flights, const std::string& challenger,
                    const std::string& baseline);

/// Both tables, and the verdicts on the models, on those by `covariates`, and on the one in flight where it was tried.
std::string validation_text(const std::vector<mechanical::ValidatedFlight>& flights,
                            const std::vector<mechanical::Covariate>& covariates, bool in_flight, const Screen& screen);

/// The scores by phase and model.
nlohmann::ordered_json scores_json(const std::vector<mechanical::ValidatedFlight>& flights);

}  // namespace flightwatt::cli

#pragma once

#include "batch/batch_run.h"
#include "mechanical/model_errors.h"
#include "mechanical/model_fit.h"
#include "mechanical/phase_samples.h"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace flightwatt::batch {

/// The fit of a batch, with all that is shown of it: nobody has to fit again.
struct BatchFit {
    mechanical::ModelFitOptions options;
    std::set<std::string> excluded;            ///< flights that were not to be used
    std::set<std::string> keep;                ///< flights that were used in spite of what spoke against it
    std::vector<DuplicateFlight> copies = {};  ///< flights that are another one under a second name
    mechanical::MechanicalModel model;         ///< with its errors
    flight::PerPhase<mechanical::CurveBand> bands;
    std::string input_fingerprint;  ///< see fit_fingerprint; empty: not to be recognised
};

/// Of all that a fit is made from: the flights as they are recorded and selected, before copies are looked for, and how
/// they are fitted. Equal where the same program would come to the same model, of the same flights; empty where that
/// cannot be told, as fit.json cannot name a flight.
std::string fit_fingerprint(const BatchFlights& flights, const mechanical::ModelFitOptions& options,
                            const std::string& more);

/// Whether what write_batch_fit wrote into OUT was made from the same, and its files and tables are as they were
/// written.
bool is_fit_current(const std::filesystem::path& out, const std::string& made_from);

/// Fits, analyses the errors and draws the bands. Throws what fit_model throws.
BatchFit fit_flights(std::span<const mechanical::FlightSamples> flights, const mechanical::ModelFitOptions& options);

/// Writes OUT/model.toml (the model alone), OUT/model_errors.toml (with its errors) and OUT/fit.json (options
/// and bands).
void write_batch_fit(const BatchFit& fit, const std::filesystem::path& out);

/// Removes a fit and its tables from OUT. Returns the names of the files that were there.
std::vector<std::string> remove_batch_fit(const std::filesystem::path& out);

/// What write_batch_fit wrote; std::nullopt where there is no model. Throws InputError where a file is
/// missing, damaged or of a newer format.
std::optional<BatchFit> read_batch_fit(const std::filesystem::path& out);

}  // namespace flightwatt::batch

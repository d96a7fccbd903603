#pragma once

#include "batch/batch_run.h"
#include "mechanical/model_fit.h"
#include "mechanical/phase_samples.h"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace flightwatt::batch {

/// The fit of a batch, with everything that the report shows of it.
struct BatchFit {
    mechanical::ModelFitOptions options;
    std::set<std::string> excluded;             ///< flights of --exclude
    std::set<std::string> keep;                 ///< flights of --keep
    std::vector<DuplicateFlight> copies = {};   ///< duplicates of other flights
    std::set<std::string> other_aircraft = {};  ///< flights of others than the aircraft of --aircraft
    mechanical::MechanicalModel model;          ///< with its errors
    flight::PerPhase<mechanical::CurveBand> bands;
};

/// Fits, and computes errors and bands. Throws what fit_model throws.
BatchFit fit_flights(std::span<const mechanical::FlightSamples> flights, const mechanical::ModelFitOptions& options);

/// Writes OUT/model.toml (the model alone), OUT/model_errors.toml (with its errors) and OUT/fit.json (options
/// and bands).
void write_batch_fit(const BatchFit& fit, const std::filesystem::path& out);

/// Removes a fit and its tables from OUT. Returns the names of the files that were there.
std::vector<std::string> remove_batch_fit(const std::filesystem::path& out);

/// Reads the files of write_batch_fit; std::nullopt without a model. Throws InputError where a file is
/// missing, damaged or of a newer format.
std::optional<BatchFit> read_batch_fit(const std::filesystem::path& out);

}  // namespace flightwatt::batch

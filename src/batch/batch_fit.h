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
    std::string key = {};                       ///< see fit_key
    mechanical::MechanicalModel model;          ///< with its errors
    flight::PerPhase<mechanical::CurveBand> bands;
};

/// Fits, and computes errors and bands. Throws what fit_model throws.
BatchFit fit_flights(std::span<const mechanical::FlightSamples> flights, const mechanical::ModelFitOptions& options);

/// Returns the fingerprint of all that a fit depends on: this version, the options and names of `fit`, which has no key
/// or bands yet, and the flights' phases and records that are used.
std::string fit_key(const BatchFlights& flights, const BatchFit& fit);

/// Reads the fit of an earlier run with the same key; std::nullopt without one, or where a file of it has changed.
std::optional<BatchFit> unchanged_batch_fit(const std::filesystem::path& out, const std::string& key);

/// Writes OUT/model.toml (the model alone), OUT/model_errors.toml (with its errors) and OUT/fit.json (options
/// and bands).
void write_batch_fit(const BatchFit& fit, const std::filesystem::path& out);

/// Removes a fit and its tables from OUT. Returns the names of the files that were there.
std::vector<std::string> remove_batch_fit(const std::filesystem::path& out);

/// Reads the files of write_batch_fit; std::nullopt without a model. Throws InputError where a file is
/// missing, damaged or of a newer format.
std::optional<BatchFit> read_batch_fit(const std::filesystem::path& out);

}  // namespace flightwatt::batch

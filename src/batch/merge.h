#pragma once

#include "batch/batch_run.h"
#include "batch/manifest.h"

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

/// Merges folders of batches into the folder that one batch of all logs would have written.
namespace flightwatt::batch {

/// A flight of a batch, in the order of `MergePlan::folder.logs`.
struct MergedFlight {
    std::string from;    ///< the folder of its batch
    std::string flight;  ///< its name there
};

struct MergePlan {
    BatchPlan folder;                   ///< contents of OUT
    std::vector<MergedFlight> sources;  ///< of `folder.logs`
    std::size_t duplicate_logs = 0;     ///< repeated logs of several batches
};

/// Joins the lists of several batches: each log once, by path, named as by find_logs, independent of the partition. Of
/// `only`, unless it is empty, these flights alone.
/// `prune` drops flights in `out` that are in none of the batches. Throws UsageError if `out` is one of the batches, or
/// has such flights without `prune`; InputError for a folder without a finished batch, and for a log that two batches
/// read differently.
MergePlan plan_merge(const std::vector<std::filesystem::path>& batches, const std::filesystem::path& out, bool prune,
                     const std::set<std::string>& only = {});

/// Copies every flight into OUT/flights after verifying its fingerprints (hard links where possible); up-to-date ones
/// stay. In the order of the plan, without the samples, after prepare_folder. Throws InputError for a changed flight,
/// OutputError where OUT cannot be written.
BatchFlights merge_flights(const MergePlan& plan, const std::filesystem::path& out, const BatchProgress& progress,
                           const flight::LoadOptions& options = {});

/// Makes a batch of some flights of another batch, with its lists of files, and without a catalogue and a fit.
BatchFlights copy_flights(const std::filesystem::path& from, const std::set<std::string>& flights,
                          const BatchOptions& to);

}  // namespace flightwatt::batch

#pragma once

#include "batch/batch_run.h"
#include "batch/manifest.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// Several folders of batches as one: what one batch of all their logs would have written, without the logs.
namespace flightwatt::batch {

/// A flight that is taken over, in the order of `MergePlan::folder.logs`.
struct MergedFlight {
    std::string from;    ///< the folder of its batch
    std::string flight;  ///< what it is called there
};

struct MergePlan {
    BatchPlan folder;                            ///< what is going to stand in OUT, as for a batch of all logs
    std::vector<MergedFlight> sources;           ///< of `folder.logs`, one each
    std::vector<std::size_t> flights_per_batch;  ///< flights of each batch
    std::size_t duplicate_logs = 0;              ///< logs that are in several batches, each beyond the first
};

/// Joins the lists of several batches: logs in the order of their paths, each once by its place, named as find_logs
/// names them, so that the same comes out however the logs were cut, and in whatever order it was joined. With `prune`
/// flights in `out` that are in none of the batches are dropped. Throws UsageError where `out` is one of the batches,
/// or holds such flights and `prune` is not given; InputError for what is no batch's folder, a batch that was not
/// finished, and a log that two batches read differently.
MergePlan plan_merge(const std::vector<std::filesystem::path>& batches, const std::filesystem::path& out, bool prune);

/// Takes every flight over into OUT/flights, checked against the fingerprints of its record: as a hard link where its
/// name stays and the file system can, else as a copy; one that is there already stays. Several flights at a time.
/// Returned in the order of the plan, without the samples. Throws InputError for a flight that is not as its batch
/// wrote it, OutputError where OUT cannot be written. The folder is to be prepared before (manifest.h).
BatchFlights merge_flights(const MergePlan& plan, const std::filesystem::path& out, std::size_t needed_samples,
                           const BatchProgress& progress);

}  // namespace flightwatt::batch

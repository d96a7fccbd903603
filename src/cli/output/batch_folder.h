#pragma once

#include "base/text_table.h"
#include "batch/batch_files.h"
#include "batch/batch_fit.h"
#include "batch/batch_run.h"
#include "cli/output/aircraft_choice.h"
#include "cli/output/flight_options.h"
#include "cli/output/stage_options.h"
#include "cli/stage.h"
#include "mechanical/physical_fit.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// What `batch` and `answer` do in the folder of a batch: read logs, list them, and fit the flights of one aircraft.
namespace flightwatt::cli {

struct BatchArguments {
    FitArguments model;
    FlightArguments flights;
    FlightFilter filter;
    std::optional<std::string> files_from;
    bool no_fit = false;
    bool prune = false;
    bool note_changes = true;  ///< what is dropped from the folder, and what stays
};

/// The folder of a batch while a run changes it: made, locked, and removed at the end if it was made and stayed empty.
class BatchFolder {
  public:
    explicit BatchFolder(const std::filesystem::path& out);

  private:
    BatchFolder(const std::filesystem::path& out, bool was_there);

    batch::FolderLock lock_;
    batch::RemoveIfEmpty if_empty_;
};

/// Throws UsageError if `out` is a folder of the call's logs: results would be taken for logs.
void refuse_folder_of_logs(const StageCall& call, const std::string& out);

/// Returns how the logs of a call are read into OUT: several aircraft are allowed.
batch::BatchOptions batch_options(const BatchArguments& arguments, const std::filesystem::path& out);

/// Reads the call's logs into the folder, incrementally. Throws as batch::find_logs, plan_batch and run_batch.
batch::BatchFlights read_logs(const StageCall& call, const BatchArguments& arguments,
                              const batch::BatchOptions& options, const batch::BatchProgress& progress);

/// Collects the diagnostics of a log's record, and the reason why it is not used.
void add_diagnostics(const StageCall& call, const batch::BatchFlight& flight);

/// The flights of a folder that can be fitted, by aircraft.
struct ListedFlights {
    std::vector<batch::DuplicateFlight> copies;
    ChosenAircraft flown;
};

/// Writes the catalogue of a folder, and leaves the flights of --aircraft for the fit; duplicates are excluded.
ListedFlights list_flights(const StageCall& call, batch::BatchFlights& flights, const batch::BatchOptions& options);

/// A fit with its Table I, and how its physical model came about, where one was asked for.
struct FittedBatch {
    batch::BatchFit fit;
    TextTable table;
    std::optional<mechanical::PhysicalFit> physical;
};

/// Fits what the batch accepted, and writes the model and its Table I; returns std::nullopt, with a note, if nothing is
/// to be fitted. Throws InputError if no log is usable, NoResultError for flights of several aircraft and as the fit.
std::optional<FittedBatch> fit_folder(const StageCall& call, const BatchArguments& arguments,
                                      const batch::BatchFlights& flights, const batch::BatchOptions& options,
                                      const ListedFlights& listed,
                                      const std::optional<mechanical::MechanicalModel>& published = std::nullopt);

/// Removes the model of an earlier run, with a note: without a fit it would be taken for this one's.
void remove_model(const StageCall& call, const std::filesystem::path& out);

/// Removes, with --prune, the folders of `--each` in OUT whose aircraft is not among these; else warns of them.
void settle_folders_of_each(const StageCall& call, const std::filesystem::path& out,
                            const std::vector<batch::AircraftGroup>& aircraft, bool prune);

/// Makes a batch of the flights of one aircraft in a folder of its own below that of all; `options` becomes its own.
batch::BatchFlights separate_aircraft(const batch::AircraftGroup& group, const ChosenAircraft& flown,
                                      batch::BatchOptions& options);

}  // namespace flightwatt::cli

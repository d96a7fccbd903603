#pragma once

#include "batch/aircraft.h"
#include "batch/batch_run.h"
#include "cli/stage.h"
#include "flight/load_flight.h"

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

/// Several aircraft among the flights of a stage: which there are, and which of them is used.
namespace flightwatt::cli {

using AircraftGroups = std::span<const batch::AircraftGroup>;
using FlownAircraft = std::span<const batch::FlightAircraft>;

/// Shows the aircraft as a table on the standard error, with the command for one of them and, if the stage has --each,
/// that for each. Returns a message for an error.
std::string show_aircraft(const StageCall& call, AircraftGroups groups, FlownAircraft flights, bool has_each);

/// Notes the flights of other groups than the chosen one, and warns of those that may be of it.
void note_other_flights(const StageCall& call, AircraftGroups groups, const batch::AircraftGroup& chosen,
                        FlownAircraft flights);

/// The flights for the fit of a batch, by aircraft.
struct ChosenAircraft {
    std::vector<batch::FlightAircraft> flights;
    std::vector<batch::AircraftGroup> groups;
    std::set<std::string> others = {};  ///< flights that --aircraft leaves out
};

/// Leaves the flights of --aircraft for the fit. Throws UsageError where it names no aircraft, or several.
ChosenAircraft choose_aircraft(const StageCall& call, const std::optional<std::string>& aircraft,
                               batch::BatchFlights& flights);

/// Result of `batch --each` for one aircraft.
struct AircraftFolder {
    std::string aircraft;
    std::string folder;
    std::vector<std::string> flights;
    bool has_model = false;
};
Fields<AircraftFolder> record_fields(const AircraftFolder*);

/// The groups that are of one aircraft for certain. Warns of the flights of the others.
std::vector<batch::AircraftGroup> certain_aircraft(const StageCall& call, AircraftGroups groups, FlownAircraft flights);

/// A name for the files of an aircraft: its selector, with '_' for what is not usual in names.
std::string file_name_of(std::string selector);

/// Of many files those of options.aircraft, and those that cannot be read.
std::vector<std::string> files_of_aircraft(const StageCall& call, const std::vector<std::string>& files,
                                           flight::LoadOptions options);

}  // namespace flightwatt::cli

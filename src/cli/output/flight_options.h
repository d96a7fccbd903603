#pragma once

#include "cli/output/aircraft_choice.h"
#include "cli/stage.h"
#include "flight/load_flight.h"
#include "mechanical/measured_flight.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::cli {

/// Options of a stage that makes one result of several flights.
struct FlightArguments {
    flight::LoadOptions load;
    bool mix_aircraft = false;
    bool has_each = false;  ///< the stage has --each
    bool each = false;      ///< a result for each aircraft
};

/// The options of every stage that reads flights: --aircraft, --sortie, --recording, thresholds of the segmentation,
/// --correct-idle-offset, --exclude, --keep and --messages. `needs` is an option that has to be given with them.
void add_flight_options(Options& options, flight::LoadOptions& load, const std::vector<std::string>& needs = {});

/// The same with --mix-aircraft.
void add_flight_options(Options& options, FlightArguments& flights);

/// --each, of stages that can make a result for each aircraft.
void add_each_option(Options& options, FlightArguments& flights, const std::string& description,
                     std::vector<std::string> excludes = {});

/// Which of many flights are used.
struct FlightFilter {
    std::optional<std::chrono::sys_days> since;
    std::optional<std::chrono::sys_days> until;
};

/// --since and --until.
void add_filter_options(Options& options, FlightFilter& filter);

/// Collects what was found in a flight that was read from `file`, unless a batch has shown it.
void add_diagnostics(const StageCall& call, const std::string& file, const flight::LoadedFlight& flight);

/// Collects that a log has no data of the aircraft that was chosen.
void add_other_aircraft(const StageCall& call, const std::string& flight, const flight::OtherAircraftError& error);

/// Collects which recordings of a file have no flight.
void note_unused(const StageCall& call, const std::string& file, const flight::LoadedFile& loaded);

/// The first flight of a file, with its diagnostics. Notes that there are other recordings.
flight::LoadedFlight load_flight(const StageCall& call, const std::string& file, const flight::LoadOptions& options);

/// The candidates of the used recording of a file, with the same note.
flight::Candidates read_recording(const StageCall& call, const std::string& file, const flight::LoadOptions& options);

/// The end of the description of every stage that makes one result of several flights.
inline constexpr auto several_flights_text =
    " FOLDER holds logs, or is\none of flightwatt batch: the flights that it accepted. A flight that cannot be used is named and skipped, and\n"
    "the exit code is then 3 (not for flights of a batch, which has named them).";

/// Flights that count, by the number of the call that read them.
struct UsedFlights {
    std::string aircraft;  ///< with --each: a text that --aircraft takes
    std::vector<std::size_t> numbers;
};

/// Loads the flights of all inputs, one at a time, to make one result of them, or one for each aircraft; returns which
/// of the calls of `read` count. A flight that is there under two names counts once, with a warning: it would be counted
/// twice, and predict itself. The first with its .log counts, or else the first. Throws UsageError for two of one name,
/// and for --exclude and --keep of a flight that is not there; InputError, when all are loaded, for those of
/// several aircraft (batch::group_aircraft) without --aircraft, --each or --mix-aircraft. One of several that cannot be
/// used is skipped (skip_input); where none is left, InputError is thrown.
std::vector<UsedFlights> for_each_flight(
    const StageCall& call, const FlightArguments& arguments,
    const std::function<void(const std::string& file, flight::LoadedFlight& flight)>& read);

/// What was read of the flights of one aircraft.
template <typename T>
struct FlightsOf {
    std::string aircraft;  ///< see UsedFlights
    std::vector<T> flights;
};

/// What `read` makes of each flight that counts, a vector of T each, in one for each aircraft.
template <typename T, typename Read>
std::vector<FlightsOf<T>> from_aircraft(const StageCall& call, const FlightArguments& arguments, const Read& read) {
    std::vector<std::vector<T>> of_each;
    const auto counting = for_each_flight(
        call, arguments, [&](const std::string& file, auto& flight) { of_each.push_back(read(file, flight)); });
    std::vector<FlightsOf<T>> all;
    for (const auto& [aircraft, numbers] : counting) {
        auto& flights = all.emplace_back(FlightsOf<T>{aircraft, {}}).flights;
        for (const auto number : numbers) std::ranges::move(of_each[number], std::back_inserter(flights));
    }
    return all;
}

/// The same of stages without --each.
template <typename T, typename Read>
std::vector<T> from_flights(const StageCall& call, const FlightArguments& arguments, const Read& read) {
    return std::move(from_aircraft<T>(call, arguments, read).front().flights);
}

/// What an exclusion is to the user: a flight that is not used, or one of its phases.
Diagnostic diagnostic_of(const mechanical::Exclusion& exclusion);

/// Collects that a flight, read from `file`, is not used at all: an error with the exit code of skip_input, but a warning
/// where --exclude names it, and for a flight in the folder of a batch.
void leave_out(const StageCall& call, const FlightArguments& arguments, const std::string& file, Diagnostic diagnostic);

/// Collects the parts of a file's flights that are not used.
void add_exclusions(const StageCall& call, const FlightArguments& arguments, const std::string& file,
                    const std::vector<mechanical::Exclusion>& exclusions);

/// Removes the flights of a VTOL that only hover from those of an aircraft that are on the wing, with a warning each.
void exclude_hover(const StageCall& call, const FlightArguments& arguments,
                   std::vector<mechanical::MeasuredFlight>& flights);

/// Whether this is a flight in the folder of a batch, whose diagnostics the batch has shown.
bool is_shown_by_batch(const StageCall& call, const std::string& file);

/// The measured sorties of all flights that count; warns of excluded flights and phases.
std::vector<FlightsOf<mechanical::MeasuredFlight>> measured_by_aircraft(const StageCall& call,
                                                                        const FlightArguments& arguments);
/// The same of stages without --each.
std::vector<mechanical::MeasuredFlight> measured_flights(const StageCall& call, const FlightArguments& arguments);

/// Whether the filter accepts each of the flights of these names. Notes the excluded ones, with the reason. Throws
/// InputError where none is accepted.
std::vector<bool> filter_flights(const StageCall& call, const FlightFilter& filter,
                                 const std::vector<std::string>& flights);

/// The call's inputs with the flights of its folders in place of them: those that flightwatt batch accepted, or the
/// logs of another folder, searched to the bottom. Throws InputError for a folder without any.
std::vector<std::string> files_of(const StageCall& call, const flight::LoadOptions& options);

/// The call with those flights of its inputs and their folders that are chosen. Throws InputError where none is left.
StageCall with_chosen_flights(StageCall call, const FlightFilter& filter, const flight::LoadOptions& options);

/// The name of a flight by that of its file, also of a series that a batch wrote.
std::string flight_of_file(const std::filesystem::path& file);

/// Throws UsageError for --exclude and --keep of a flight that is not in `flights`.
void refuse_unknown_flights(const flight::LoadOptions& options, const std::vector<std::string>& flights);

/// Notes that flights are excluded in groups, if they are.
void note_folds(const StageCall& call, std::size_t flights, std::size_t folds);

}  // namespace flightwatt::cli

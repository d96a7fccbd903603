#pragma once

#include "cli/stage.h"
#include "flight/load_flight.h"
#include "mechanical/measured_flight.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace flightwatt::cli {

/// The options of every stage that reads flights: --aircraft, --sortie, the thresholds of the segmentation,
/// --correct-idle-offset, --exclude, --keep and --messages.
void add_flight_options(boost::program_options::options_description& options);

/// What the user gave of them. Throws UsageError for a value that makes no sense.
flight::LoadOptions read_flight_options(const StageCall& call);

/// Warns of what a user should know of a flight that was read from `file`.
void warn_of(const StageCall& call, const std::string& file, const flight::LoadedFlight& flight);

/// load_flight, with its warnings.
flight::LoadedFlight load_flight(const StageCall& call, const std::string& file, const flight::LoadOptions& options);

/// The end of the description of every stage that makes one result of several flights.
inline constexpr auto several_flights_text =
    " FOLDER holds logs, or is\none of flightwatt batch: the flights that it accepted. A flight that cannot be used is named and skipped, and\n"
    "the exit code is then 3.";

/// --mix-aircraft, of every stage that makes one result of several flights.
void add_mix_option(boost::program_options::options_description& options);

/// Loads the flights of all inputs, one at a time, to make one result of them; returns which of the calls of `read`
/// count. A flight that is there under two names counts once, with a warning: it would be counted twice, and predict
/// itself. The first with its .log counts, or else the first. Throws UsageError for two of
/// one name, and for --exclude and --keep of a flight that is not there; InputError, when all are loaded, for those of
/// several aircraft, or synthetic ones beside real ones, unless --mix-aircraft is given. One of several that cannot be
/// used is skipped (skip_input); where none is left, InputError is thrown.
std::vector<std::size_t> for_each_flight(
    const StageCall& call, const flight::LoadOptions& options,
    const std::function<void(const std::string& file, flight::LoadedFlight& flight)>& read);

/// What `read` makes of each flight that counts, a vector of T each, in one.
template <typename T, typename Read>
std::vector<T> from_flights(const StageCall& call, const flight::LoadOptions& options, const Read& read) {
    std::vector<std::vector<T>> of_each;
    const auto counting = for_each_flight(
        call, options, [&](const std::string& file, auto& flight) { of_each.push_back(read(file, flight)); });
    std::vector<T> all;
    for (const auto number : counting) std::ranges::move(of_each[number], std::back_inserter(all));
    return all;
}

/// The sorties that were measured with so many samples a phase, of all flights that count; says which are excluded.
std::vector<mechanical::MeasuredFlight> measured_flights(const StageCall& call, const flight::LoadOptions& options,
                                                         std::size_t needed_samples);

/// --since, --until and --glob, of stages that take many flights.
void add_choice_options(boost::program_options::options_description& options);

/// Which of the flights of these names those options choose, one each; says which it leaves out and why. Throws
/// InputError where none is left.
std::vector<bool> filter_flights(const StageCall& call, const std::vector<std::string>& flights);

/// The call's inputs with the flights of its folders in place of them: those that flightwatt batch accepted, or the
/// logs of another folder, searched to the bottom. Throws InputError for a folder without any.
std::vector<std::string> files_of(const StageCall& call, const flight::LoadOptions& options);

/// The call with those flights of its inputs and their folders that are chosen. Throws InputError where none is left.
StageCall with_chosen_flights(StageCall call, const flight::LoadOptions& options);

/// The name of a flight by that of its file, also of a series that a batch wrote.
std::string flight_of_file(const std::filesystem::path& file);

/// The names with all flights that match in place of those that are patterns ('20_07_*'). Throws UsageError for one
/// that matches none.
std::set<std::string> expand_patterns(const std::set<std::string>& names, const std::string& option,
                                      const std::vector<std::string>& flights);

/// Throws UsageError for --exclude and --keep of a flight that is none of `flights`.
void refuse_unknown_flights(const flight::LoadOptions& options, const std::vector<std::string>& flights);

/// --folds N: into how many groups flights are parted that are left out together.
void add_folds_option(boost::program_options::options_description& options, std::size_t usual);

/// Says so where flights are not left out alone.
void note_folds(const StageCall& call, std::size_t flights, std::size_t folds);

}  // namespace flightwatt::cli

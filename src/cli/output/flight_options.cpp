#include "cli/output/flight_options.h"

#include "base/error.h"
#include "base/input_file.h"
#include "base/toml_reader.h"
#include "base/units.h"
#include "batch/batch_files.h"
#include "batch/batch_fit.h"
#include "batch/batch_run.h"
#include "batch/log_files.h"
#include "batch/manifest.h"
#include "cli/terminal.h"
#include "flight/flight_identity.h"
#include "mechanical/fit_records.h"
#include "mechanical/model_fit.h"
#include "telemetry/log_configuration.h"

#include <filesystem>
#include <map>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

void refuse_unknown(const std::set<std::string>& names, const std::string& option,
                    const std::vector<std::string>& flights) {
    for (const auto& name : names) {
        if (std::ranges::find(flights, name) != flights.end()) continue;
        throw UsageError(fmt::format("--{} {}: there is no such flight; {}", option, name,
                                     meant_or(name, flights, "there are " + short_list(flights))));
    }
}

bool is_in_batch(const std::string& file) {
    const auto folder = std::filesystem::path(file).parent_path();
    return file.ends_with(batch::series_suffix) && std::filesystem::exists(folder.parent_path() / batch::manifest_name);
}

/// A flight that was read.
struct ReadFlight {
    batch::FlightAircraft flown;
    flight::FlightContent content;
    bool is_sound = false;
};

/// Notes which of several recordings is used.
void note_recording(const StageCall& call, const std::string& file, std::size_t used, std::size_t recordings) {
    if (recordings < 2) return;
    note(call, fmt::format("{}: recording {} of {} is used; --recording N selects another", file, used, recordings));
}

/// The numbers of those that count: each flight once, as its first recording with definitions, or else its first.
std::vector<std::size_t> without_copies(const StageCall& call, const std::vector<ReadFlight>& flights) {
    std::unordered_map<std::uint64_t, std::size_t> used;  // by fingerprint
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto& [flown, content, is_sound] = flights[i];
        if (!is_sound || content.fingerprint == 0) continue;
        auto& best = used.emplace(content.fingerprint, i).first->second;
        if (content.has_definitions && !flights[best].content.has_definitions) best = i;
    }
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const auto original = used.find(flights[i].content.fingerprint);
        if (original == used.end() || original->second == i) {
            numbers.push_back(i);
        } else {
            const auto reason = batch::duplicate_reason(flights[original->second].flown.flight);
            add_diagnostic(call,
                           {Severity::warning, "recorded twice", "it is not used: " + reason, flights[i].flown.flight});
        }
    }
    return numbers;
}

/// The flights to use, by aircraft; without --each all are of one. Throws InputError for several aircraft.
std::vector<UsedFlights> by_aircraft(const StageCall& call, const FlightArguments& arguments,
                                     const std::vector<ReadFlight>& flights, const std::vector<std::size_t>& used) {
    std::vector<batch::FlightAircraft> flown;
    std::vector<std::size_t> sound;
    for (const auto i : used) {
        if (!flights[i].is_sound) continue;
        flown.push_back(flights[i].flown);
        sound.push_back(i);
    }
    const auto groups = batch::group_aircraft(flown);
    const auto used_of = [&](const batch::AircraftGroup& group) {
        UsedFlights of_group{group.selector, {}};
        for (const auto number : group.flights) of_group.numbers.push_back(sound[number]);
        return of_group;
    };
    const auto& aircraft = arguments.load.aircraft;
    if (flown.empty() || (arguments.mix_aircraft && !aircraft)) return {{"", used}};
    if (aircraft) {
        const auto& group = find_aircraft(*aircraft, groups, flown);
        note_other_flights(call, groups, group, flown);
        return {used_of(group)};
    }
    if (!arguments.each && groups.size() < 2) return {{"", used}};
    if (!arguments.each) throw InputError({}, show_aircraft(call, groups, flown, arguments.has_each));
    std::vector<UsedFlights> each;
    for (const auto& group : certain_aircraft(call, groups, flown)) each.push_back(used_of(group));
    return each;
}

/// Throws UsageError: two flights have one name, which is that of their files.
[[noreturn]] void refuse_equal_names(const std::string& flight, const std::string& file, const std::string& other) {
    if (file == other) throw UsageError(fmt::format("flight '{}' is given twice", flight));
    throw UsageError(
        fmt::format("flight '{}' is given twice, by {} and {}: if both flew, 'flightwatt batch' of the "
                    "logs takes equal names apart; give its folder instead",
                    flight, other, file));
}

/// Reason to exclude a flight; empty for one that is used.
std::string why_left_out(const FlightFilter& filter, const std::string& flight) {
    if (!filter.since && !filter.until) return "";
    const auto start = flight::start_in_name(flight);  // of a log that the ground station named after its start
    if (!start) return "its name holds no date (YY_MM_DD__hh_mm_ss)";
    const auto day = std::chrono::floor<std::chrono::days>(*start);
    if (filter.since && day < *filter.since) return "it is before --since";
    if (filter.until && day > *filter.until) return "it is after --until";
    return "";
}

/// Reason why a flight of a batch is not in its fit, by the options of that batch; empty without one.
std::string why_batch_left_out(const std::optional<batch::BatchFit>& fit, const std::string& flight) {
    if (!fit) return "";
    if (fit->excluded.contains(flight)) return "its batch has the option --exclude for it";
    const auto* copy = batch::original_of(flight, fit->copies);
    return copy == nullptr ? "" : "its batch found that it is " + *copy + " under another name";
}

/// A flight of a batch.
struct SeriesFile {
    std::filesystem::path log;  ///< that it was made from
    std::string file;
};

/// The series of the flights that a batch accepted and may fit; --keep overrides the options of the batch.
std::vector<SeriesFile> series_of_batch(const StageCall& call, const std::filesystem::path& out,
                                        const flight::LoadOptions& options) {
    std::vector<SeriesFile> files;
    std::size_t others = 0;
    const auto fit = batch::read_batch_fit(out);
    auto own = options;
    if (fit) own.keep.insert(fit->keep.begin(), fit->keep.end());
    for (const auto& stored : batch::read_stored_flights(out, false)) {
        const auto& record = stored.record;
        const bool is_kept = options.keep.contains(record.flight);
        if (fit && !options.aircraft && !is_kept && fit->other_aircraft.contains(record.flight)) {
            ++others;
            continue;
        }
        const auto left_out = is_kept ? "" : why_batch_left_out(fit, record.flight);
        if (!stored.damage_reason.empty()) {
            warn(call, stored.damage_reason);
        } else if (const auto why = !record.accepted   ? record.error
                                    : left_out.empty() ? batch::exclusion_reason(record, own)
                                                       : left_out;
                   !why.empty() && !options.excluded.contains(record.flight)) {
            if (call.notes)  // the batch has shown it
                add_diagnostic(call, {Severity::note, "not used by the batch", "is not used: " + why, record.flight});
        } else {
            files.push_back({record.log, (out / "flights" / (record.flight + batch::series_suffix)).string()});
        }
    }
    if (others > 0)
        note(call,
             fmt::format("{}: not used, as of other aircraft than its model's: {} of its flights; --aircraft selects "
                         "them",
                         out.string(), others));
    return files;
}

/// Adds those of a batch; a flight that another batch holds too, with the same series, is taken once.
void add_flights_of_batch(const StageCall& call, std::vector<SeriesFile> of_batch,
                          std::map<std::string, std::string>& by_name, std::vector<SeriesFile>& flights) {
    for (auto& flight : of_batch) {
        const auto [other, is_new] = by_name.emplace(flight_of_file(flight.file), flight.file);
        if (is_new || read_file(other->second) != read_file(flight.file))
            flights.push_back(std::move(flight));
        else
            note(call, fmt::format("{} is the same as {}: it is taken once", flight.file, other->second));
    }
}

bool is_of_batch(const std::filesystem::path& folder) { return std::filesystem::exists(folder / batch::manifest_name); }

void add_logs_of_folder(const StageCall& call, const std::string& folder, const flight::LoadOptions& options,
                        std::vector<std::string>& files) {
    for (const auto& log : batch::find_logs({folder}, {}, options.columns)) {
        if (!log.problem.empty())
            skip_input(call, log.path, InputError({log.path}, log.problem));
        else if (!log.why_not_fitted.empty() && !options.keep.contains(log.flight))
            add_diagnostic(call,
                           {Severity::note, "not to be fitted", "is not used: " + log.why_not_fitted, log.flight});
        else
            files.push_back(log.path);
    }
}

}  // namespace

void add_flight_options(Options& options, flight::LoadOptions& load, const std::vector<std::string>& needs) {
    constexpr double max_s = 24.0 * units::seconds_per_hour;
    constexpr double bytes_per_mb = 1e6;
    options.begin_group("Flights", false, needs);
    options.add(
        "aircraft", load.aircraft, {.value = "AIRCRAFT"},
        "the aircraft to read, where several flew: its id or the beginning of that, its name, or a flight of it");
    options.add("sortie", load.sortie, {.value = "N", .min = 1}, "this sortie of the log alone, counted from 1");
    options.add("recording", load.recording, {.value = "N", .min = 1},
                "this recording of a file alone, counted from 1, where its clock restarts");
    options.add("exclude", load.excluded, {.value = "FLIGHT"}, "do not use this flight");
    options.add("keep", load.keep, {.value = "FLIGHT"},
                "use this flight though it would not be used (power faults, not-fitted.txt)");
    options.add(
        "messages", load.messages, input_file("FILE"),
        "definitions for logs without a .log, above all binary ones: a messages.xml, or the .log of the same build");
    options.add("columns", load.columns, input_file("MAP"),
                "column map of CSV files: which of their columns are the tracks of a flight");
    options.add("simulated", load.simulated, "use flights of an autopilot's simulator (SITL, HITL) too");
    options.begin_group("Reading of flights", true, needs);
    options.add("correct-idle-offset", load.correct_idle_offset,
                "subtract from the power what the current sensor reads on the ground");
    auto& thresholds = load.segmentation;
    options.add("rest-time", thresholds.rest_s,
                {.value = "S", .min = 1.0, .max = max_s, .unit = "s", .old_name = "rest"},
                "an aircraft is at rest if its altitude is constant and its motor idles for this time [s]");
    options.add("hold-time", thresholds.hold_s,
                {.value = "S", .min = 0.0, .max = max_s, .above_min = true, .unit = "s", .old_name = "hold"},
                "the altitude is held if it grows by less than a tenth of the flight's height in this time [s]");
    options.add("idle-throttle", thresholds.idle_throttle_percent,
                {.value = "P", .min = 0.0, .max = 100.0, .unit = "%"}, "up to this throttle [%] the motor idles");
    options.add("cruise-fraction", thresholds.cruise_fraction, {.value = "X"},
                "take-off ends and landing begins at this fraction of the height held");
    options.add("ground-fraction", thresholds.ground_fraction, {.value = "X"},
                "below this fraction of the flight's height it is on the ground");
    options.add("flight-height", thresholds.flight_height_m, {.value = "M"}, "minimum height of a flight [m]");
    options.add("max-log-mb", load.max_log_bytes, {.value = "MB", .min = 1.0, .max = 1e6, .scale = bytes_per_mb},
                "refuse a compressed log that unpacks to more, and a larger series file");
    options.add_rule([&load] { validate(load.segmentation); });
    options.begin_group("Options");
}

void add_flight_options(Options& options, FlightArguments& flights) {
    options.add("mix-aircraft", flights.mix_aircraft,
                "use flights of several aircraft as if they were of one, also synthetic ones");
    add_flight_options(options, flights.load);
}

void add_each_option(Options& options, FlightArguments& flights, const std::string& description,
                     std::vector<std::string> excludes) {
    flights.has_each = true;
    excludes.insert(excludes.end(), {"aircraft", "mix-aircraft"});
    options.add("each", flights.each, description, {.excludes = std::move(excludes)});
}

void add_diagnostics(const StageCall& call, const std::string& file, const flight::LoadedFlight& flight) {
    if (is_shown_by_batch(call, file)) return;
    for (const auto& diagnostic : flight.diagnostics) add_diagnostic(call, diagnostic);
}

void add_other_aircraft(const StageCall& call, const std::string& flight, const flight::OtherAircraftError& error) {
    add_diagnostic(call, {Severity::note, "of another aircraft",
                          fmt::format("is not used: {}; {}", error.what(), error.hint()), flight});
}

Diagnostic diagnostic_of(const mechanical::Exclusion& exclusion) {
    const auto& [flight, phase, reason] = exclusion;
    return {Severity::warning, phase ? "phases not used" : "not used: " + kind_of_reason(reason),
            fmt::format("{} is not used in the fit: {}", phase ? phase_word(*phase) : "it", reason), flight};
}

void leave_out(const StageCall& call, const FlightArguments& arguments, const std::string& file,
               Diagnostic diagnostic) {
    if (!is_in_batch(file) && !arguments.load.excluded.contains(diagnostic.flight)) {
        diagnostic.severity = Severity::error;
        call.skipped->push_back({file, diagnostic.text});
    }
    add_diagnostic(call, std::move(diagnostic));
}

void add_exclusions(const StageCall& call, const FlightArguments& arguments, const std::string& file,
                    const std::vector<mechanical::Exclusion>& exclusions) {
    for (const auto& exclusion : exclusions) {
        auto diagnostic = diagnostic_of(exclusion);
        exclusion.phase ? add_diagnostic(call, std::move(diagnostic))
                        : leave_out(call, arguments, file, std::move(diagnostic));
    }
}

void exclude_hover(const StageCall& call, const FlightArguments& arguments,
                   std::vector<mechanical::MeasuredFlight>& flights) {
    auto keep = arguments.load.keep;
    for (const auto& input : call.inputs)
        if (const auto fit = is_of_batch(input) ? batch::read_batch_fit(input) : std::nullopt)
            keep.insert(fit->keep.begin(), fit->keep.end());
    for (const auto& exclusion : mechanical::exclude_hover(flights, keep))
        add_diagnostic(call, diagnostic_of(exclusion));
}

bool is_shown_by_batch(const StageCall& call, const std::string& file) { return !call.notes && is_in_batch(file); }

void note_unused(const StageCall& call, const std::string& file, const flight::LoadedFile& loaded) {
    for (const auto& [number, reason] : loaded.unused)
        add_diagnostic(call, {Severity::note, "recordings without a flight",
                              fmt::format("recording {} is not used: {}", number, reason), flight_of_file(file)});
}

flight::LoadedFlight load_flight(const StageCall& call, const std::string& file, const flight::LoadOptions& options) {
    auto all = flight::load_flights(std::filesystem::path(file), options);
    const auto recordings = all.recordings;
    auto loaded = flight::first_flight(std::move(all));
    if (!options.recording) note_recording(call, file, loaded.recording, recordings);
    refuse_unknown_flights(options, {loaded.series.flight});
    if (options.excluded.contains(loaded.series.flight)) {
        throw UsageError(fmt::format("--exclude {}: no other flight is given", loaded.series.flight));
    }
    add_diagnostics(call, file, loaded);
    return loaded;
}

flight::Candidates read_recording(const StageCall& call, const std::string& file, const flight::LoadOptions& options) {
    const flight::FlightFile log(file, options);
    auto recordings = read_recordings(log, options.aircraft, options.aircraft_required);
    const auto used = choose_recording(recordings, log, options.recording);
    if (!options.recording) note_recording(call, file, used, recordings.size());
    return std::move(recordings[used - 1]);
}

std::vector<UsedFlights> for_each_flight(const StageCall& call, const FlightArguments& arguments,
                                         const std::function<void(const std::string&, flight::LoadedFlight&)>& read) {
    auto options = arguments.load;
    const auto inputs = files_of(call, options);
    options.aircraft_required = inputs.size() == 1;
    std::vector<std::string> flights;
    std::map<std::string, std::string> file_of;  // by flight
    std::vector<ReadFlight> known;
    std::optional<flight::OtherAircraftError> other;
    std::optional<InputError> unusable;
    ProgressBar reading("logs");
    std::size_t done = 0;
    for (const auto& file : inputs) {
        if (inputs.size() > 1) reading.show(done++, inputs.size());
        flight::LoadedFile of_file;
        try {
            of_file = flight::load_flights(std::filesystem::path(file), options);
            reading.hide();  // it may be warned of
            note_unused(call, file, of_file);
        } catch (const flight::OtherAircraftError& error) {
            reading.hide();
            flights.push_back(flight_of_file(file));
            add_other_aircraft(call, flights.back(), error);
            other = error;
            continue;
        } catch (const InputError& error) {
            reading.hide();
            if (inputs.size() == 1) throw;
            flights.push_back(flight_of_file(file));
            if (!options.excluded.contains(flights.back())) skip_input(call, file, error);
            unusable = error;
            continue;
        }
        for (auto& loaded : of_file.flights) {
            const auto name = loaded.series.flight;
            const auto [first, is_new] = file_of.emplace(name, file);
            if (!is_new) refuse_equal_names(name, file, first->second);
            flights.push_back(name);
            add_diagnostics(call, file, loaded);
            known.push_back({batch::aircraft_of(loaded), content_of(loaded.series), loaded.exclusion.empty()});
            read(file, loaded);
        }
    }
    refuse_unknown_flights(options, flights);
    if (other && known.empty()) throw *other;
    if (unusable && known.empty()) throw InputError({}, "no flight is left", "see the reasons above");
    return by_aircraft(call, arguments, known, without_copies(call, known));
}

std::vector<FlightsOf<mechanical::MeasuredFlight>> measured_by_aircraft(const StageCall& call,
                                                                        const FlightArguments& arguments) {
    auto all = from_aircraft<mechanical::MeasuredFlight>(call, arguments, [&](const auto& file, const auto& loaded) {
        auto measured = mechanical::extract_flights(loaded);
        if (!is_shown_by_batch(call, file) && loaded.lacks_power.empty())  // which has a diagnostic of its own
            add_exclusions(call, arguments, file, measured.exclusions);
        return std::move(measured.flights);
    });
    for (auto& of : all) exclude_hover(call, arguments, of.flights);
    return all;
}

std::vector<mechanical::MeasuredFlight> measured_flights(const StageCall& call, const FlightArguments& arguments) {
    return std::move(measured_by_aircraft(call, arguments).front().flights);
}

void refuse_unknown_flights(const flight::LoadOptions& options, const std::vector<std::string>& flights) {
    refuse_unknown(options.excluded, "exclude", flights);
    refuse_unknown(options.keep, "keep", flights);
}

void note_folds(const StageCall& call, std::size_t flights, std::size_t folds) {
    if (flights <= folds) return;
    note(call,
         fmt::format("{0} flights are left out in {1} groups, not each alone, which --folds {0} does", flights, folds));
}

void add_filter_options(Options& options, FlightFilter& filter) {
    options.add("since", filter.since, {.value = "DATE"},
                "flights of this day (2020-07-05) and later, by the date in their names");
    options.add("until", filter.until, {.value = "DATE"}, "flights of this day and before");
    options.add_rule([&filter] {
        if (filter.since && filter.until && *filter.since > *filter.until)
            throw UsageError("--since is after --until: no flight is of both");
    });
}

std::vector<bool> filter_flights(const StageCall& call, const FlightFilter& filter,
                                 const std::vector<std::string>& flights) {
    std::vector<bool> chosen;
    std::string first;
    for (const auto& flight : flights) {
        const auto why = why_left_out(filter, flight);
        chosen.push_back(why.empty());
        if (first.empty() && !why.empty()) first = fmt::format("{} ({})", flight, why);
    }
    const auto left_out = std::ranges::count(chosen, false);
    if (left_out == 0) return chosen;
    if (left_out == std::ssize(flights))
        throw InputError({}, fmt::format("no flight is left of {}: {}", left_out, first), "see --since and --until");
    note(call, fmt::format("{} of {} flights are not used, the first: {}", left_out, flights.size(), first));
    return chosen;
}

std::vector<std::string> files_of(const StageCall& call, const flight::LoadOptions& options) {
    std::vector<std::string> files;
    std::vector<SeriesFile> of_batches;
    std::map<std::string, std::string> by_name;
    for (const auto& input : call.inputs) {
        std::error_code none;
        if (!std::filesystem::is_directory(input, none)) {
            files.push_back(input);
            continue;
        }
        if (!is_of_batch(input)) {
            add_logs_of_folder(call, input, options, files);
            continue;
        }
        add_flights_of_batch(call, series_of_batch(call, input, options), by_name, of_batches);
    }
    // As one batch of all has them, so that the same comes out however they were cut.
    std::ranges::stable_sort(of_batches, {}, &SeriesFile::log);
    for (auto& [log, file] : of_batches) files.push_back(std::move(file));
    if (files.empty()) throw InputError({}, "none of the folders holds a flight that can be used");
    return files;
}

StageCall with_chosen_flights(StageCall call, const FlightFilter& filter, const flight::LoadOptions& options) {
    const auto files = files_of(call, options);
    std::vector<std::string> names;
    names.reserve(files.size());
    for (const auto& file : files) names.push_back(flight_of_file(file));
    const auto chosen = filter_flights(call, filter, names);
    call.inputs.clear();
    for (std::size_t i = 0; i < files.size(); ++i)
        if (chosen[i]) call.inputs.push_back(files[i]);
    return call;
}

std::string flight_of_file(const std::filesystem::path& file) {
    const auto name = file.filename().string();
    const std::string_view series = batch::series_suffix;
    if (name.ends_with(series)) return name.substr(0, name.size() - series.size());
    return telemetry::flight_name(file);
}

}  // namespace flightwatt::cli

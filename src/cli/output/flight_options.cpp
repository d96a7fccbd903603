#include "cli/output/flight_options.h"

#include "base/error.h"
#include "base/toml_reader.h"
#include "base/units.h"
#include "batch/batch_run.h"
#include "cli/stage.h"
#include "cli/terminal.h"
#include "flight/flight_identity.h"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

namespace po = boost::program_options;

std::set<std::string> names_of(const StageCall& call, const std::string& option) {
    const auto names = call.get_optional<std::vector<std::string>>(option).value_or(std::vector<std::string>{});
    return {names.begin(), names.end()};
}

void refuse_unknown(const std::set<std::string>& names, const std::string& option,
                    const std::vector<std::string>& flights) {
    for (const auto& name : names) {
        if (std::ranges::find(flights, name) != flights.end()) continue;
        const auto near = nearest_word(name, flights);
        throw UsageError(fmt::format("--{} {}: there is no such flight{}", option, name,
                                     near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
    }
}

/// A flight that was read.
struct ReadFlight {
    flight::FlightAircraft flown;
    flight::FlightContent content;
    bool is_sound = false;
};

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
            warn(call, fmt::format("{} is excluded: {}", flights[i].flown.flight,
                                   batch::duplicate_reason(flights[original->second].flown.flight)));
        }
    }
    return numbers;
}

/// Throws InputError for those of several aircraft, unless --mix-aircraft is given.
void refuse_mix(const StageCall& call, const std::vector<ReadFlight>& flights, const std::vector<std::size_t>& used) {
    std::vector<flight::FlightAircraft> flown;
    for (const auto i : used)
        if (flights[i].is_sound) flown.push_back(flights[i].flown);
    const auto mix = call.has("mix-aircraft") ? "" : describe_mixed_aircraft(flown);
    if (mix.empty()) return;
    throw InputError({}, fmt::format("the flights are of several aircraft: {}", mix),
                     "use one aircraft's alone, or let all in with --mix-aircraft");
}

}  // namespace

void add_flight_options(po::options_description& options) {
    const flight::SegmentationOptions defaults;
    const auto number = [](const char* unit, double usual, const char* shown) {
        return value<double>(unit)->default_value(usual, shown);
    };
    const auto names = [] { return value<std::vector<std::string>>("FLIGHT")->composing(); };
    po::options_description group("How flights are read");
    auto add = group.add_options();
    add("aircraft", value("ID"), "the aircraft to read, where several flew");
    add("sortie", value("N"), "this sortie of the log alone, counted from 1");
    add("exclude", names(), "do not use this flight");
    add("keep", names(), "use this flight though it would be excluded (power faults, not-fitted.txt)");
    add("correct-idle-offset", "take out of the power what the current sensor reads on the ground");
    add("rest", number("S", defaults.rest_s, "10"),
        "an aircraft that keeps its height so long [s] with its motor idling is at rest");
    add("hold", number("S", defaults.hold_s, "30"),
        "a height that grows by less than a tenth of the flight's in this time [s] is held");
    add("idle-throttle", number("P", defaults.idle_throttle_percent, "5"), "up to this throttle [%] the motor idles");
    add("cruise-fraction", number("X", defaults.cruise_fraction, "0.9"),
        "take-off ends and landing begins at this fraction of the height held");
    add("ground-fraction", number("X", defaults.ground_fraction, "0.025"),
        "below this fraction of the flight's height it is on the ground");
    add("flight-height", number("M", defaults.flight_height_m, "10"), "what stays below this height [m] is no flight");
    add("max-log-mb", value("MB")->default_value("100"),
        "refuse a compressed log that unpacks to more, and a larger series file");
    add("messages", input_file("FILE"),
        "definitions for logs without a .log, above all binary ones: a messages.xml, or the .log of the same build");
    options.add(group);
}

flight::LoadOptions read_flight_options(const StageCall& call) {
    constexpr double max_s = 24.0 * units::seconds_per_hour;
    constexpr std::size_t bytes_per_mb = 1'000'000;
    flight::LoadOptions options;
    options.excluded = names_of(call, "exclude");
    options.keep = names_of(call, "keep");
    options.aircraft_id = call.get_optional<std::string>("aircraft");
    if (call.has("sortie")) options.sortie = count_option(call, "sortie", 1);
    options.correct_idle_offset = call.has("correct-idle-offset");
    auto& segmentation = options.segmentation;
    segmentation.rest_s = number_option(call, "rest", 1.0, max_s);
    segmentation.hold_s = positive_option(call, "hold", "s", max_s).value();
    segmentation.idle_throttle_percent = number_option(call, "idle-throttle", 0.0, 100.0);
    segmentation.cruise_fraction = call.get<double>("cruise-fraction");
    segmentation.ground_fraction = call.get<double>("ground-fraction");
    segmentation.flight_height_m = call.get<double>("flight-height");
    validate(segmentation);
    if (const auto messages = call.get_optional<std::string>("messages")) options.messages = *messages;
    options.max_log_bytes = bytes_per_mb * count_option(call, "max-log-mb", 1, 1'000'000);
    return options;
}

void warn_of(const StageCall& call, const std::string& file, const flight::LoadedFlight& flight) {
    for (const auto& warning : flight.warnings) warn(call, fmt::format("{}: {}", file, warning));
}

flight::LoadedFlight load_flight(const StageCall& call, const std::string& file, const flight::LoadOptions& options) {
    auto loaded = flight::load_flight(std::filesystem::path(file), options);
    refuse_unknown_flights(options, {loaded.series.flight});
    if (options.excluded.contains(loaded.series.flight)) {
        throw UsageError(fmt::format("--exclude {}: no other flight is given", loaded.series.flight));
    }
    warn_of(call, file, loaded);
    return loaded;
}

void add_mix_option(po::options_description& options) {
    options.add_options()("mix-aircraft",
                          "use flights of several aircraft as if they were of one, also synthetic ones");
}

std::vector<std::size_t> for_each_flight(const StageCall& call, const flight::LoadOptions& given,
                                         const std::function<void(const std::string&, flight::LoadedFlight&)>& read) {
    auto options = given;
    const auto inputs = files_of(call, given);
    std::vector<std::string> flights;
    flights.reserve(inputs.size());
    for (const auto& file : inputs) flights.push_back(flight_of_file(file));
    options.excluded = expand_patterns(given.excluded, "exclude", flights);
    flights.clear();
    std::vector<ReadFlight> known;
    std::optional<flight::OtherAircraftError> other;
    std::optional<InputError> unusable;
    ProgressBar reading("logs");
    std::size_t done = 0;
    for (const auto& file : inputs) {
        if (inputs.size() > 1) reading.show(done++, inputs.size());
        flight::LoadedFlight loaded;
        try {
            loaded = flight::load_flight(std::filesystem::path(file), options);
            reading.hide();  // it may be warned of
        } catch (const flight::OtherAircraftError& error) {
            reading.hide();
            flights.push_back(flight_of_file(file));
            note(call, fmt::format("{} is left out: {}; {}", flights.back(), error.what(), error.hint()));
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
        const auto name = loaded.series.flight;
        if (std::ranges::find(flights, name) != flights.end()) {
            throw UsageError(fmt::format("flight '{}' is given twice", name));
        }
        flights.push_back(name);
        warn_of(call, file, loaded);
        known.push_back({{name, loaded.series.aircraft_id, loaded.series.aircraft_name},
                         content_of(loaded.series),
                         loaded.exclusion.empty()});
        read(file, loaded);
    }
    refuse_unknown_flights(options, flights);
    if (other && known.empty()) throw *other;
    if (unusable && known.empty()) throw InputError({}, "no flight is left", "see the reasons above");
    auto used = without_copies(call, known);
    refuse_mix(call, known, used);
    return used;
}

std::vector<mechanical::MeasuredFlight> measured_flights(const StageCall& call, const flight::LoadOptions& options,
                                                         std::size_t needed_samples) {
    return from_flights<mechanical::MeasuredFlight>(call, options, [&](const auto&, const auto& loaded) {
        auto measured = mechanical::extract_flights(loaded, needed_samples);
        for (const auto& exclusion : measured.exclusions) warn(call, to_string(exclusion));
        return std::move(measured.flights);
    });
}

void refuse_unknown_flights(const flight::LoadOptions& options, const std::vector<std::string>& flights) {
    refuse_unknown(options.excluded, "exclude", flights);
    refuse_unknown(options.keep, "keep", flights);
}

void add_folds_option(boost::program_options::options_description& options, std::size_t usual) {
    options.add_options()("folds", value("N")->default_value(std::to_string(usual)),
                          "leave more flights than N out in N groups, not each alone: the time then grows with the "
                          "flights, not with their square");
}

void note_folds(const StageCall& call, std::size_t flights, std::size_t folds) {
    if (flights <= folds) return;
    note(call,
         fmt::format("{0} flights are left out in {1} groups, not each alone, which --folds {0} does", flights, folds));
}

}  // namespace flightwatt::cli

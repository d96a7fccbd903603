#include "cli/output/flight_options.h"

#include "base/error.h"
#include "base/toml_reader.h"
#include "base/units.h"
#include "cli/numeric_options.h"
#include "flight/flight_identity.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

namespace po = boost::program_options;

std::set<std::string> names_of(const StageCall& call, const std::string& option) {
    const auto names = call.maybe<std::vector<std::string>>(option).value_or(std::vector<std::string>{});
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
    options.add(group);
}

flight::LoadOptions read_flight_options(const StageCall& call) {
    constexpr double longest_s = 24.0 * units::seconds_per_hour;
    constexpr std::size_t bytes_per_mb = 1'000'000;
    flight::LoadOptions options;
    options.excluded = names_of(call, "exclude");
    options.keep = names_of(call, "keep");
    options.aircraft_id = call.maybe<std::string>("aircraft");
    if (call.has("sortie")) options.sortie = count_option(call, "sortie", 1);
    options.correct_idle_offset = call.has("correct-idle-offset");
    auto& segmentation = options.segmentation;
    segmentation.rest_s = number_option(call, "rest", 1.0, longest_s);
    segmentation.hold_s = positive_option(call, "hold", "s", longest_s).value();
    segmentation.idle_throttle_percent = number_option(call, "idle-throttle", 0.0, 100.0);
    segmentation.cruise_fraction = call.get<double>("cruise-fraction");
    segmentation.ground_fraction = call.get<double>("ground-fraction");
    segmentation.flight_height_m = call.get<double>("flight-height");
    validate(segmentation);
    options.most_log_bytes = bytes_per_mb * count_option(call, "max-log-mb", 1, 1'000'000);
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

void for_each_flight(const StageCall& call, const flight::LoadOptions& options,
                     const std::function<void(const std::string&, flight::LoadedFlight&)>& use) {
    std::vector<std::string> flights;
    std::vector<flight::FlownBy> used;
    flight::KnownFlights known;
    for (const auto& file : call.inputs) {
        auto loaded = flight::load_flight(std::filesystem::path(file), options);
        const auto name = loaded.series.flight;
        if (std::ranges::find(flights, name) != flights.end()) {
            throw UsageError(fmt::format("flight '{}' is given twice", name));
        }
        flights.push_back(name);
        warn_of(call, file, loaded);
        auto content = content_of(loaded.series);
        if (const auto same = known.find(content)) {
            const auto& other = used[*same].flight;
            warn(call, fmt::format("{} is excluded: it is the same flight as {}, which is used", name, other));
            continue;
        }
        if (loaded.exclusion.empty()) {
            known.add(std::move(content));
            used.push_back({name, loaded.series.aircraft_id, loaded.series.aircraft_name});
        }
        use(file, loaded);
    }
    refuse_unknown_flights(options, flights);
    if (call.has("mix-aircraft")) return;
    if (const auto mix = describe_mix(used); !mix.empty()) {
        throw InputError({}, fmt::format("the flights are of several aircraft: {}", mix),
                         "use one aircraft's alone, or all as if they were of one with --mix-aircraft");
    }
}

void refuse_unknown_flights(const flight::LoadOptions& options, const std::vector<std::string>& flights) {
    refuse_unknown(options.excluded, "exclude", flights);
    refuse_unknown(options.keep, "keep", flights);
}

}  // namespace flightwatt::cli

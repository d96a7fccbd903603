#include "flight/flight_reader.h"

#include "base/error.h"
#include "flight/series_file.h"
#include "flight/telemetry_series.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

std::string choose_aircraft(const telemetry::TelemetryLog& log, const std::optional<std::string>& named) {
    const auto flown = flown_aircraft(log);
    if (named) {
        std::vector<std::string> ids;
        for (const auto& sender : log.senders) ids.push_back(sender.id);
        if (std::find(ids.begin(), ids.end(), *named) != ids.end()) return *named;
        throw InputError({log.data_file.string()}, fmt::format("aircraft {} sent nothing", *named),
                         fmt::format("the log holds {}", fmt::join(ids, ", ")));
    }
    if (flown.size() > 1) {
        throw InputError({log.data_file.string()},
                         fmt::format("several aircraft flew: {}", fmt::join(flown, ", ")),
                         "choose one with --aircraft ID");
    }
    return flown.empty() ? "" : flown.front();
}

}  // namespace

FlightSeries read_flight(const std::filesystem::path& path, const std::optional<std::string>& aircraft_id) {
    if (path.extension() == ".csv" && std::filesystem::is_regular_file(path)) return read_series_csv(path);
    const auto log = read_telemetry(path, flight_messages());
    auto series = flight_series(log, choose_aircraft(log, aircraft_id));
    if (!log.configuration && log.assumed_definitions.empty()) {
        series.warnings.emplace_back("no .log beside it");
    }
    return series;
}

}  // namespace flightwatt::flight

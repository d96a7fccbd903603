#include "batch/stored_flights.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "batch/batch_files.h"
#include "flight/phases_file.h"
#include "flight/series_file.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::batch {
namespace {

std::vector<std::filesystem::path> record_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().filename().string().ends_with(record_ending)) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

StoredFlight read_flight_of(const std::filesystem::path& file) {
    auto record = record_from_json(read_file(file));
    if (!record) {
        throw InputError({file.string()}, "this is no record of a flight that this version writes",
                         "run flightwatt batch again");
    }
    const auto file_name = file.filename().string();
    const auto name = file_name.substr(0, file_name.size() - std::string_view(record_ending).size());
    record->flight = name;  // JSON holds no name that is not UTF-8
    StoredFlight flight{std::move(*record), {}, {}};
    if (!flight.record.accepted) return flight;
    flight.series = flight::read_series_csv(file.parent_path() / (name + series_ending));
    flight.series.flight = name;
    flight.phases = flight::read_phases_csv(file.parent_path() / (name + phases_ending));
    return flight;
}

}  // namespace

std::vector<StoredFlight> read_stored_flights(const std::filesystem::path& out) {
    const auto folder = out / "flights";
    if (!std::filesystem::is_directory(folder)) {
        throw InputError({out.string()}, "this is no folder of flightwatt batch: there is no flights/ in it",
                         fmt::format("make it with: flightwatt batch LOGS -o {}", out.string()));
    }
    std::vector<StoredFlight> flights;
    for (const auto& file : record_files(folder)) flights.push_back(read_flight_of(file));
    if (flights.empty()) {
        throw InputError({folder.string()}, "there is no record of a flight in it",
                         fmt::format("make them with: flightwatt batch LOGS -o {}", out.string()));
    }
    return flights;
}

}  // namespace flightwatt::batch

#pragma once

#include "base/atomic_file.h"
#include "base/number.h"
#include "flight/flight_series.h"
#include "flight/telemetry_series.h"
#include "helpers/test_paths.h"
#include "telemetry/data_file.h"
#include "telemetry/log_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::test {

/// The time of a line "TIME SENDER NAME ..."; NaN for any other.
inline double time_of_line(std::string_view line) {
    const auto first = line.find(' ');
    const auto second = first == std::string_view::npos ? first : line.find(' ', first + 1);
    if (second == std::string_view::npos || second + 1 >= line.size()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    return number_or_nan(line.substr(0, first));
}

/// The lines of a log, each with its break.
inline std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const auto size = std::min(text.find('\n'), text.size() - 1) + 1;
        lines.emplace_back(text.substr(0, size));
        text.remove_prefix(size);
    }
    return lines;
}

/// A log in two: the lines that were written by `until_s`, and those after. A line without a time belongs to
/// the next one that has.
struct CutLog {
    std::string before;
    std::vector<std::string> after;
};

inline CutLog cut_log(std::string_view text, double until_s) {
    const auto lines = lines_of(text);
    std::vector<double> time_s(lines.size());
    double behind_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = lines.size(); i-- > 0;) {
        const auto line = std::string_view(lines[i]).substr(0, lines[i].find('\n'));
        if (const double own_s = time_of_line(line); !std::isnan(own_s)) behind_s = own_s;
        time_s[i] = behind_s;
    }
    CutLog cut;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (time_s[i] <= until_s) {
            cut.before += lines[i];
        } else {
            cut.after.push_back(lines[i]);
        }
    }
    return cut;
}

/// The logs of the project, and the real ones where they are.
inline std::vector<std::filesystem::path> all_logs() {
    std::vector<std::filesystem::path> logs;
    const auto add = [&](const std::filesystem::path& folder) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            if (entry.path().extension() == ".data") logs.push_back(entry.path());
        }
    };
    add(source_dir() / "logs");
    if (std::filesystem::is_directory(hazards_dir())) add(hazards_dir());
    if (!shared_dir().empty()) add(shared_dir() / "flights");
    std::sort(logs.begin(), logs.end());
    return logs;
}

inline std::optional<telemetry::LogConfiguration> configuration_of(const std::filesystem::path& log) {
    const auto file = telemetry::find_log_file(log);
    return file ? std::optional(telemetry::read_log_configuration(*file)) : std::nullopt;
}

/// The series of every sender of telemetry in a text.
inline std::vector<flight::FlightSeries> all_series(std::string_view text,
                                                    const std::optional<telemetry::LogConfiguration>& configuration,
                                                    const std::vector<std::string>& ids = {}) {
    const auto log = telemetry::parse_telemetry(text, "x.data", configuration, flight::flight_messages());
    std::vector<flight::FlightSeries> all;
    for (const auto& id : ids.empty() ? flight::telemetry_senders(log) : ids) {
        all.push_back(flight::flight_series(log, id));
    }
    return all;
}

}  // namespace flightwatt::test

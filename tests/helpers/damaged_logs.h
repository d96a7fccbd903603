#pragma once

#include "base/atomic_file.h"
#include "flight/load_flight.h"
#include "flight/phase_statistics.h"
#include "flight/telemetry_series.h"
#include "helpers/cut_logs.h"
#include "helpers/sample_logs.h"
#include "telemetry/log_reader.h"

#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/ranges.h>

namespace flightwatt::test {

/// A line of telemetry: time, sender, message, fields.
using Words = std::vector<std::string>;

/// A sample log with every line changed; a line without words is left out.
inline std::string damaged_sample(const std::function<void(Words&)>& damage, int number = 1) {
    std::string text;
    for (const auto& line : lines_of(read_file(sample(number)))) {
        std::istringstream stream(line);
        Words words;
        for (std::string word; stream >> word;) words.push_back(word);
        if (words.size() > 2) damage(words);
        if (!words.empty()) text += fmt::format("{}\n", fmt::join(words, " "));
    }
    return text;
}

/// What the programs make of a log's text next to the first sample's .log.
inline flight::LoadedFlight examined(const std::string& text) {
    const auto log = sample(1, ".log");
    auto configuration = telemetry::parse_log_configuration(read_file(log), log);
    return flight::segment_and_check(
        flight::flight_series(
            parse_telemetry(text, "damaged.data", std::move(configuration), flight::flight_messages()), "7"),
        {});
}

/// [Wh] of all sorties.
inline double energy_in_flight_wh(const flight::LoadedFlight& loaded) {
    double energy_wh = 0.0;
    for (const auto& sortie : loaded.phases.sorties)
        energy_wh += integrated_energy_wh(loaded.data.power_w, sortie.start_s(), sortie.end_s());
    return energy_wh;
}

/// All warnings and faults, a line each.
inline std::string said_of(const flight::LoadedFlight& loaded) {
    return fmt::format("{}\n{}", fmt::join(texts_of(loaded.diagnostics), "\n"),
                       fmt::join(loaded.power.power_faults, "\n"));
}

}  // namespace flightwatt::test

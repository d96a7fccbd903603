#include "log_passes.h"

#include "base/number.h"
#include "flight/telemetry_series.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace flightwatt::bench {

std::vector<telemetry::MessageRequest> energy_messages() {
    constexpr std::array<std::string_view, 5> names{"ENERGY", "ESTIMATOR", "NAVIGATION", "PPRZ_MODE", "TAKEOFF"};
    auto requests = flight::flight_messages();
    std::erase_if(requests, [&](const telemetry::MessageRequest& request) {
        return std::find(names.begin(), names.end(), request.message) == names.end();
    });
    return requests;
}

std::size_t row_count(const telemetry::TelemetryLog& log) {
    std::size_t rows = 0;
    for (const auto& sender : log.senders) {
        for (const auto& table : sender.tables) rows += table.time_s.size();
    }
    return rows;
}

std::size_t count_lines(std::string_view text) {
    std::size_t lines = 0;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); at != end; ++lines) {
        const void* const found = std::memchr(at, '\n', static_cast<std::size_t>(end - at));
        at = found == nullptr ? end : static_cast<const char*>(found) + 1;
    }
    return lines;
}

WordCount count_words(std::string_view text) {
    WordCount count;
    telemetry::for_each_line(text, [&](std::string_view rest) {
        ++count.lines;
        while (!rest.empty()) {
            ++count.words;
            count.characters += take_word(rest).size();
        }
    });
    return count;
}

NumberCount count_numbers(std::string_view text) {
    NumberCount count;
    telemetry::for_each_line(text, [&](std::string_view rest) {
        ++count.lines;
        for (int i = 0; !rest.empty(); ++i) {
            const auto word = take_word(rest);
            if (i == 1 || i == 2) continue;  // the sender and the message's name
            const double number = number_or_nan(word);
            if (std::isnan(number)) {
                ++count.others;
            } else {
                ++count.numbers;
                count.sum += number;
            }
        }
    });
    return count;
}

std::filesystem::path benchmark_log() {
    if (const char* named = std::getenv("FLIGHTWATT_BENCH_LOG"); named != nullptr && *named != '\0') return named;
    return std::filesystem::path(FLIGHTWATT_SOURCE_DIR) / "logs" / "opterra_synthetic_01.data";
}

}  // namespace flightwatt::bench

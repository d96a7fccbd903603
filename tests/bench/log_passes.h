#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

/// What the benchmarks do with a log: shared by reader_bench (inside one process) and read_log (a process of
/// its own, beside grep and Python).
namespace flightwatt::bench {

/// What FlightWatt asks of ENERGY, ESTIMATOR, NAVIGATION, PPRZ_MODE and TAKEOFF when it reads a flight.
std::vector<telemetry::MessageRequest> energy_messages();

/// All rows of all senders and messages.
std::size_t row_count(const telemetry::TelemetryLog& log);

/// Lines by std::memchr alone: what any reader of lines has to do at least.
std::size_t count_lines(std::string_view text);

struct WordCount {
    std::size_t lines = 0;
    std::size_t words = 0;
    std::size_t characters = 0;  ///< of the words, without the blanks between
};

/// Splits every line into its words, as Python's `line.split()` does.
WordCount count_words(std::string_view text);

struct NumberCount {
    std::size_t lines = 0;
    std::size_t numbers = 0;
    std::size_t others = 0;  ///< words that are no number: texts, arrays
    double sum = 0.0;
};

/// Splits every line into its words and parses the time and every field as a number.
NumberCount count_numbers(std::string_view text);

/// The log that FLIGHTWATT_BENCH_LOG names, else the synthetic sample. Throws InputError if it is not there.
std::filesystem::path benchmark_log();

}  // namespace flightwatt::bench

#include "base/error.h"
#include "base/number.h"
#include "log_passes.h"
#include "telemetry/data_file.h"
#include "telemetry/log_configuration.h"
#include "telemetry/log_reader.h"

#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

/// One pass over one log as a process of its own, so that scripts/bench can set it beside others.
namespace flightwatt::bench {
namespace {

constexpr auto usage =
    "usage: read_log PASS FILE.data\n"
    "  energy   parse ENERGY, ESTIMATOR, NAVIGATION, PPRZ_MODE and TAKEOFF, as a flight is read\n"
    "  lines    find every line's end by memchr, nothing else\n"
    "  words    split every line into words\n"
    "  numbers  split every line and parse its fields as numbers\n"
    "  memory   as energy; prints the peak memory beyond the file's own pages\n";

/// A line "NAME:  123 kB" of /proc/self/status.
std::size_t status_kb(std::string_view name) {
    std::ifstream status("/proc/self/status");
    for (std::string key; status >> key; status.ignore(1 << 10, '\n')) {
        std::string value;
        if (key != fmt::format("{}:", name) || !(status >> value)) continue;
        if (const auto kb = parse_unsigned(value)) return *kb;
    }
    throw InputError({"/proc/self/status"}, fmt::format("has no {} in kB", name));
}

telemetry::TelemetryLog parse_energy(const std::filesystem::path& path, std::string_view text) {
    std::optional<telemetry::LogConfiguration> configuration;
    if (const auto log_file = telemetry::find_log_file(path))
        configuration = telemetry::read_log_configuration(*log_file);
    return parse_telemetry(text, path, std::move(configuration), energy_messages());
}

/// The peak of resident memory less the file's pages. These are all touched first, so that their number is
/// the same at the peak, whenever that is, as it is at the end.
void print_memory(const std::filesystem::path& path) {
    constexpr std::size_t page_size = 4096;
    const auto data = telemetry::read_data_file(path);
    std::size_t breaks = 0;
    for (std::size_t i = 0; i < data.size(); i += page_size) breaks += data[i] == '\n' ? 1 : 0;
    const auto log = parse_energy(path, data);
    const auto peak_kb = status_kb("VmHWM");
    const auto file_kb = status_kb("RssFile");
    fmt::print("rows {} pages_at_a_break {} peak_kb {} file_kb {} beyond_file_kb {}\n", row_count(log), breaks, peak_kb,
               file_kb, peak_kb - file_kb);
}

int run(std::string_view pass, const std::filesystem::path& path) {
    if (pass == "energy") {
        const auto log = parse_energy(path, telemetry::read_data_file(path));
        fmt::print("lines {} rows {}\n", log.lines, row_count(log));
    } else if (pass == "lines") {
        fmt::print("lines {}\n", count_lines(telemetry::read_data_file(path)));
    } else if (pass == "words") {
        const auto count = count_words(telemetry::read_data_file(path));
        fmt::print("lines {} words {} characters {}\n", count.lines, count.words, count.characters);
    } else if (pass == "numbers") {
        const auto count = count_numbers(telemetry::read_data_file(path));
        fmt::print("lines {} numbers {} others {} sum {}\n", count.lines, count.numbers, count.others, count.sum);
    } else if (pass == "memory") {
        print_memory(path);
    } else {
        fmt::print(stderr, "read_log: error: unknown pass '{}'\n{}", pass, usage);
        return 2;
    }
    return std::fflush(stdout) == 0 ? 0 : 1;
}

}  // namespace
}  // namespace flightwatt::bench

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fputs(flightwatt::bench::usage, stderr);
        return 2;
    }
    try {
        return flightwatt::bench::run(argv[1], argv[2]);
    } catch (const flightwatt::InputError& error) {
        fmt::print(stderr, "read_log: error: {}: {}\n", flightwatt::to_string(error.where()), error.what());
        return 3;
    } catch (const std::exception& error) {
        fmt::print(stderr, "read_log: error: {}\n", error.what());
        return 1;
    }
}

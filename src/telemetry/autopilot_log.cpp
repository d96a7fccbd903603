#include "telemetry/autopilot_log.h"

#include "telemetry/autopilot/dataflash.h"
#include "telemetry/autopilot/row_collector.h"
#include "telemetry/autopilot/ulog.h"
#include "telemetry/autopilot/ulog_tables.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <functional>

namespace flightwatt::telemetry {
namespace {

/// Whether one of the first lines defines a message; a preamble may precede it.
bool defines_formats(std::string_view bytes) {
    bool found = false;
    for_each_line(bytes, [&](std::string_view line) {
        found = found || (line.starts_with("FMT,") && line.find("128") != std::string_view::npos);
    });
    return found;
}

}  // namespace

std::string_view to_string(AutopilotFormat format) {
    if (format == AutopilotFormat::ulog) return "PX4 ULog";
    if (format == AutopilotFormat::sdlog2) return "PX4 sdlog2 log";
    if (format == AutopilotFormat::ulog_tables) return "tables of a PX4 ULog";
    return format == AutopilotFormat::dataflash ? "ArduPilot DataFlash log" : "ArduPilot DataFlash log as text";
}

std::optional<AutopilotFormat> detect_autopilot_format(std::string_view bytes) {
    constexpr std::size_t searched_bytes = 1 << 16;
    bytes = bytes.substr(0, searched_bytes);
    if (is_ulog(bytes)) return AutopilotFormat::ulog;
    if (are_ulog_tables(bytes)) return AutopilotFormat::ulog_tables;
    if (is_dataflash(bytes)) return is_sdlog2(bytes) ? AutopilotFormat::sdlog2 : AutopilotFormat::dataflash;
    if (defines_formats(bytes)) return AutopilotFormat::dataflash_text;
    return std::nullopt;
}

AutopilotLog read_autopilot_log(std::string_view bytes, AutopilotFormat format, const std::filesystem::path& file,
                                const std::vector<MessageRequest>& wanted) {
    const bool is_text = format == AutopilotFormat::dataflash_text;
    const bool has_lines = is_text || format == AutopilotFormat::ulog_tables;
    RowCollector rows(file, wanted);
    if (format == AutopilotFormat::ulog)
        read_ulog(bytes, rows);
    else if (format == AutopilotFormat::ulog_tables)
        read_ulog_tables(bytes, rows);
    else
        read_dataflash(bytes, is_text, rows);
    auto read = rows.take(has_lines);
    std::ranges::stable_sort(read.messages, std::greater(), &AutopilotMessage::count);
    return read;
}

}  // namespace flightwatt::telemetry

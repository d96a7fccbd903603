#include "telemetry/autopilot_log.h"

#include "telemetry/autopilot/dataflash.h"
#include "telemetry/autopilot/row_collector.h"
#include "telemetry/autopilot/ulog.h"
#include "telemetry/autopilot/ulog_tables.h"
#include "telemetry/mavlink/tlog.h"
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

/// Reads a log that the autopilot wrote.
AutopilotLog read_own_log(std::string_view bytes, AutopilotFormat format, const std::filesystem::path& file,
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
    return rows.take(has_lines);
}

}  // namespace

std::string_view to_string(AutopilotFormat format) {
    if (format == AutopilotFormat::ulog) return "PX4 ULog";
    if (format == AutopilotFormat::sdlog2) return "PX4 sdlog2 log";
    if (format == AutopilotFormat::ulog_tables) return "tables of a PX4 ULog";
    if (format == AutopilotFormat::tlog) return "recording of MAVLink";
    return format == AutopilotFormat::dataflash ? "ArduPilot DataFlash log" : "ArduPilot DataFlash log as text";
}

std::optional<AutopilotFormat> detect_autopilot_format(std::string_view bytes) {
    constexpr std::size_t searched_bytes = 1 << 16;
    bytes = bytes.substr(0, searched_bytes);
    if (is_ulog(bytes)) return AutopilotFormat::ulog;
    if (are_ulog_tables(bytes)) return AutopilotFormat::ulog_tables;
    if (is_dataflash(bytes)) return is_sdlog2(bytes) ? AutopilotFormat::sdlog2 : AutopilotFormat::dataflash;
    if (is_tlog(bytes)) return AutopilotFormat::tlog;
    if (defines_formats(bytes)) return AutopilotFormat::dataflash_text;
    return std::nullopt;
}

std::vector<AutopilotLog> read_autopilot_logs(std::string_view bytes, AutopilotFormat format,
                                              const std::filesystem::path& file,
                                              const std::vector<MessageRequest>& wanted) {
    std::vector<AutopilotLog> logs;
    if (format == AutopilotFormat::tlog)
        logs = read_tlog(bytes, file, wanted);
    else
        logs.push_back(read_own_log(bytes, format, file, wanted));
    for (auto& log : logs) std::ranges::stable_sort(log.messages, std::greater(), &AutopilotMessage::count);
    return logs;
}

}  // namespace flightwatt::telemetry

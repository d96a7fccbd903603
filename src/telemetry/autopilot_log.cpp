#include "telemetry/autopilot_log.h"

#include "telemetry/autopilot/dataflash.h"
#include "telemetry/autopilot/ulog.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <system_error>

#include <boost/iostreams/device/mapped_file.hpp>

namespace flightwatt::telemetry {
namespace {

constexpr std::size_t searched_bytes = 1 << 16;

/// Whether one of the first lines defines a message; a preamble may precede it.
bool defines_formats(std::string_view bytes) {
    bool found = false;
    for_each_line(bytes.substr(0, searched_bytes), [&](std::string_view line) {
        found = found || (line.starts_with("FMT,") && line.find("128") != std::string_view::npos);
    });
    return found;
}

}  // namespace

std::string_view to_string(AutopilotFormat format) {
    switch (format) {
        case AutopilotFormat::dataflash:
            return "ArduPilot DataFlash log";
        case AutopilotFormat::dataflash_text:
            return "ArduPilot DataFlash log as text";
        case AutopilotFormat::ulog:
            break;
    }
    return "PX4 ULog";
}

std::optional<AutopilotFormat> detect_autopilot_format(std::string_view bytes) {
    if (is_ulog(bytes)) return AutopilotFormat::ulog;
    if (is_dataflash(bytes.substr(0, searched_bytes))) return AutopilotFormat::dataflash;
    if (defines_formats(bytes)) return AutopilotFormat::dataflash_text;
    return std::nullopt;
}

AutopilotLog read_autopilot_log(std::string_view bytes, AutopilotFormat format, const std::filesystem::path& file,
                                const std::vector<MessageRequest>& wanted) {
    RowCollector rows(file, wanted);
    if (format == AutopilotFormat::ulog)
        read_ulog(bytes, rows);
    else
        read_dataflash(bytes, format == AutopilotFormat::dataflash_text, rows);
    return rows.take(format == AutopilotFormat::dataflash_text);
}

std::vector<AutopilotMessage> autopilot_messages(std::string_view bytes, AutopilotFormat format,
                                                 const std::filesystem::path& file) {
    RowCollector rows(file, {});
    auto messages = format == AutopilotFormat::ulog
                        ? read_ulog(bytes, rows)
                        : read_dataflash(bytes, format == AutopilotFormat::dataflash_text, rows);
    std::erase_if(messages, [](const AutopilotMessage& message) { return message.count == 0; });
    std::ranges::stable_sort(messages, std::greater(), &AutopilotMessage::count);
    return messages;
}

std::optional<MappedFile> map_autopilot_log(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error) || std::filesystem::file_size(file, error) == 0 || error)
        return std::nullopt;
    try {
        const auto memory = std::make_shared<const boost::iostreams::mapped_file_source>(file.string());
        const std::string_view bytes(memory->data(), memory->size());
        if (!detect_autopilot_format(bytes)) return std::nullopt;
        return MappedFile{memory, bytes};
    } catch (const std::exception&) {
        return std::nullopt;  // reading it reports the reason
    }
}

}  // namespace flightwatt::telemetry

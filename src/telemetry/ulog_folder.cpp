#include "telemetry/ulog_folder.h"

#include "base/input_file.h"
#include "telemetry/autopilot/ulog_table_name.h"
#include "telemetry/data_file.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

constexpr std::size_t max_instances = 16;

std::filesystem::path table_in(const std::filesystem::path& folder, std::string_view log, std::string_view topic,
                               std::size_t instance) {
    return folder / fmt::format("{}_{}_{}.csv", log, topic, instance);
}

bool is_file(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

/// The table that represents a log; std::nullopt without one.
std::optional<std::filesystem::path> representative_of(const std::filesystem::path& folder, std::string_view log) {
    for (const auto* topic : representative_topics)
        for (std::size_t i = 0; i < max_instances; ++i)
            if (auto file = table_in(folder, log, topic, i); is_file(file)) return file;
    return std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> find_ulog_tables(const std::filesystem::path& file) {
    const auto name = file.stem().string();
    const auto mark = instance_mark(name);
    if (file.extension() != ".csv" || mark == std::string::npos || mark == 0) return std::nullopt;
    for (auto at = name.rfind('_', mark - 1); at != std::string::npos && at > 0; at = name.rfind('_', at - 1)) {
        auto log = representative_of(file.parent_path(), std::string_view(name).substr(0, at));
        if (log && beginning_of_file(file).starts_with("timestamp")) return log;
    }
    return std::nullopt;
}

std::string join_ulog_tables(const std::filesystem::path& file, const std::vector<MessageRequest>& wanted,
                             std::size_t max_bytes) {
    const auto log = without_topic(file.stem().string());
    std::string text;
    for (const auto& [topic, fields] : wanted) {
        for (std::size_t i = 0; i < max_instances; ++i) {
            const auto table = table_in(file.parent_path(), log, topic, i);
            if (!is_file(table)) continue;
            text += fmt::format("{}{} {} {}\n", ulog_table_marker, topic, i, table.string());
            text += read_file(table, max_bytes - std::min(max_bytes, text.size()), "--max-log-mb raises the limit");
            if (!text.ends_with('\n')) text += '\n';
        }
    }
    return text;
}

}  // namespace flightwatt::telemetry

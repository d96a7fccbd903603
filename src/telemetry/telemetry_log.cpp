#include "telemetry/telemetry_log.h"

#include "base/error.h"
#include "base/number.h"
#include "telemetry/text/line_scanner.h"

#include <algorithm>
#include <cctype>
#include <map>

#include <fmt/format.h>

namespace flightwatt::telemetry {

const Column* MessageTable::column(std::string_view field) const {
    const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.field == field; });
    return found == columns.end() ? nullptr : &*found;
}

const MessageTable* SenderLog::table(std::string_view message) const {
    const auto found =
        std::find_if(tables.begin(), tables.end(), [&](const MessageTable& t) { return t.message == message; });
    return found == tables.end() ? nullptr : &*found;
}

TelemetryLog read_telemetry(std::string_view text, const std::filesystem::path& data_file,
                            std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted) {
    auto log = parse_telemetry(text, data_file, std::move(configuration), wanted);
    if (log.senders.empty() && count_messages(text).empty()) {
        throw InputError({data_file.string(), 1}, fmt::format("holds no telemetry in its {} lines", log.lines),
                         "expected lines such as '335.149 20 ENERGY 69 11.7 3.1 36.6 0.03 0.31'");
    }
    return log;
}

std::vector<std::pair<std::string, std::size_t>> count_messages(std::string_view text) {
    const auto is_name = [](std::string_view word) {
        return !word.empty() && word.size() < 64 && std::isupper(static_cast<unsigned char>(word.front())) &&
               std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
    };
    constexpr std::size_t max_names = 1000;  // Paparazzi has some 300
    std::map<std::string, std::size_t, std::less<>> names;
    scan_lines(text, [&](const ScannedLine& line) {
        WordCursor words(line);
        std::string_view time;
        std::string_view sender;
        std::string_view name;
        if (!words.next(time) || !words.next(sender) || !words.next(name)) return;
        if (!parse_number(time) || !is_name(name)) return;
        if (const auto known = names.find(name); known != names.end()) {
            ++known->second;
        } else if (names.size() < max_names) {
            names.emplace(name, 1);
        }
    });
    std::vector<std::pair<std::string, std::size_t>> census(names.begin(), names.end());
    std::stable_sort(census.begin(), census.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    return census;
}

}  // namespace flightwatt::telemetry

#include "base/error.h"
#include "base/number.h"
#include "telemetry/columns/message_plan.h"
#include "telemetry/telemetry_log.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::telemetry {

const Column* MessageTable::column(std::string_view field) const {
    const auto found = std::ranges::find(columns, field, &Column::field);
    return found == columns.end() ? nullptr : &*found;
}

const MessageTable* SenderLog::table(std::string_view message) const {
    const auto found = std::ranges::find(tables, message, &MessageTable::message);
    return found == tables.end() ? nullptr : &*found;
}

TelemetryLog read_telemetry(std::string_view text, const std::filesystem::path& data_file,
                            std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted) {
    auto log = parse_telemetry(text, data_file, std::move(configuration), wanted);
    if (log.senders.empty() && count_messages(text).empty()) {
        throw InputError({data_file.string(), 1}, fmt::format("has no telemetry in its {} lines", log.lines),
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
    for_each_line(text, [&](std::string_view rest) {
        const auto time = take_word(rest);
        take_word(rest);
        const auto name = take_word(rest);
        if (!is_name(name) || !parse_number(time)) return;
        if (names.contains(name) || names.size() < max_names) ++names[std::string(name)];
    });
    std::vector<std::pair<std::string, std::size_t>> census(names.begin(), names.end());
    std::stable_sort(census.begin(), census.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    return census;
}

/// A wanted message, and its last row.
struct MessageDecoder::Message {
    DecodePlan plan;
    MessageTable row;
};

MessageDecoder::MessageDecoder(const std::optional<LogConfiguration>& configuration,
                               const std::vector<MessageRequest>& wanted) {
    messages_.reserve(wanted.size());
    for (const auto& request : wanted) messages_.push_back({make_decode_plan(request, configuration), {}});
}

MessageDecoder::~MessageDecoder() = default;

void MessageDecoder::restart() {
    assumed_.clear();
    for (auto& message : messages_) {
        message.plan.definition = nullptr;
        message.plan.targets.clear();
        message.plan.units.clear();
    }
}

const MessageTable* MessageDecoder::decode(double time_s, std::string_view message, std::span<const double> values) {
    if (message.ends_with('\r')) message.remove_suffix(1);
    if (message.empty()) {
        ++skipped_["not a message (TIME SENDER NAME ...)"];
        return nullptr;
    }
    const auto name = take_word(message);
    const auto found =
        std::ranges::find(messages_, name, [](const auto& of) -> std::string_view { return of.plan.request.message; });
    if (found == messages_.end()) return nullptr;
    auto& plan = found->plan;
    auto& row = found->row;
    const auto words = split_fields(message, words_);
    const bool is_first = plan.definition == nullptr;
    if (const auto reason = check_field_count(plan, values.empty() ? words : values.size())) {
        ++skipped_[describe_skipped(*reason, plan, 0)];
        return nullptr;
    }
    if (is_first) {
        row = empty_table(plan);
        if (auto text = assumption_of(plan); !text.empty()) assumed_.push_back({std::move(text), time_s});
    }
    row.time_s.clear();
    for (auto& column : row.columns) column.values.clear();
    const auto value_of = [&](const DecodePlan::Target& target) {
        if (!values.empty() && !target.is_first_element) return values[target.field];
        return field_value(target, target.field < words ? words_[target.field] : std::string_view());
    };
    append_row(row, plan, time_s, value_of,
               [&](std::size_t field) { ++skipped_[describe_skipped(SkipReason::not_a_number, plan, field)]; });
    return &row;
}

}  // namespace flightwatt::telemetry

#include "base/error.h"
#include "base/number.h"
#include "telemetry/columns/message_plan.h"
#include "telemetry/telemetry_log.h"
#include "telemetry/text/line_scanner.h"

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
    words_.clear();
    for (auto rest = message; !rest.empty();) {
        words_.push_back(rest.substr(0, rest.find(' ')));
        rest.remove_prefix(std::min(words_.back().size() + 1, rest.size()));
    }
    if (words_.empty()) {
        ++skipped_["not a message (TIME SENDER NAME ...)"];
        return nullptr;
    }
    const auto found = std::ranges::find(messages_, words_.front(),
                                         [](const auto& of) -> std::string_view { return of.plan.request.message; });
    if (found == messages_.end()) return nullptr;
    auto& plan = found->plan;
    auto& row = found->row;
    const auto skip = [&](SkipReason reason, std::size_t field = 0) {
        ++skipped_[describe_skipped(reason, plan, field)];
    };
    const auto count = values.empty() ? std::min(words_.size() - 1, max_fields) : values.size();
    if (plan.definition == nullptr && choose_definition(plan, count)) {
        row = empty_table(plan);
        row.time_s.resize(1);
        for (auto& column : row.columns) column.values.resize(1);
        if (auto text = assumption_of(plan); !text.empty()) assumed_.push_back({std::move(text), time_s});
    }
    if (plan.definition == nullptr || count != plan.definition->fields.size()) {
        skip(plan.candidates.empty() ? SkipReason::unknown_message : SkipReason::other_field_count);
        return nullptr;
    }
    row.time_s.front() = time_s;
    for (std::size_t i = 0; i < plan.targets.size(); ++i) {
        const auto& target = plan.targets[i];
        const auto& word = words_[std::min(target.field + 1, words_.size() - 1)];
        const auto element = target.is_first_element ? word.substr(0, word.find(',')) : word;
        const bool is_text = values.empty() || target.is_first_element;
        const double number = is_text ? number_or_nan(element) : values[target.field];
        if (std::isnan(number)) skip(SkipReason::not_a_number, target.field);
        row.columns[i].values.front() = number * target.factor;
    }
    return &row;
}

}  // namespace flightwatt::telemetry

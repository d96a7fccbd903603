#include "telemetry/message_decoder.h"

#include "telemetry/columns/message_plan.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <utility>

namespace flightwatt::telemetry {

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
        if (auto text = describe_assumption(plan); !text.empty()) assumed_.push_back({std::move(text), time_s});
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

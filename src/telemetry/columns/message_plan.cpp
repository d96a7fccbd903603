#include "telemetry/columns/message_plan.h"

#include "base/error.h"
#include "base/number.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::telemetry {
namespace {

constexpr std::string_view first_element = "[0]";

/// Paparazzi's ids are bytes; some ground programs send under names.
constexpr std::size_t max_senders = 300;

/// Conversion of a field that a .log declares.
FieldConversion declared_conversion(DecodePlan& plan, std::size_t index) {
    auto field = plan.definition->fields[index];
    if (const auto unit = undeclared_unit(*plan.definition, index); !unit.empty()) {
        plan.units.push_back(fmt::format("{} has no unit: {} is assumed", field.name, unit));
        field.unit = unit;
    }
    const auto conversion = find_conversion(plan.definition->name, field);
    constexpr std::string_view no_quantity = "byte_mask";  // of states
    if (!conversion.quantity && !field.unit.empty() && field.unit != no_quantity && field.alt_unit.empty()) {
        constexpr std::size_t max_unit = 20;
        std::ranges::replace_if(
            field.unit, [](char c) { return c < ' ' || c > '~'; }, '?');
        plan.units.push_back(fmt::format("{} has the unknown unit '{}'", field.name, field.unit.substr(0, max_unit)));
    }
    return conversion;
}

/// Chooses the definition that has that number of fields, if there is one.
void choose_definition(DecodePlan& plan, std::size_t field_count) {
    const auto found = std::ranges::find_if(
        plan.candidates, [&](const MessageDefinition& candidate) { return candidate.fields.size() == field_count; });
    if (found == plan.candidates.end()) return;
    plan.definition = &*found;
    for (const auto& field : plan.request.fields) {
        const bool is_first_element = field.ends_with(first_element);
        const auto index =
            field_index(*found, field.substr(0, field.size() - (is_first_element ? first_element.size() : 0)));
        if (!index) continue;
        const auto conversion = is_first_element ? FieldConversion{}
                                : plan.from_log  ? declared_conversion(plan, *index)
                                                 : find_conversion(found->name, found->fields[*index]);
        plan.targets.push_back({*index, conversion.quantity, conversion.factor, is_first_element});
    }
}

/// Time of the first such message of any sender.
double first_time_s(const TelemetryLog& log, const std::string& message) {
    double first_s = std::numeric_limits<double>::infinity();
    for (const auto& sender : log.senders) {
        const auto* table = sender.table(message);
        if (table == nullptr) continue;
        for (const double time_s : table->time_s) first_s = std::min(first_s, time_s);
    }
    return first_s;
}

}  // namespace

DecodePlan make_decode_plan(const MessageRequest& request, const std::optional<LogConfiguration>& configuration) {
    DecodePlan plan;
    plan.request = request;
    plan.from_log = configuration.has_value();
    if (!plan.from_log) {
        plan.candidates = builtin_definitions(request.message);
        return plan;
    }
    const auto& file = configuration->file;
    plan.definitions = file.extension() == ".xml" ? file.filename().string() : "the .log";
    const auto found = configuration->messages.find(request.message);
    if (found != configuration->messages.end()) plan.candidates = {found->second};
    return plan;
}

std::optional<SkipReason> check_field_count(DecodePlan& plan, std::size_t field_count) {
    if (plan.definition == nullptr) choose_definition(plan, field_count);
    if (plan.definition == nullptr && plan.candidates.empty()) return SkipReason::unknown_message;
    const bool fits = plan.definition != nullptr && plan.definition->fields.size() == field_count;
    return fits ? std::nullopt : std::optional(SkipReason::other_field_count);
}

std::size_t split_fields(std::string_view fields, std::vector<std::string_view>& words) {
    if (fields.ends_with('\r')) fields.remove_suffix(1);
    words.clear();
    while (!fields.empty() && words.size() < max_fields) words.push_back(take_word(fields));
    return words.size();
}

double field_value(const DecodePlan::Target& target, std::string_view word) {
    return number_or_nan(target.is_first_element ? word.substr(0, word.find(',')) : word);
}

std::string describe_assumption(const DecodePlan& plan) {
    if (plan.definition == nullptr || (plan.from_log && plan.units.empty())) return {};
    const auto text = plan.from_log ? fmt::format("{}", fmt::join(plan.units, ", ")) : plan.definition->origin;
    return fmt::format("{}: {}", plan.request.message, text);
}

std::string describe_skipped(SkipReason reason, const DecodePlan& plan, std::size_t field) {
    const auto& message = plan.request.message;
    switch (reason) {
        case SkipReason::no_time:
            return message + ": the time is not a number";
        case SkipReason::unknown_message:
            return message + (plan.from_log ? ": not defined in " + plan.definitions : ": its fields are not known");
        case SkipReason::other_field_count:
            return fmt::format("{}: another number of fields than {}", message,
                               plan.from_log ? plan.definitions + " defines" : "is known");
        case SkipReason::not_a_number:
            return fmt::format("{}.{}: not a finite number", message, plan.definition->fields[field].name);
        default:
            break;
    }
    return "not a message (TIME SENDER NAME ...)";
}

MessageTable empty_table(const DecodePlan& plan) {
    MessageTable table{plan.request.message, {}, {}};
    table.columns.reserve(plan.targets.size());
    for (const auto& target : plan.targets)
        table.columns.push_back({plan.definition->fields[target.field].name, target.quantity, {}});
    return table;
}

void note_assumptions(const std::vector<DecodePlan>& plans, TelemetryLog& log) {
    for (const auto& plan : plans) {
        if (auto text = describe_assumption(plan); !text.empty())
            log.assumed_definitions.push_back({std::move(text), first_time_s(log, plan.request.message)});
    }
}

MessageTable& find_or_add_table(TelemetryLog& log, std::string_view sender, const DecodePlan& plan, std::size_t line) {
    auto found = std::ranges::find(log.senders, sender, &SenderLog::id);
    if (found == log.senders.end()) {
        if (log.senders.size() == max_senders) {
            throw InputError({log.data_file.string(), line},
                             fmt::format("'{}' is the sender number {} of this log", sender, max_senders + 1),
                             "a network has fewer: the second word of a line should be an aircraft's id");
        }
        found = log.senders.insert(found, {std::string(sender), {}});
    }
    const auto table = std::ranges::find(found->tables, plan.request.message, &MessageTable::message);
    return table == found->tables.end() ? found->tables.emplace_back(empty_table(plan)) : *table;
}

}  // namespace flightwatt::telemetry

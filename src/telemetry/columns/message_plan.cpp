#include "telemetry/columns/message_plan.h"

#include "base/error.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::telemetry {
namespace {

constexpr std::string_view first_element = "[0]";

/// Paparazzi's ids are bytes; some ground programs send under names.
constexpr std::size_t max_senders = 300;

/// What a field of a .log's definition is taken for.
FieldConversion declared_conversion(DecodePlan& plan, std::size_t index) {
    auto field = plan.definition->fields[index];
    if (const auto unit = undeclared_unit(*plan.definition, index); !unit.empty()) {
        plan.units.push_back(fmt::format("{} has none: {} is assumed", field.name, unit));
        field.unit = unit;
    }
    const auto conversion = find_conversion(plan.definition->name, field);
    if (!conversion.quantity && !field.unit.empty() && field.alt_unit.empty()) {
        constexpr std::size_t max_unit = 20;
        std::ranges::replace_if(
            field.unit, [](char c) { return c < ' ' || c > '~'; }, '?');
        plan.units.push_back(
            fmt::format("{} has '{}', which is none that is known", field.name, field.unit.substr(0, max_unit)));
    }
    return conversion;
}

/// When any sender first sent the message.
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

bool choose_definition(DecodePlan& plan, std::size_t field_count) {
    const auto fits = [&](const MessageDefinition& candidate) { return candidate.fields.size() == field_count; };
    const auto found = std::find_if(plan.candidates.begin(), plan.candidates.end(), fits);
    if (found == plan.candidates.end()) return false;
    plan.definition = &*found;
    plan.fields_wanted = 0;
    for (const auto& field : plan.request.fields) {
        const bool is_first_element = field.ends_with(first_element);
        const auto index =
            field_index(*found, field.substr(0, field.size() - (is_first_element ? first_element.size() : 0)));
        if (!index) continue;
        const auto conversion = is_first_element ? FieldConversion{}
                                : plan.from_log  ? declared_conversion(plan, *index)
                                                 : find_conversion(found->name, found->fields[*index]);
        plan.targets.push_back({*index, conversion.quantity, conversion.factor, is_first_element});
        plan.fields_wanted = std::max(plan.fields_wanted, *index + 1);
    }
    return true;
}

std::string assumption_of(const DecodePlan& plan) {
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
        if (auto text = assumption_of(plan); !text.empty())
            log.assumed_definitions.push_back({std::move(text), first_time_s(log, plan.request.message)});
    }
}

std::size_t LogTables::sender_index(std::string_view sender, std::size_t line) {
    const auto [known, is_new] = sender_index_.try_emplace(std::string(sender), log_.senders.size());
    if (!is_new) return known->second;
    if (log_.senders.size() == max_senders) {
        throw InputError({log_.data_file.string(), line},
                         fmt::format("'{}' is the sender number {} of this log", sender, max_senders + 1),
                         "no network has so many: the second word of a line should be an aircraft's id");
    }
    log_.senders.push_back({std::string(sender), {}});
    slots_.emplace_back(plans_, no_table);
    return known->second;
}

MessageTable& LogTables::new_table(std::size_t sender, std::size_t plan_index, const DecodePlan& plan) {
    auto& tables = log_.senders[sender].tables;
    slots_[sender][plan_index] = tables.size();
    tables.push_back(empty_table(plan));
    return tables.back();
}

void reserve_rows(MessageTable& table, std::size_t read, std::size_t all) {
    constexpr std::size_t too_few_for_a_rate = 1000;
    const auto rows = table.time_s.size();
    auto room = std::max<std::size_t>(64, 2 * rows);
    if (rows >= too_few_for_a_rate) {
        const double promised = static_cast<double>(rows) * static_cast<double>(all) / static_cast<double>(read);
        room = std::max(static_cast<std::size_t>(1.1 * promised), rows + rows / 2);
    }
    table.time_s.reserve(room);
    for (auto& column : table.columns) column.values.reserve(room);
}

}  // namespace flightwatt::telemetry

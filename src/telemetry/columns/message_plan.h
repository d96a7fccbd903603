#pragma once

#include "telemetry/message_definition.h"
#include "telemetry/telemetry_log.h"
#include "telemetry/text/skip_counter.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Common part of the readers of text and of frames: fills the columns of a TelemetryLog with the requested messages.
namespace flightwatt::telemetry {

/// Maximum number of fields of a message; further ones are ignored.
inline constexpr std::size_t max_fields = 64;

/// Plan of decoding one requested message: its definition, and field and factor of each column.
struct DecodePlan {
    MessageRequest request;
    std::vector<MessageDefinition> candidates;      ///< the .log's definition, or the built-in ones
    bool from_log = false;                          ///< the candidates are the .log's
    std::string definitions;                        ///< "the .log" or "messages.xml"
    const MessageDefinition* definition = nullptr;  ///< chosen with the first message that fits
    struct Target {
        std::size_t field;
        std::optional<units::Quantity> quantity;
        double factor;
        bool is_first_element = false;  ///< of an array
    };
    std::vector<Target> targets;
    std::vector<std::string> units;  ///< unexpected units of the .log, and the assumption made for each
};

/// Returns the plan of a requested message, by the .log's definition, else with the built-in ones as candidates.
DecodePlan make_decode_plan(const MessageRequest& request, const std::optional<LogConfiguration>& configuration);

/// Chooses the definition by the number of fields of the first message. Returns why a message with `field_count` fields
/// cannot be used; std::nullopt if it can.
std::optional<SkipReason> check_field_count(DecodePlan& plan, std::size_t field_count);

/// Splits the fields of a message into `words`, up to `max_fields` of them; returns how many the message has (at most
/// `max_fields`). A carriage return at the end is ignored.
std::size_t split_fields(std::string_view fields, std::vector<std::string_view>& words);

/// Returns the raw number of a target from its word; NaN if it is not a finite number.
double field_value(const DecodePlan::Target& target, std::string_view word);

/// Returns the assumption about the message that was made as the .log or a unit is missing; empty without one.
std::string describe_assumption(const DecodePlan& plan);

/// Returns the reason, as text, why a message or its `field` cannot be used.
std::string describe_skipped(SkipReason reason, const DecodePlan& plan, std::size_t field);

/// Returns the table of the plan's message, without rows.
MessageTable empty_table(const DecodePlan& plan);

/// Returns the sender's table of the plan's message, which is added if it is missing. Throws InputError, at `line`, for
/// more senders than a network can have.
MessageTable& find_or_add_table(TelemetryLog& log, std::string_view sender, const DecodePlan& plan, std::size_t line);

/// Appends a row. value_of(target) is the raw number or NaN; on_missing(field) is called for each NaN.
template <typename ValueOf, typename OnMissing>
void append_row(MessageTable& table, const DecodePlan& plan, double time_s, const ValueOf& value_of,
                const OnMissing& on_missing) {
    table.time_s.push_back(time_s);
    for (std::size_t i = 0; i < plan.targets.size(); ++i) {
        const auto& target = plan.targets[i];
        const double number = value_of(target);
        if (std::isnan(number)) on_missing(target.field);
        table.columns[i].values.push_back(number * target.factor);
    }
}

/// Adds the assumptions of all plans to the log, each with the time from which it was needed.
void note_assumptions(const std::vector<DecodePlan>& plans, TelemetryLog& log);

}  // namespace flightwatt::telemetry

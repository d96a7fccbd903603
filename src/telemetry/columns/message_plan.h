#pragma once

#include "telemetry/message_definition.h"
#include "telemetry/telemetry_log.h"
#include "telemetry/text/skip_counter.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

/// What readers of text and of frames share: from wanted messages to the columns of a TelemetryLog.
namespace flightwatt::telemetry {

inline constexpr std::size_t max_fields = 64;

/// Which fields of a message go into which columns, and by what factor.
struct DecodePlan {
    MessageRequest request;
    std::vector<MessageDefinition> candidates;  ///< the .log's one, or the built-in ones
    bool from_log = false;
    std::string definitions;                        ///< "the .log" or "messages.xml"
    const MessageDefinition* definition = nullptr;  ///< chosen at the first message that fits
    struct Target {
        std::size_t field;
        std::optional<units::Quantity> quantity;
        double factor;
        bool is_first_element = false;  ///< of an array
    };
    std::vector<Target> targets;
    std::vector<std::string> units;          ///< what is odd about the .log's units, and what is done about it
    std::size_t fields_wanted = max_fields;  ///< up to the last target's; all while no definition is chosen
};

DecodePlan make_decode_plan(const MessageRequest& request, const std::optional<LogConfiguration>& configuration);

/// Chooses the definition by the number of fields; false if none has it.
bool choose_definition(DecodePlan& plan, std::size_t field_count);

/// What is assumed of the message, for want of a .log or of its units; empty if nothing is.
std::string assumption_of(const DecodePlan& plan);

/// Why a message, or its `field`, cannot be used.
std::string describe_skipped(SkipReason reason, const DecodePlan& plan, std::size_t field);

/// The table of the plan's message, without rows.
MessageTable empty_table(const DecodePlan& plan);

/// Adds to the log what was assumed of its messages, and since when.
void note_assumptions(const std::vector<DecodePlan>& plans, TelemetryLog& log);

/// The tables of a log by sender and message, made as they are needed.
class LogTables {
  public:
    LogTables(TelemetryLog& log, std::size_t plans) : log_(log), plans_(plans) {}

    /// The place of `sender` among the log's. Throws InputError for one too many, at `line`.
    std::size_t sender_index(std::string_view sender, std::size_t line);
    MessageTable& table_of(std::size_t sender, std::size_t plan_index, const DecodePlan& plan) {
        const auto slot = slots_[sender][plan_index];
        return slot == no_table ? new_table(sender, plan_index, plan) : log_.senders[sender].tables[slot];
    }

  private:
    static constexpr std::size_t no_table = std::numeric_limits<std::size_t>::max();

    MessageTable& new_table(std::size_t sender, std::size_t plan_index, const DecodePlan& plan);

    TelemetryLog& log_;
    std::size_t plans_;
    std::vector<std::vector<std::size_t>> slots_;  ///< by sender and plan: index of the table
    std::unordered_map<std::string, std::size_t> sender_index_;
};

/// Room for as many rows as the rest of a log promises at the rate so far, and a tenth more: memory that is never
/// written costs nothing, while columns that grow step by step are copied and faulted in again. `read` of `all` bytes
/// are read.
void reserve_rows(MessageTable& table, std::size_t read, std::size_t all);

}  // namespace flightwatt::telemetry

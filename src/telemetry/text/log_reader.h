#pragma once

#include "base/number.h"
#include "telemetry/telemetry_log.h"
#include "telemetry/text/line_scanner.h"
#include "telemetry/text/row_storage.h"
#include "telemetry/text/skip_counter.h"
#include "telemetry/text/wanted_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::telemetry {

inline constexpr std::size_t max_fields = 64;

/// Which words of a message's line go into which columns, and by what factor.
struct MessagePlan {
    MessageRequest request;
    std::vector<MessageDefinition> candidates;  ///< the .log's one, or the built-in ones
    bool from_log = false;
    const MessageDefinition* definition = nullptr;  ///< chosen at the first line that fits
    struct Target {
        std::size_t field;
        std::optional<units::Quantity> quantity;
        double factor;
    };
    std::vector<Target> targets;
    std::size_t fields_wanted = max_fields;  ///< up to the last target's; all while no definition is chosen
};

inline bool choose_definition(MessagePlan& plan, std::size_t field_count) {
    for (const auto& candidate : plan.candidates) {
        if (candidate.fields.size() != field_count) continue;
        plan.definition = &candidate;
        plan.fields_wanted = 0;
        for (const auto& field : plan.request.fields) {
            if (const auto index = field_index(candidate, field)) {
                const auto conversion = conversion_of(candidate.name, candidate.fields[*index]);
                plan.targets.push_back({*index, conversion.quantity, conversion.factor});
                plan.fields_wanted = std::max(plan.fields_wanted, *index + 1);
            }
        }
        return true;
    }
    return false;
}

/// Reads the lines of one log into its tables: the only state of the hot loop. Part of parse_telemetry.
class LogReader {
  public:
    LogReader(TelemetryLog& log, const std::vector<MessageRequest>& wanted, std::string_view text)
        : log_(log), wanted_(names_of(wanted)), text_(text), skips_(text) {
        for (const auto& request : wanted) {
            MessagePlan plan;
            plan.request = request;
            if (log.configuration) {
                const auto found = log.configuration->messages.find(request.message);
                if (found != log.configuration->messages.end()) plan.candidates = {found->second};
                plan.from_log = true;
            } else {
                plan.candidates = builtin_definitions(request.message);
            }
            plans_.push_back(std::move(plan));
        }
        waiting_.resize(plans_.size());
    }

    void read_line(const ScannedLine& line) {
        bytes_read_ += static_cast<std::size_t>(line.end - line.begin) + 1;
        const auto name = third_word(line);
        if (name.data() == nullptr) {
            if (line.end > line.begin) skips_.add_without_time({Reason::not_a_message, 0}, line);
            return;
        }
        const auto index = wanted_.find(name);
        if (index == WantedMessages::none) return;
        auto& waiting = waiting_[index];
        waiting.lines[waiting.count++] = line;
        if (waiting.count == batch_size) read_waiting(index);
    }

    /// Reads the lines that wait, which must still be in memory.
    void read_waiting() {
        for (std::size_t index = 0; index < waiting_.size(); ++index) read_waiting(index);
    }

    /// Turns the counters into reasons for people. `ends_with_break`: whether the last line was whole.
    void finish(std::size_t lines, bool ends_with_break) {
        log_.lines = lines;
        order_senders();
        for (auto& [kind, skipped] : skips_.take()) {
            const bool cut_off = !ends_with_break && skipped.count() == 1 && skipped.first_line() == lines &&
                                 kind.reason != Reason::not_a_number;
            skipped.reason = cut_off ? "the last line is cut off" : describe(kind);
            log_.skipped.push_back(std::move(skipped));
        }
        for (const auto& plan : plans_) {
            if (plan.definition == nullptr || plan.from_log) continue;
            log_.assumed_definitions.push_back(
                {fmt::format("{}: {}", plan.request.message, plan.definition->origin),
                 first_time_s(plan.request.message)});
        }
    }

  private:
    using Reason = SkipReason;

    /// Lines of one wanted message. They are read in batches, so that the processor finds the same fields of
    /// the same shape again and again.
    static constexpr std::size_t batch_size = 16;
    struct WaitingLines {
        std::array<ScannedLine, batch_size> lines;
        std::size_t count = 0;
    };

    static std::vector<std::string> names_of(const std::vector<MessageRequest>& wanted) {
        std::vector<std::string> names;
        names.reserve(wanted.size());
        for (const auto& request : wanted) names.push_back(request.message);
        return names;
    }

    /// Batches of different messages are read out of the order of the file.
    void order_senders() {
        std::vector<std::pair<std::size_t, SenderLog>> placed;
        for (std::size_t i = 0; i < log_.senders.size(); ++i) {
            placed.emplace_back(first_lines_[i], std::move(log_.senders[i]));
        }
        std::sort(placed.begin(), placed.end(),
                  [](const auto& a, const auto& b) { return a.first < b.first; });
        log_.senders.clear();
        for (auto& [line, sender] : placed) log_.senders.push_back(std::move(sender));
    }

    /// When any sender first sent the message.
    double first_time_s(const std::string& message) const {
        double first_s = std::numeric_limits<double>::infinity();
        for (const auto& sender : log_.senders) {
            const auto* table = sender.table(message);
            if (table == nullptr) continue;
            for (const double time_s : table->time_s) first_s = std::min(first_s, time_s);
        }
        return first_s;
    }

    void read_waiting(std::size_t index) {
        auto& waiting = waiting_[index];
        for (std::size_t i = 0; i < waiting.count; ++i) read_message(index, waiting.lines[i]);
        waiting.count = 0;
    }

    void read_message(std::size_t index, const ScannedLine& line) {
        auto& plan = plans_[index];
        WordCursor words(line);
        std::string_view time;
        std::string_view sender;
        std::string_view name;
        words.next(time);
        words.next(sender);
        words.next(name);
        const double time_s = number_or_nan(time);
        if (std::isnan(time_s)) return skips_.add_without_time({Reason::no_time, index}, line);
        words.trim_return();
        // Where each field begins, as far as one is wanted; it ends a blank before the next begins.
        std::array<const char*, max_fields + 1> begins;  // NOLINT: filled as far as it is read
        std::string_view field;
        std::size_t count = 0;
        for (begins[0] = words.position(); count < plan.fields_wanted && words.next(field); ++count) {
            begins[count + 1] = words.position();
        }
        count = std::min(count + words.words_left(), max_fields);
        if (plan.definition == nullptr && !choose_definition(plan, count)) {
            const auto reason = plan.candidates.empty() ? Reason::unknown_message : Reason::other_field_count;
            return skips_.add({reason, index}, time_s, line.number);
        }
        if (count != plan.definition->fields.size()) {
            return skips_.add({Reason::other_field_count, index}, time_s, line.number);
        }
        auto& table = table_of(sender, index, line.number);
        const auto rows = table.time_s.size();
        if (rows == table.time_s.capacity()) {
            reserve_rows(table, rows_to_reserve(rows, bytes_read_, text_.size()));
        }
        table.time_s.push_back(time_s);
        for (std::size_t i = 0; i < plan.targets.size(); ++i) {
            const auto& target = plan.targets[i];
            const char* const begin = begins[target.field];
            const auto size = static_cast<std::size_t>(begins[target.field + 1] - begin - 1);
            const double number = number_or_nan({begin, size});
            if (std::isnan(number)) {
                skips_.add({Reason::not_a_number, index * max_fields + target.field}, time_s, line.number);
            }
            table.columns[i].values.push_back(number * target.factor);
        }
    }

    MessageTable& table_of(std::string_view sender, std::size_t plan_index, std::size_t line) {
        // Neighbouring lines mostly come from the same sender.
        if (last_sender_ >= log_.senders.size() || log_.senders[last_sender_].id != sender) {
            const auto found = std::find_if(log_.senders.begin(), log_.senders.end(),
                                            [&](const SenderLog& known) { return known.id == sender; });
            last_sender_ = static_cast<std::size_t>(found - log_.senders.begin());
            if (found == log_.senders.end()) {
                log_.senders.push_back({std::string(sender), {}});
                slots_.emplace_back(plans_.size(), no_table);
                first_lines_.push_back(line);
            }
        }
        first_lines_[last_sender_] = std::min(first_lines_[last_sender_], line);
        auto& slot = slots_[last_sender_][plan_index];
        auto& tables = log_.senders[last_sender_].tables;
        if (slot == no_table) {
            slot = tables.size();
            MessageTable table{plans_[plan_index].request.message, {}, {}};
            for (const auto& target : plans_[plan_index].targets) {
                const auto& field = plans_[plan_index].definition->fields[target.field].name;
                table.columns.push_back({field, target.quantity, {}});
            }
            tables.push_back(std::move(table));
        }
        return tables[slot];
    }

    std::string describe(const SkipKind& skip) const {
        const auto plan_index = skip.reason == Reason::not_a_number ? skip.detail / max_fields : skip.detail;
        const auto& plan = plans_[plan_index];
        switch (skip.reason) {
            case Reason::not_a_message:
                return "not a message (TIME SENDER NAME ...)";
            case Reason::no_time:
                return fmt::format("{}: the time is not a number", plan.request.message);
            case Reason::unknown_message:
                return fmt::format("{}: {}", plan.request.message,
                                   plan.from_log ? "not defined in the .log" : "its fields are not known");
            case Reason::other_field_count:
                return fmt::format("{}: another number of fields than {}", plan.request.message,
                                   plan.from_log ? "the .log defines" : "is known");
            case Reason::not_a_number:
                return fmt::format("{}.{}: not a finite number", plan.request.message,
                                   plan.definition->fields[skip.detail % max_fields].name);
        }
        return "";
    }

    static constexpr std::size_t no_table = std::numeric_limits<std::size_t>::max();

    TelemetryLog& log_;
    WantedMessages wanted_;
    std::string_view text_;
    std::size_t bytes_read_ = 0;
    std::vector<MessagePlan> plans_;
    std::vector<WaitingLines> waiting_;  ///< by plan
    SkipCounter skips_;
    std::vector<std::size_t> first_lines_;         ///< by sender, of its first wanted line
    std::vector<std::vector<std::size_t>> slots_;  ///< by sender and plan: index of the table
    std::size_t last_sender_ = no_table;
};

}  // namespace flightwatt::telemetry

#include "base/error.h"
#include "base/number.h"
#include "telemetry/telemetry_log.h"
#include "telemetry/text/line_scanner.h"
#include "telemetry/text/skip_counter.h"
#include "telemetry/text/wanted_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::telemetry {
namespace {

constexpr std::size_t max_fields = 64;
/// Paparazzi's ids are bytes; some ground programs send under names.
constexpr std::size_t most_senders = 300;

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
    std::vector<std::string> units;          ///< what is odd about the .log's units, and what is done about it
    std::size_t fields_wanted = max_fields;  ///< up to the last target's; all while no definition is chosen
};

MessagePlan plan_of(const MessageRequest& request, const std::optional<LogConfiguration>& configuration) {
    MessagePlan plan;
    plan.request = request;
    plan.from_log = configuration.has_value();
    if (!plan.from_log) {
        plan.candidates = builtin_definitions(request.message);
    } else if (const auto found = configuration->messages.find(request.message);
               found != configuration->messages.end()) {
        plan.candidates = {found->second};
    }
    return plan;
}

/// What a field of a .log's definition is taken for.
FieldConversion declared_conversion(MessagePlan& plan, std::size_t index) {
    auto field = plan.definition->fields[index];
    if (const auto unit = undeclared_unit(*plan.definition, index); !unit.empty()) {
        plan.units.push_back(fmt::format("{} has none: {} is assumed", field.name, unit));
        field.unit = unit;
    }
    const auto conversion = conversion_of(plan.definition->name, field);
    if (!conversion.quantity && !field.unit.empty() && field.alt_unit.empty()) {
        constexpr std::size_t longest_unit = 20;
        std::ranges::replace_if(
            field.unit, [](char c) { return c < ' ' || c > '~'; }, '?');
        plan.units.push_back(
            fmt::format("{} has '{}', which is none that is known", field.name, field.unit.substr(0, longest_unit)));
    }
    return conversion;
}

bool choose_definition(MessagePlan& plan, std::size_t field_count) {
    const auto fits = [&](const MessageDefinition& candidate) { return candidate.fields.size() == field_count; };
    const auto found = std::find_if(plan.candidates.begin(), plan.candidates.end(), fits);
    if (found == plan.candidates.end()) return false;
    plan.definition = &*found;
    plan.fields_wanted = 0;
    for (const auto& field : plan.request.fields) {
        const auto index = field_index(*found, field);
        if (!index) continue;
        const auto conversion =
            plan.from_log ? declared_conversion(plan, *index) : conversion_of(found->name, found->fields[*index]);
        plan.targets.push_back({*index, conversion.quantity, conversion.factor});
        plan.fields_wanted = std::max(plan.fields_wanted, *index + 1);
    }
    return true;
}

/// Reads the lines of one log into its tables: the only state of the hot loop.
class LogReader {
  public:
    LogReader(TelemetryLog& log, const std::vector<MessageRequest>& wanted, std::string_view text)
        : log_(log), text_(text), skips_(text) {
        for (const auto& request : wanted) {
            plans_.push_back(plan_of(request, log.configuration));
            wanted_.add(request.message);
        }
    }

    void read_line(const ScannedLine& line) {
        const auto name = third_word(line);
        if (name.data() == nullptr) {
            if (line.end > line.begin) skips_.add_without_time({Reason::not_a_message, 0}, line);
            return;
        }
        if (const auto index = wanted_.find(name); index != WantedMessages::none) read_message(index, line);
    }

    /// Turns the counters into reasons for people. `ends_with_break`: whether the last line was whole.
    void finish(std::size_t lines, bool ends_with_break) {
        log_.lines = lines;
        for (auto& [kind, skipped] : skips_.take()) {
            const bool cut_off = !ends_with_break && skipped.count() == 1 && skipped.first_line() == lines &&
                                 kind.reason != Reason::not_a_number;
            skipped.reason = cut_off ? "the last line is cut off" : describe(kind);
            log_.skipped.push_back(std::move(skipped));
        }
        for (const auto& plan : plans_) {
            const auto& message = plan.request.message;
            if (plan.definition == nullptr || (plan.from_log && plan.units.empty())) continue;
            const auto text = plan.from_log ? fmt::format("{}", fmt::join(plan.units, ", ")) : plan.definition->origin;
            log_.assumed_definitions.push_back({fmt::format("{}: {}", message, text), first_time_s(message)});
        }
    }

  private:
    using Reason = SkipReason;

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
        auto& table = table_of(sender, index, line);
        if (table.time_s.size() == table.time_s.capacity()) make_room(table, line);
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

    /// For as many rows as the rest of the text promises at the rate so far, and a tenth more: memory that is
    /// never written costs nothing, while columns that grow step by step are copied and faulted in again.
    void make_room(MessageTable& table, const ScannedLine& line) const {
        constexpr std::size_t too_few_for_a_rate = 1000;
        const auto rows = table.time_s.size();
        auto room = std::max<std::size_t>(64, 2 * rows);
        if (rows >= too_few_for_a_rate) {
            const bool in_place = line.begin >= text_.data() && line.begin < text_.data() + text_.size();
            const auto read = in_place ? static_cast<std::size_t>(line.end - text_.data()) : text_.size();
            const double promised =
                static_cast<double>(rows) * static_cast<double>(text_.size()) / static_cast<double>(read);
            room = std::max(static_cast<std::size_t>(1.1 * promised), rows + rows / 2);
        }
        table.time_s.reserve(room);
        for (auto& column : table.columns) column.values.reserve(room);
    }

    MessageTable& table_of(std::string_view sender, std::size_t plan_index, const ScannedLine& line) {
        // Neighbouring lines mostly come from the same sender.
        if (last_sender_ >= log_.senders.size() || log_.senders[last_sender_].id != sender) {
            const auto [known, is_new] = sender_index_.try_emplace(std::string(sender), log_.senders.size());
            last_sender_ = known->second;
            if (is_new) add_sender(sender, line);
        }
        auto& slot = slots_[last_sender_][plan_index];
        auto& tables = log_.senders[last_sender_].tables;
        if (slot == no_table) {
            slot = tables.size();
            const auto& plan = plans_[plan_index];
            tables.push_back({plan.request.message, {}, {}});
            for (const auto& target : plan.targets) {
                tables.back().columns.push_back({plan.definition->fields[target.field].name, target.quantity, {}});
            }
        }
        return tables[slot];
    }

    void add_sender(std::string_view sender, const ScannedLine& line) {
        if (log_.senders.size() == most_senders) {
            throw InputError({log_.data_file.string(), line.number},
                             fmt::format("'{}' is the sender number {} of this log", sender, most_senders + 1),
                             "no network has so many: the second word of a line should be an aircraft's id");
        }
        log_.senders.push_back({std::string(sender), {}});
        slots_.emplace_back(plans_.size(), no_table);
    }

    std::string describe(const SkipKind& skip) const {
        const auto& plan = plans_[skip.reason == Reason::not_a_number ? skip.detail / max_fields : skip.detail];
        const auto& message = plan.request.message;
        switch (skip.reason) {
            case Reason::not_a_message:
                break;
            case Reason::no_time:
                return message + ": the time is not a number";
            case Reason::unknown_message:
                return message + (plan.from_log ? ": not defined in the .log" : ": its fields are not known");
            case Reason::other_field_count:
                return fmt::format("{}: another number of fields than {}", message,
                                   plan.from_log ? "the .log defines" : "is known");
            case Reason::not_a_number:
                return fmt::format("{}.{}: not a finite number", message,
                                   plan.definition->fields[skip.detail % max_fields].name);
        }
        return "not a message (TIME SENDER NAME ...)";
    }

    static constexpr std::size_t no_table = std::numeric_limits<std::size_t>::max();

    TelemetryLog& log_;
    std::string_view text_;
    WantedMessages wanted_;
    std::vector<MessagePlan> plans_;
    SkipCounter skips_;
    std::vector<std::vector<std::size_t>> slots_;  ///< by sender and plan: index of the table
    std::unordered_map<std::string, std::size_t> sender_index_;
    std::size_t last_sender_ = no_table;
};

}  // namespace

TelemetryLog parse_telemetry(std::string_view text, const std::filesystem::path& data_file,
                             std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted) {
    TelemetryLog log;
    log.data_file = data_file;
    log.flight = flight_name(data_file);
    log.configuration = std::move(configuration);
    LogReader reader(log, wanted, text);
    const auto lines = scan_lines(text, [&](const ScannedLine& line) { reader.read_line(line); });
    reader.finish(lines, text.ends_with('\n'));
    return log;
}

}  // namespace flightwatt::telemetry

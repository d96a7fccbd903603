#include "telemetry/telemetry_log.h"

#include "base/error.h"
#include "base/number.h"
#include "telemetry/data_file.h"
#include "telemetry/line_scanner.h"
#include "telemetry/wanted_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace flightwatt {
namespace {

constexpr std::size_t max_fields = 64;

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
};

bool choose_definition(MessagePlan& plan, std::size_t field_count) {
    for (const auto& candidate : plan.candidates) {
        if (candidate.fields.size() != field_count) continue;
        plan.definition = &candidate;
        for (const auto& field : plan.request.fields) {
            if (const auto index = field_index(candidate, field)) {
                const auto conversion = conversion_of(candidate.name, candidate.fields[*index]);
                plan.targets.push_back({*index, conversion.quantity, conversion.factor});
            }
        }
        return true;
    }
    return false;
}

/// Reads the lines of one log: the only state of the hot loop.
class LogReader {
  public:
    LogReader(TelemetryLog& log, const std::vector<MessageRequest>& wanted)
        : log_(log), wanted_(names_of(wanted)) {
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
    }

    void read_line(const ScannedLine& line) {
        WordCursor words(line);
        std::string_view time;
        std::string_view sender;
        std::string_view name;
        if (!words.next(time) || !words.next(sender) || !words.next(name)) {
            if (line.end > line.begin) skip(Reason::not_a_message, 0, line.number);
            return;
        }
        const auto index = wanted_.find(name);
        if (index != WantedMessages::none) read_message(index, line, time, sender, words);
    }

    /// Turns the counters into reasons for people. `ends_with_break`: whether the last line was whole.
    void finish(std::size_t lines, bool ends_with_break) {
        log_.lines = lines;
        std::sort(skips_.begin(), skips_.end(),
                  [](const Skip& a, const Skip& b) { return a.first_line < b.first_line; });
        for (const auto& skip : skips_) {
            const bool cut_off = !ends_with_break && skip.count == 1 && skip.first_line == lines &&
                                 skip.reason != Reason::not_a_number;
            log_.skipped.push_back(
                {cut_off ? "the last line is cut off" : describe(skip), skip.count, skip.first_line});
        }
        for (const auto& plan : plans_) {
            if (plan.definition != nullptr && !plan.from_log) {
                log_.assumed_definitions.push_back(
                    fmt::format("{}: {}", plan.request.message, plan.definition->origin));
            }
        }
    }

  private:
    enum class Reason { not_a_message, no_time, other_field_count, unknown_message, not_a_number };
    struct Skip {
        Reason reason;
        std::size_t detail;  ///< plan, and field for not_a_number
        std::size_t count;
        std::size_t first_line;
    };

    static std::vector<std::string> names_of(const std::vector<MessageRequest>& wanted) {
        std::vector<std::string> names;
        for (const auto& request : wanted) names.push_back(request.message);
        return names;
    }

    void skip(Reason reason, std::size_t detail, std::size_t line) {
        for (auto& known : skips_) {
            if (known.reason == reason && known.detail == detail) {
                ++known.count;
                return;
            }
        }
        skips_.push_back({reason, detail, 1, line});
    }

    void read_message(std::size_t index, const ScannedLine& line, std::string_view time_word,
                      std::string_view sender, WordCursor& words) {
        auto& plan = plans_[index];
        const auto time = parse_number(time_word);
        if (!time) return skip(Reason::no_time, index, line.number);
        // Where each field begins; a field ends a blank before the next begins.
        std::array<const char*, max_fields + 1> begins;  // NOLINT: filled as far as it is read
        std::string_view field;
        std::size_t count = 0;
        const char* const line_end = line.end > line.begin && line.end[-1] == '\r' ? line.end - 1 : line.end;
        for (begins[0] = words.position(); count < max_fields && words.next(field); ++count) {
            begins[count + 1] = words.position();
        }
        if (count > 0 && begins[count] > line_end) begins[count] = line_end + 1;
        if (count > 0 && begins[count - 1] >= line_end)
            --count;  // a blank or a return at the end is no field
        if (plan.definition == nullptr && !choose_definition(plan, count)) {
            const auto reason = plan.candidates.empty() ? Reason::unknown_message : Reason::other_field_count;
            return skip(reason, index, line.number);
        }
        if (count != plan.definition->fields.size()) {
            return skip(Reason::other_field_count, index, line.number);
        }
        auto& table = table_of(sender, index);
        table.time_s.push_back(*time);
        for (std::size_t i = 0; i < plan.targets.size(); ++i) {
            const auto& target = plan.targets[i];
            double value = std::numeric_limits<double>::quiet_NaN();
            const char* const begin = begins[target.field];
            const auto size = static_cast<std::size_t>(begins[target.field + 1] - begin - 1);
            if (const auto number = parse_number({begin, size})) {
                value = *number * target.factor;
            } else {
                skip(Reason::not_a_number, index * max_fields + target.field, line.number);
            }
            table.columns[i].values.push_back(value);
        }
    }

    MessageTable& table_of(std::string_view sender, std::size_t plan_index) {
        // Neighbouring lines mostly come from the same sender.
        if (last_sender_ >= log_.senders.size() || log_.senders[last_sender_].id != sender) {
            const auto found = std::find_if(log_.senders.begin(), log_.senders.end(),
                                            [&](const SenderLog& known) { return known.id == sender; });
            last_sender_ = static_cast<std::size_t>(found - log_.senders.begin());
            if (found == log_.senders.end()) {
                log_.senders.push_back({std::string(sender), {}});
                slots_.emplace_back(plans_.size(), no_table);
            }
        }
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

    std::string describe(const Skip& skip) const {
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
    std::vector<MessagePlan> plans_;
    std::vector<Skip> skips_;
    std::vector<std::vector<std::size_t>> slots_;  ///< by sender and plan: index of the table
    std::size_t last_sender_ = no_table;
};

}  // namespace

const Column* MessageTable::column(std::string_view field) const {
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.field == field; });
    return found == columns.end() ? nullptr : &*found;
}

const MessageTable* SenderLog::table(std::string_view message) const {
    const auto found = std::find_if(tables.begin(), tables.end(),
                                    [&](const MessageTable& t) { return t.message == message; });
    return found == tables.end() ? nullptr : &*found;
}

TelemetryLog parse_telemetry(std::string_view text, const std::filesystem::path& data_file,
                             std::optional<LogConfiguration> configuration,
                             const std::vector<MessageRequest>& wanted) {
    TelemetryLog log;
    log.data_file = data_file;
    log.flight = flight_name(data_file);
    log.configuration = std::move(configuration);
    LogReader reader(log, wanted);
    const auto lines = scan_lines(text, [&](const ScannedLine& line) { reader.read_line(line); });
    reader.finish(lines, text.ends_with('\n'));
    return log;
}

TelemetryLog read_telemetry(const std::filesystem::path& data_file,
                            const std::vector<MessageRequest>& wanted) {
    const DataFile data(data_file);
    std::optional<LogConfiguration> configuration;
    if (const auto log_file = find_log_file(data_file)) configuration = read_log_configuration(*log_file);
    auto log = parse_telemetry(data.text(), data_file, std::move(configuration), wanted);
    if (log.senders.empty() && census_of_messages(data.text()).empty()) {
        throw InputError({data_file.string(), 1},
                         fmt::format("holds no telemetry in its {} lines", log.lines),
                         "expected lines such as '335.149 20 ENERGY 69 11.7 3.1 36.6 0.03 0.31'");
    }
    return log;
}

std::vector<std::pair<std::string, std::size_t>> census_of_messages(std::string_view text) {
    std::vector<std::pair<std::string, std::size_t>> census;
    const auto is_name = [](std::string_view word) {
        return !word.empty() && word.size() < 64 && std::isupper(static_cast<unsigned char>(word.front())) &&
               std::all_of(word.begin(), word.end(),
                           [](unsigned char c) { return std::isalnum(c) || c == '_'; });
    };
    std::map<std::string, std::size_t> names;
    scan_lines(text, [&](const ScannedLine& line) {
        WordCursor words(line);
        std::string_view time;
        std::string_view sender;
        std::string_view name;
        if (!words.next(time) || !words.next(sender) || !words.next(name)) return;
        if (parse_number(time) && is_name(name)) ++names[std::string(name)];
    });
    census.assign(names.begin(), names.end());
    std::stable_sort(census.begin(), census.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    return census;
}

}  // namespace flightwatt

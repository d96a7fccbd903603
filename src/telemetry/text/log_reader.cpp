#include "base/number.h"
#include "telemetry/columns/message_plan.h"
#include "telemetry/telemetry_log.h"
#include "telemetry/text/line_scanner.h"
#include "telemetry/text/skip_counter.h"
#include "telemetry/text/wanted_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace flightwatt::telemetry {
namespace {

/// Reads the lines of one log into its tables: the only state of the hot loop.
class LogReader {
  public:
    LogReader(TelemetryLog& log, const std::vector<MessageRequest>& wanted, std::string_view text)
        : log_(log), text_(text), skips_(text), tables_(log, wanted.size()) {
        for (const auto& request : wanted) {
            plans_.push_back(make_decode_plan(request, log.configuration));
            wanted_.add(request.message);
        }
    }

    void read_line(const ScannedLine& line) {
        const auto name = third_word(line);
        if (name.data() == nullptr) {
            if (line.end > line.begin) skips_.add_without_time({Reason::not_a_message, 0}, line);
            return;
        }
        if (const auto index = wanted_.find(name); index != MessageNameSet::none) read_message(index, line);
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
        note_assumptions(plans_, log_);
    }

  private:
    using Reason = SkipReason;

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
        if (table.time_s.size() == table.time_s.capacity()) reserve_rows(table, bytes_read(line), text_.size());
        table.time_s.push_back(time_s);
        for (std::size_t i = 0; i < plan.targets.size(); ++i) {
            const auto& target = plan.targets[i];
            const char* const begin = begins[target.field];
            const auto size = static_cast<std::size_t>(begins[target.field + 1] - begin - 1);
            const std::string_view word(begin, size);
            const double number = number_or_nan(target.is_first_element ? word.substr(0, word.find(',')) : word);
            if (std::isnan(number)) {
                skips_.add({Reason::not_a_number, index * max_fields + target.field}, time_s, line.number);
            }
            table.columns[i].values.push_back(number * target.factor);
        }
    }

    std::size_t bytes_read(const ScannedLine& line) const {
        const bool in_place = line.begin >= text_.data() && line.begin < text_.data() + text_.size();
        return in_place ? static_cast<std::size_t>(line.end - text_.data()) : text_.size();
    }

    MessageTable& table_of(std::string_view sender, std::size_t plan_index, const ScannedLine& line) {
        // Neighbouring lines mostly come from the same sender.
        if (last_sender_ >= log_.senders.size() || log_.senders[last_sender_].id != sender)
            last_sender_ = tables_.sender_index(sender, line.number);
        return tables_.table_of(last_sender_, plan_index, plans_[plan_index]);
    }

    std::string describe(const SkipKind& skip) const {
        const bool is_value = skip.reason == Reason::not_a_number;
        return describe_skipped(skip.reason, plans_[is_value ? skip.detail / max_fields : skip.detail],
                                skip.detail % max_fields);
    }

    TelemetryLog& log_;
    std::string_view text_;
    MessageNameSet wanted_;
    std::vector<DecodePlan> plans_;
    SkipCounter skips_;
    LogTables tables_;
    std::size_t last_sender_ = std::numeric_limits<std::size_t>::max();
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

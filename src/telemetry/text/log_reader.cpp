#include "base/error.h"
#include "base/number.h"
#include "base/parallel.h"
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

void append_rows(MessageTable& table, const MessageTable& later) {
    table.time_s.insert(table.time_s.end(), later.time_s.begin(), later.time_s.end());
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        auto& values = table.columns[i].values;
        values.insert(values.end(), later.columns[i].values.begin(), later.columns[i].values.end());
    }
}

/// Reads the lines of one log into its tables: the only state of the hot loop.
class LogReader {
  public:
    /// To read `part` of `text`.
    LogReader(TelemetryLog& log, const std::vector<MessageRequest>& wanted, std::string_view text,
              std::string_view part)
        : log_(log), part_(part), skips_(text), tables_(log, wanted.size()) {
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

    /// Takes over what `later` has read of the part behind this one's, which begins behind `lines_before` lines. False
    /// where both chose another definition of a message: what `later` read is then not what this one would have.
    bool append(LogReader& later, std::size_t lines_before) {
        for (std::size_t i = 0; i < plans_.size(); ++i) {
            if (plans_[i].definition == nullptr) {
                plans_[i] = std::move(later.plans_[i]);
            } else if (const auto* other = later.plans_[i].definition) {
                if (other - later.plans_[i].candidates.data() != plans_[i].definition - plans_[i].candidates.data())
                    return false;
            }
        }
        for (const auto& sender : later.log_.senders) {
            const auto place = tables_.sender_index(sender.id, lines_before);
            for (const auto& table : sender.tables) {
                const auto plan = place_of(table.message);
                tables_.table_of(place, plan, plans_[plan]);
            }
        }
        append_tables(later.log_);
        skips_.append(later.skips_, lines_before);
        return true;
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

    /// The rows of `later`, for all of which there are tables.
    void append_tables(const TelemetryLog& later) {
        std::vector<std::pair<MessageTable*, const MessageTable*>> joined;
        for (const auto& sender : later.senders) {
            auto& tables = std::ranges::find(log_.senders, sender.id, &SenderLog::id)->tables;
            for (const auto& table : sender.tables)
                joined.emplace_back(&*std::ranges::find(tables, table.message, &MessageTable::message), &table);
        }
        for_each_in_parallel(joined.size(), [&](std::size_t i) { append_rows(*joined[i].first, *joined[i].second); });
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
        if (table.time_s.size() == table.time_s.capacity()) reserve_rows(table, bytes_read(line), part_.size());
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
        const bool in_place = line.begin >= part_.data() && line.begin < part_.data() + part_.size();
        return in_place ? static_cast<std::size_t>(line.end - part_.data()) : part_.size();
    }

    MessageTable& table_of(std::string_view sender, std::size_t plan_index, const ScannedLine& line) {
        // Neighbouring lines mostly come from the same sender.
        if (last_sender_ >= log_.senders.size() || log_.senders[last_sender_].id != sender)
            last_sender_ = tables_.sender_index(sender, line.number);
        return tables_.table_of(last_sender_, plan_index, plans_[plan_index]);
    }

    std::size_t place_of(const std::string& message) const {
        const auto is_its = [&](const DecodePlan& plan) { return plan.request.message == message; };
        return static_cast<std::size_t>(std::ranges::find_if(plans_, is_its) - plans_.begin());
    }

    std::string describe(const SkipKind& skip) const {
        const bool is_value = skip.reason == Reason::not_a_number;
        return describe_skipped(skip.reason, plans_[is_value ? skip.detail / max_fields : skip.detail],
                                skip.detail % max_fields);
    }

    TelemetryLog& log_;
    std::string_view part_;
    MessageNameSet wanted_;
    std::vector<DecodePlan> plans_;
    SkipCounter skips_;
    LogTables tables_;
    std::size_t last_sender_ = std::numeric_limits<std::size_t>::max();
};

/// Whole lines of `text`, cut in `count` parts of about one size, or in fewer where lines are long. Behind each but the
/// last, the text goes on for what the scanner reads ahead.
std::vector<std::string_view> parts_of(std::string_view text, std::size_t count) {
    std::vector<std::string_view> parts;
    std::size_t begin = 0;
    for (std::size_t k = 1; k < count; ++k) {
        const auto line_end = text.find('\n', std::max(begin, text.size() / count * k));
        if (line_end == std::string_view::npos || line_end + 1 + read_ahead > text.size()) break;
        parts.push_back(text.substr(begin, line_end + 1 - begin));
        begin = line_end + 1;
    }
    parts.push_back(text.substr(begin));
    return parts;
}

/// Reads a text in parts, on all cores, which gives what reading it as a whole does. std::nullopt where it cannot: the
/// parts take a message for different ones, or the text is refused.
std::optional<TelemetryLog> parse_in_parts(const TelemetryLog& empty, const std::vector<MessageRequest>& wanted,
                                           std::string_view text, const std::vector<std::string_view>& parts) {
    std::vector<TelemetryLog> logs(parts.size(), empty);
    std::vector<LogReader> readers;
    // The first one's columns have room for all.
    for (std::size_t k = 0; k < parts.size(); ++k)
        readers.emplace_back(logs[k], wanted, text, k == 0 ? text : parts[k]);
    std::vector<std::size_t> lines(parts.size());
    try {
        for_each_in_parallel(parts.size(), [&](std::size_t k) {
            const auto read = [&](const ScannedLine& line) { readers[k].read_line(line); };
            const auto* const begin = parts[k].data();
            lines[k] = k + 1 < parts.size() ? scan_padded_lines(begin, begin + parts[k].size(), 1, read) - 1
                                            : scan_lines(parts[k], read);
        });
        std::size_t lines_before = lines[0];
        for (std::size_t k = 1; k < parts.size(); lines_before += lines[k++]) {
            if (!readers[0].append(readers[k], lines_before)) return std::nullopt;
            logs[k] = {};
        }
        readers[0].finish(lines_before, text.ends_with('\n'));
    } catch (const InputError&) {
        return std::nullopt;  // its line counts from the part's beginning
    }
    return std::move(logs[0]);
}

}  // namespace

TelemetryLog parse_telemetry(std::string_view text, const std::filesystem::path& data_file,
                             std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted,
                             std::size_t parts) {
    constexpr std::size_t min_part_bytes = 4'000'000;  // reading less takes no longer than joining
    TelemetryLog log;
    log.data_file = data_file;
    log.flight = flight_name(data_file);
    log.configuration = std::move(configuration);
    if (parts == 0) parts = threads_for(text.size() / min_part_bytes);
    if (parts > 1) {
        if (auto joined = parse_in_parts(log, wanted, text, parts_of(text, parts))) return std::move(*joined);
    }
    LogReader reader(log, wanted, text, text);
    const auto lines = scan_lines(text, [&](const ScannedLine& line) { reader.read_line(line); });
    reader.finish(lines, text.ends_with('\n'));
    return log;
}

}  // namespace flightwatt::telemetry

#include "telemetry/log_reader.h"

#include "base/error.h"
#include "base/number.h"
#include "telemetry/columns/message_plan.h"
#include "telemetry/text/lines.h"
#include "telemetry/text/skip_counter.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

/// Reads the lines of one log into its tables.
class LogReader {
  public:
    LogReader(TelemetryLog& log, const std::vector<MessageRequest>& wanted) : log_(log) {
        for (const auto& request : wanted) {
            wanted_.emplace(request.message, plans_.size());
            plans_.push_back(make_decode_plan(request, log.configuration));
        }
    }

    void read_line(std::string_view line) {
        ++log_.lines;
        auto rest = line;
        const auto time = take_word(rest);
        const auto sender = take_word(rest);
        if (rest.empty()) {
            if (!line.empty()) skips_.add_without_time({SkipReason::not_a_message, 0}, log_.lines);
            return;
        }
        if (skips_.waits_for_time()) {
            if (const double time_s = number_or_nan(time); !std::isnan(time_s)) skips_.set_time(time_s);
        }
        if (const auto found = wanted_.find(take_word(rest)); found != wanted_.end())
            read_message(found->second, time, sender, rest);
    }

    /// Turns the counters into reasons for the user. `ends_with_break`: whether the last line is complete.
    void finish(bool ends_with_break) {
        for (auto& [kind, skipped] : skips_.take()) {
            const bool is_cut_off = !ends_with_break && skipped.count() == 1 && skipped.first_line() == log_.lines &&
                                    kind.reason != SkipReason::not_a_number;
            skipped.reason = is_cut_off ? "the last line is cut off" : describe(kind);
            log_.skipped.push_back(std::move(skipped));
        }
        note_assumptions(plans_, log_);
    }

  private:
    void read_message(std::size_t index, std::string_view time, std::string_view sender, std::string_view fields) {
        auto& plan = plans_[index];
        const double time_s = number_or_nan(time);
        if (std::isnan(time_s)) return skips_.add_without_time({SkipReason::no_time, index}, log_.lines);
        const auto count = split_fields(fields, words_);
        if (const auto reason = check_field_count(plan, count)) return skips_.add({*reason, index}, time_s, log_.lines);
        auto& table = find_or_add_table(log_, sender, plan, log_.lines);
        table.places.push_back(log_.lines);
        append_row(
            table, plan, time_s,
            [&](const DecodePlan::Target& target) { return field_value(target, words_[target.field]); },
            [&](std::size_t field) {
                skips_.add({SkipReason::not_a_number, index * max_fields + field}, time_s, log_.lines);
            });
    }

    std::string describe(const SkipKind& skip) const {
        const bool is_value = skip.reason == SkipReason::not_a_number;
        return describe_skipped(skip.reason, plans_[is_value ? skip.detail / max_fields : skip.detail],
                                skip.detail % max_fields);
    }

    TelemetryLog& log_;
    std::map<std::string, std::size_t, std::less<>> wanted_;  ///< index of each message's plan
    std::vector<DecodePlan> plans_;
    SkipCounter skips_;
    std::vector<std::string_view> words_;
};

}  // namespace

TelemetryLog read_telemetry(std::string_view text, const std::filesystem::path& data_file,
                            std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted) {
    auto log = parse_telemetry(text, data_file, std::move(configuration), wanted);
    if (log.senders.empty() && count_messages(text).empty()) {
        if (data_file.filename().string().find(".data") == std::string::npos)  // not called a log of Paparazzi
            throw InputError({data_file.string()}, "is no log that is known",
                             "expected a .bin or .log of ArduPilot, .ulg of PX4, .tlog of MAVLink, .data of Paparazzi, "
                             "or a table (CSV)");
        throw InputError({data_file.string(), 1}, fmt::format("has no telemetry in its {} lines", log.lines),
                         "expected lines such as '335.149 20 ENERGY 69 11.7 3.1 36.6 0.03 0.31'");
    }
    return log;
}

TelemetryLog parse_telemetry(std::string_view text, const std::filesystem::path& data_file,
                             std::optional<LogConfiguration> configuration, const std::vector<MessageRequest>& wanted) {
    TelemetryLog log;
    log.data_file = data_file;
    log.flight = flight_name(data_file);
    log.configuration = std::move(configuration);
    LogReader reader(log, wanted);
    for_each_line(text, [&](std::string_view line) { reader.read_line(line); });
    reader.finish(text.ends_with('\n'));
    return log;
}

std::vector<std::pair<std::string, std::size_t>> count_messages(std::string_view text) {
    const auto is_name = [](std::string_view word) {
        return !word.empty() && word.size() < 64 && std::isupper(static_cast<unsigned char>(word.front())) &&
               std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
    };
    constexpr std::size_t max_names = 1000;  // Paparazzi has some 300
    std::map<std::string, std::size_t, std::less<>> names;
    for_each_line(text, [&](std::string_view rest) {
        const auto time = take_word(rest);
        take_word(rest);
        const auto name = take_word(rest);
        if (!is_name(name) || !parse_number(time)) return;
        if (names.contains(name) || names.size() < max_names) ++names[std::string(name)];
    });
    std::vector<std::pair<std::string, std::size_t>> census(names.begin(), names.end());
    std::stable_sort(census.begin(), census.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    return census;
}

}  // namespace flightwatt::telemetry

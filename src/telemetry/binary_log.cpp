#include "telemetry/binary_log.h"

#include "base/error.h"
#include "base/number.h"
#include "telemetry/binary/frame.h"
#include "telemetry/binary/frame_clock.h"
#include "telemetry/binary/frame_scanner.h"
#include "telemetry/binary/wire_value.h"
#include "telemetry/columns/message_plan.h"
#include "telemetry/text/lines.h"
#include "telemetry/text/skip_counter.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

/// Whether the first line is one of a .data file: TIME SENDER NAME.
bool begins_with_telemetry(std::string_view bytes) {
    constexpr std::size_t max_beginning = 200;
    auto line = bytes.substr(0, std::min(max_beginning, bytes.find('\n')));
    std::array<std::string_view, 3> words;
    for (auto& word : words) word = take_word(line);
    return parse_number(words[0]) && !words[1].empty() && !words[2].empty() &&
           std::isupper(static_cast<unsigned char>(words[2].front())) != 0;
}

/// Class and id of a message in one number.
std::size_t number_of(std::uint8_t class_id, std::uint8_t id) { return class_id * std::size_t{256} + id; }

/// A field of a frame.
struct FieldBytes {
    WireType type;
    const char* first;
    std::size_t elements;
};

/// Reads the frames of one log into its tables.
class FrameReader {
  public:
    FrameReader(TelemetryLog& log, const BinaryLog& binary, const std::vector<MessageRequest>& wanted)
        : log_(log), binary_(binary), link_time_(*binary.messages) {
        plan_of_.fill(none);
        for (const auto& request : wanted) plans_.push_back(make_decode_plan(request, log.configuration));
        for (const auto& message : binary.messages->messages()) {
            const auto found = std::ranges::find(wanted, message.definition.name, &MessageRequest::message);
            if (found == wanted.end()) continue;
            plan_of_[number_of(message.class_id, message.id)] = static_cast<std::size_t>(found - wanted.begin());
        }
    }

    template <Framing framing>
    void read() {
        FrameScanner<framing> scanner(*binary_.messages, link_version(binary_));
        scanner.scan(
            binary_.bytes, InputContinuation::end,
            [&](const FoundFrame& found, const Frame& frame) {
                ++counts_.frames;
                counts_.messages += found.length_matches ? 1 : 0;
                counts_.length_mismatches += found.message != nullptr && !found.length_matches ? 1 : 0;
                const auto time_s = framing == Framing::card ? clock_.time_s(frame.time_100us) : link_time_s(found);
                if (std::isnan(time_s)) return;
                if (gap_.bytes > 0) note_gap(time_s);
                if (found.length_matches) {
                    const auto plan = plan_of_[number_of(found.class_id, found.id)];
                    if (plan != none) read_message(plan, found, time_s);
                } else if (found.carries_message) {
                    note_misfit(found, time_s);
                }
            },
            [&](const Gap& gap) {
                if (gap_.bytes > 0) note_gap(std::numeric_limits<double>::infinity());
                gap_ = gap;
            });
    }

    void finish() {
        if (gap_.bytes > 0) note_gap(std::numeric_limits<double>::infinity());
        log_.lines = counts_.frames;
        for (auto& [kind, skipped] : skips_.take()) {
            skipped.reason = describe(kind);
            skipped.unit = kind.reason == SkipReason::damage ? SkippedLines::Unit::byte : SkippedLines::Unit::frame;
            log_.skipped.push_back(std::move(skipped));
        }
        note_assumptions(plans_, log_);
    }

    const LinkCounts& counts() const { return counts_; }
    bool has_times() const { return has_times_; }

  private:
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    static constexpr std::size_t max_ids = 20;  ///< that are counted one by one

    /// NaN before the first TIMESTAMP; such frames are counted.
    double link_time_s(const FoundFrame& found) {
        const auto time_s = found.length_matches ? link_time_.time_s(found) : link_time_.last_s();
        if (time_s) {
            if (!has_times_ && untimed_ > 0) skips_.add({SkipReason::no_time, 0}, *time_s, 1, untimed_);
            has_times_ = true;
            return *time_s;
        }
        ++untimed_;
        return std::numeric_limits<double>::quiet_NaN();
    }

    void note_gap(double time_s) {
        const auto zeros = gap_.zeros >= min_padding_zeros ? gap_.zeros : 0;
        const bool is_cut_off = gap_.is_cut_off && std::isinf(time_s);
        if (gap_.bytes > zeros)
            skips_.add({SkipReason::damage, is_cut_off ? 1U : 0U}, time_s, gap_.offset + 1, gap_.bytes - zeros);
        gap_ = {};
    }

    void note_misfit(const FoundFrame& found, double time_s) {
        const auto reason =
            found.message == nullptr ? SkipReason::undefined_frame : SkipReason::frame_of_another_length;
        auto number = number_of(found.class_id, found.id);
        if (listed_.size() >= max_ids && !listed_.contains(number)) {
            number = none;
        } else {
            listed_.insert(number);
        }
        skips_.add({reason, number}, time_s, found.offset + 1);
    }

    void read_message(std::size_t index, const FoundFrame& found, double time_s) {
        auto& plan = plans_[index];
        if (const auto reason = check_field_count(plan, found.message->fields.size()))
            return skips_.add({*reason, index}, time_s, found.offset + 1);
        fields_.clear();
        for_each_field(*found.message, found.fields, [&](const WireField& field, const char* p, std::size_t elements) {
            fields_.push_back({field.type, p, elements});
        });
        auto& table = find_or_add_table(log_, std::to_string(found.sender), plan, found.offset);
        table.places.push_back(found.offset + 1);
        append_row(
            table, plan, time_s, [&](const DecodePlan::Target& target) { return value_of(target); },
            [&](std::size_t field) {
                skips_.add({SkipReason::not_a_number, index * max_fields + field}, time_s, found.offset + 1);
            });
    }

    /// NaN for a text, an array (unless its first element is wanted) and a value that is not finite.
    double value_of(const DecodePlan::Target& target) const {
        const auto& [type, first, elements] = fields_[target.field];
        const bool is_number = elements == 1 || (elements > 1 && target.is_first_element);
        if (!is_number || type == WireType::text) return std::numeric_limits<double>::quiet_NaN();
        const double value = wire_value(type, first);
        return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
    }

    std::string name_of(std::size_t number) const {
        if (number == none) return "further messages";
        const auto* const message =
            binary_.messages->find(static_cast<std::uint8_t>(number / 256), static_cast<std::uint8_t>(number % 256));
        if (message != nullptr) return message->definition.name;
        return fmt::format("message {} of class {}", number % 256, number / 256);
    }

    std::string describe(const SkipKind& skip) const {
        const auto definitions = binary_.definitions.filename().string();
        switch (skip.reason) {
            case SkipReason::undefined_frame:
                return fmt::format("{}: not defined in {}", name_of(skip.detail), definitions);
            case SkipReason::frame_of_another_length:
                return fmt::format("{}: another length than {} defines", name_of(skip.detail), definitions);
            case SkipReason::other_field_count:
            case SkipReason::unknown_message:
                return fmt::format("{}: another number of fields than its first definition has",
                                   plans_[skip.detail].request.message);
            case SkipReason::not_a_number:
                return fmt::format("{}.{}: not a finite number", plans_[skip.detail / max_fields].request.message,
                                   plans_[skip.detail / max_fields].definition->fields[skip.detail % max_fields].name);
            case SkipReason::no_time:
                return "before the first TIMESTAMP";
            default:
                return skip.detail == 1 ? "the last frame is cut off" : "damaged, no frame with a valid checksum";
        }
    }

    TelemetryLog& log_;
    const BinaryLog& binary_;
    std::vector<DecodePlan> plans_;
    std::array<std::size_t, std::size_t{16} * 256> plan_of_{};  ///< by class and id: index in plans_
    std::vector<FieldBytes> fields_;                            ///< of the last message
    SkipCounter skips_;
    FrameClock clock_;
    LinkTime link_time_;
    bool has_times_ = false;
    std::size_t untimed_ = 0;
    Gap gap_;
    std::set<std::size_t> listed_;  ///< messages that are counted by their ids
    LinkCounts counts_;
};

struct ParsedFrames {
    TelemetryLog log;
    LinkCounts counts;
    bool has_times = true;
};

ParsedFrames parse_frames(const BinaryLog& binary, LogConfiguration configuration,
                          const std::vector<MessageRequest>& wanted) {
    ParsedFrames parsed;
    parsed.log.data_file = binary.file;
    parsed.log.flight = flight_name(binary.file);
    parsed.log.configuration = std::move(configuration);
    FrameReader reader(parsed.log, binary, wanted);
    with_framing(binary.framing, [&]<Framing framing>() { reader.read<framing>(); });
    reader.finish();
    parsed.counts = reader.counts();
    parsed.has_times = binary.framing == Framing::card || reader.has_times();
    return parsed;
}

constexpr auto name_others = "name the messages.xml or .log of the aircraft and build that flew, with --messages FILE";

}  // namespace

std::optional<Framing> detect_binary_framing(std::string_view bytes) {
    return begins_with_telemetry(bytes) ? std::nullopt : detect_framing(bytes, true);
}

LinkVersion link_version(const BinaryLog& log) {
    const auto version = detect_version(log.bytes, log.framing, *log.messages);
    if (version) return *version;
    throw InputError({log.file.string()},
                     fmt::format("has {} frames, but no message with the length that {} defines",
                                 to_string(log.framing), log.definitions.string()),
                     name_others);
}

void require_matching_lengths(const LinkCounts& counts, const BinaryLog& log) {
    // Definitions of a similar build mismatch a ninth of a real log's frames, those of another decade 40 to 64 %.
    constexpr std::size_t of_which_one = 4;
    const auto defined = counts.messages + counts.length_mismatches;
    if (counts.length_mismatches * of_which_one < std::max<std::size_t>(1, defined)) return;
    throw InputError({log.file.string()},
                     fmt::format("{} of {} messages have other lengths than {} defines: it belongs to another build",
                                 counts.length_mismatches, defined, log.definitions.string()),
                     name_others);
}

TelemetryLog parse_binary_telemetry(const BinaryLog& log, LogConfiguration configuration,
                                    const std::vector<MessageRequest>& wanted) {
    return parse_frames(log, std::move(configuration), wanted).log;
}

TelemetryLog read_binary_telemetry(const BinaryLog& log, LogConfiguration configuration,
                                   const std::vector<MessageRequest>& wanted) {
    auto parsed = parse_frames(log, std::move(configuration), wanted);
    require_matching_lengths(parsed.counts, log);
    if (!parsed.has_times) {
        throw InputError({log.file.string()}, "is a capture of a link, whose messages have no times",
                         "flights need an SD card's log, or a capture with TIMESTAMP messages; flightwatt convert "
                         "writes the messages as text");
    }
    return std::move(parsed.log);
}

std::vector<std::pair<std::string, std::size_t>> count_binary_messages(const BinaryLog& log) {
    std::map<std::string, std::size_t, std::less<>> names;
    const auto version = link_version(log);
    with_framing(log.framing, [&]<Framing framing>() {
        FrameScanner<framing> scanner(*log.messages, version);
        scanner.scan(
            log.bytes, InputContinuation::end,
            [&](const FoundFrame& found, const Frame& /*frame*/) {
                if (found.length_matches) ++names[found.message->definition.name];
            },
            [](const Gap& /*gap*/) {});
    });
    std::vector<std::pair<std::string, std::size_t>> census(names.begin(), names.end());
    std::ranges::stable_sort(census, std::greater(), &std::pair<std::string, std::size_t>::second);
    return census;
}

}  // namespace flightwatt::telemetry

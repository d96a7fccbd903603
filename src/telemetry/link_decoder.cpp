#include "telemetry/link_decoder.h"

#include "telemetry/binary/frame.h"
#include "telemetry/binary/frame_clock.h"
#include "telemetry/binary/frame_scanner.h"
#include "telemetry/binary/wire_value.h"
#include "telemetry/columns/message_plan.h"

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace flightwatt::telemetry {
namespace {

template <typename Number>
void append_number(Number number, std::string& text) {
    if constexpr (std::floating_point<Number>) {
        if (std::isnan(number)) {
            text += "nan";
            return;
        }
    }
    std::array<char, 32> digits{};
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), number);
    const std::string_view shown(digits.data(), static_cast<std::size_t>(written.ptr - digits.data()));
    text += shown;
    if constexpr (std::floating_point<Number>) {
        if (shown.find_first_of(".en") == std::string_view::npos) text += '.';  // "235.", as OCaml writes it
    }
}

/// Replaces characters that would end a line or a quoted field.
char shown_character(char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < ' ' || code == 0x7F || c == '"' ? '?' : c;
}

void append_element(WireType type, const char* p, std::string& text) {
    with_wire_type(type, [&]<typename T>() {
        if constexpr (std::is_same_v<T, char>)
            text += *p == ' ' ? '?' : shown_character(*p);
        else if constexpr (std::is_same_v<T, float>)
            append_number(shortest_decimal(wire_number<float>(p)), text);
        else
            append_number(wire_number<T>(p), text);
    });
}

/// Appends text in quotes, without the zeros that fill a char[n].
void append_quoted(std::string_view characters, std::string& text) {
    while (!characters.empty() && characters.back() == '\0') characters.remove_suffix(1);
    text += '"';
    for (const char c : characters) text += shown_character(c);
    text += '"';
}

/// Appends a message as a line of a .data file without time and break: sender, name, fields. Arrays are joined by
/// commas, char[] are in quotes (a quote or control character becomes '?'), floats have the fewest digits that read
/// back, with a point or an exponent.
void append_message_text(const FoundFrame& found, std::string& text) {
    append_number(unsigned{found.sender}, text);
    text += ' ';
    text += found.message->definition.name;
    for_each_field(*found.message, found.fields, [&](const WireField& field, const char* p, std::size_t elements) {
        text += ' ';
        if (field.type == WireType::text && field.count != WireCount::one) return append_quoted({p, elements}, text);
        for (std::size_t i = 0; i < elements; ++i) {
            if (i > 0) text += ',';
            append_element(field.type, p + i * size_of(field.type), text);
        }
    });
}

/// The values of the fields; NaN for an array, a text and a value that is not finite.
void read_message_values(const FoundFrame& found, std::vector<double>& values) {
    values.clear();
    for_each_field(*found.message, found.fields, [&](const WireField& field, const char* p, std::size_t elements) {
        const bool is_number = elements == 1 && field.type != WireType::text;
        const double value = is_number ? wire_value(field.type, p) : std::nan("");
        values.push_back(std::isfinite(value) ? value : std::nan(""));
    });
}

constexpr std::size_t step_bytes = 4096;  // scanned at a time
/// After this many bytes without a recognised framing, the first half is discarded.
constexpr std::size_t max_undecided_bytes = 8192;

std::uint16_t number_of(const FoundFrame& found) { return static_cast<std::uint16_t>(found.class_id * 256 + found.id); }

}  // namespace

double shortest_decimal(float value) {
    if (!std::isfinite(value)) return double{value};
    std::array<char, 32> digits{};
    const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    double number = 0.0;
    std::from_chars(digits.data(), written.ptr, number);
    return number;
}

struct LinkDecoder::State {
    State(MessageDictionary messages, std::optional<LinkVersion> link_version)
        : dictionary(std::move(messages)), version(link_version), time(dictionary) {}

    void use_framing(Framing framing) {
        counts.framing = framing;
        with_framing(framing, [&]<Framing of>() { scanner.emplace<FrameScanner<of>>(dictionary, version); });
    }

    /// Decides the framing from the bytes so far; true once it is decided.
    bool find_framing(InputContinuation behind) {
        if (counts.framing) return true;
        if (const auto found = detect_framing(buffer, behind == InputContinuation::end)) {
            use_framing(*found);
            return true;
        }
        if (buffer.size() > max_undecided_bytes || behind == InputContinuation::end) {
            const auto discarded = behind == InputContinuation::end ? buffer.size() : buffer.size() / 2;
            buffer.erase(0, discarded);
            counts.skipped_bytes += discarded;
            counts.skipped_runs += discarded > 0 ? 1 : 0;
        }
        return false;
    }

    void take(const FoundFrame& found, const Frame& frame, const Sink& sink) {
        ++counts.frames;
        if (!found.carries_message) {
            ++counts.non_message_frames;
        } else if (found.message == nullptr) {
            ++counts.unknown;
            ++counts.unknown_ids[number_of(found)];
        } else if (!found.length_matches) {
            ++counts.length_mismatches;
            ++counts.other_length_ids[number_of(found)];
        } else {
            ++counts.messages;
            text.clear();
            append_message_text(found, text);
            read_message_values(found, values);
            LinkMessage message{found.sender, found.class_id, found.message->definition.name,
                                std::nullopt, text,           values};
            message.time_s = counts.framing == Framing::card ? clock.time_s(frame.time_100us) : time.time_s(found);
            sink(message);
        }
    }

    void leave(const Gap& gap) {
        const auto zeros = gap.zeros >= min_padding_zeros ? gap.zeros : 0;
        counts.padding_bytes += zeros;
        counts.skipped_bytes += gap.bytes - zeros;
        counts.skipped_runs += gap.bytes > zeros ? 1 : 0;
    }

    void scan(InputContinuation behind, const Sink& sink) {
        if (!find_framing(behind)) return;
        std::visit(
            [&](auto& chosen) {
                if constexpr (!std::is_same_v<std::decay_t<decltype(chosen)>, std::monostate>) {
                    const auto done = chosen.scan(
                        buffer, behind, [&](const FoundFrame& found, const Frame& frame) { take(found, frame, sink); },
                        [&](const Gap& gap) { leave(gap); });
                    buffer.erase(0, done);
                    counts.version = chosen.version();
                }
            },
            scanner);
    }

    MessageDictionary dictionary;
    std::optional<LinkVersion> version;
    std::variant<std::monostate, FrameScanner<Framing::card>, FrameScanner<Framing::link>, FrameScanner<Framing::xbee>>
        scanner;
    FrameClock clock;
    LinkTime time;
    std::string buffer;
    std::string text;
    std::vector<double> values;
    LinkCounts counts;
};

LinkDecoder::LinkDecoder(MessageDictionary dictionary, std::optional<Framing> framing,
                         std::optional<LinkVersion> version)
    : state_(std::make_unique<State>(std::move(dictionary), version)) {
    constexpr std::size_t max_text = 4096;
    state_->buffer.reserve(step_bytes + max_undecided_bytes);
    state_->text.reserve(max_text);
    state_->values.reserve(max_fields);
    state_->counts.version = version;
    if (framing) state_->use_framing(*framing);
}

LinkDecoder::~LinkDecoder() = default;
LinkDecoder::LinkDecoder(LinkDecoder&&) noexcept = default;
LinkDecoder& LinkDecoder::operator=(LinkDecoder&&) noexcept = default;

void LinkDecoder::push(std::string_view bytes, const Sink& sink) {
    state_->counts.bytes += bytes.size();
    while (!bytes.empty()) {
        const auto part = bytes.substr(0, step_bytes);
        state_->buffer.append(part);
        bytes.remove_prefix(part.size());
        state_->scan(bytes.empty() ? InputContinuation::pause : InputContinuation::more, sink);
    }
}

void LinkDecoder::flush(const Sink& sink) { state_->scan(InputContinuation::end, sink); }

const LinkCounts& LinkDecoder::counts() const { return state_->counts; }

}  // namespace flightwatt::telemetry

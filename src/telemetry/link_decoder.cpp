#include "telemetry/link_decoder.h"

#include "telemetry/binary/frame_clock.h"
#include "telemetry/binary/frame_scanner.h"
#include "telemetry/binary/framing.h"
#include "telemetry/binary/link_time.h"
#include "telemetry/binary/message_text.h"
#include "telemetry/columns/message_plan.h"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace flightwatt::telemetry {
namespace {

/// So many bytes are looked at in one go.
constexpr std::size_t step_bytes = 4096;
/// So many may tell no framing before the first half of them is given up.
constexpr std::size_t max_undecided_bytes = 8192;

std::uint16_t number_of(const FoundFrame& found) { return static_cast<std::uint16_t>(found.class_id * 256 + found.id); }

}  // namespace

std::string_view to_string(Framing framing) {
    switch (framing) {
        case Framing::card:
            return "SD card";
        case Framing::link:
            return "link";
        case Framing::xbee:
            break;
    }
    return "XBee";
}

std::string_view to_string(LinkVersion version) { return version == LinkVersion::v1 ? "pprzlink v1" : "pprzlink v2"; }

struct LinkDecoder::State {
    State(MessageDictionary messages, std::optional<LinkVersion> link_version)
        : dictionary(std::move(messages)), version(link_version), time(dictionary) {}

    void use_framing(Framing framing) {
        counts.framing = framing;
        switch (framing) {
            case Framing::card:
                scanner.emplace<FrameScanner<Framing::card>>(dictionary, version);
                break;
            case Framing::link:
                scanner.emplace<FrameScanner<Framing::link>>(dictionary, version);
                break;
            case Framing::xbee:
                scanner.emplace<FrameScanner<Framing::xbee>>(dictionary, version);
                break;
        }
    }

    /// Decides the framing by what has come; true once it is.
    bool find_framing(InputContinuation behind) {
        if (counts.framing) return true;
        if (const auto found = detect_framing(buffer, behind == InputContinuation::end)) {
            use_framing(*found);
            return true;
        }
        if (buffer.size() > max_undecided_bytes || behind == InputContinuation::end) {
            const auto given_up = behind == InputContinuation::end ? buffer.size() : buffer.size() / 2;
            buffer.erase(0, given_up);
            counts.skipped_bytes += given_up;
            counts.skipped_runs += given_up > 0 ? 1 : 0;
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

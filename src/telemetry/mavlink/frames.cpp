#include "telemetry/mavlink/frames.h"

#include "telemetry/binary/wire_value.h"

#include <algorithm>

namespace flightwatt::telemetry {
namespace {

constexpr char magic_v1 = '\xFE';
constexpr char magic_v2 = '\xFD';
constexpr std::size_t header_v1 = 6;
constexpr std::size_t header_v2 = 10;
constexpr std::size_t checksum_bytes = 2;
constexpr std::size_t signature_bytes = 13;
constexpr unsigned signed_flag = 1;

unsigned byte_of(std::string_view bytes, std::size_t at) { return static_cast<unsigned char>(bytes[at]); }

}  // namespace

double MavlinkFrame::number(std::string_view field) const {
    return message->layout.fields[message->layout.index_of(field).value()].number(payload);
}

std::string MavlinkFrame::text(std::string_view field) const {
    const auto index = message->layout.index_of(field).value();
    const auto& fields = message->layout.fields;
    const auto begin = fields[index].offset;
    const auto end = index + 1 < fields.size() ? fields[index + 1].offset : message->layout.bytes;
    const auto text = std::string_view(payload).substr(std::min(begin, payload.size()), end - begin);
    return std::string(text.substr(0, text.find('\0')));
}

std::optional<std::size_t> mavlink_frame_bytes(std::string_view bytes) {
    if (bytes.empty()) return std::nullopt;
    const bool is_v2 = bytes.front() == magic_v2;
    if (!is_v2 && bytes.front() != magic_v1) return 0;
    if (bytes.size() < (is_v2 ? header_v2 : header_v1)) return std::nullopt;
    const auto payload = byte_of(bytes, 1);
    if (!is_v2) return header_v1 + payload + checksum_bytes;
    const auto flags = byte_of(bytes, 2);
    if ((flags & ~signed_flag) != 0) return 0;
    return header_v2 + payload + checksum_bytes + ((flags & signed_flag) != 0 ? signature_bytes : 0);
}

std::optional<MavlinkFrame> read_mavlink_frame(std::string_view bytes) {
    const auto size = mavlink_frame_bytes(bytes).value_or(0);
    if (size == 0 || size > bytes.size()) return std::nullopt;
    const bool is_v2 = bytes.front() == magic_v2;
    const auto header = is_v2 ? header_v2 : header_v1;
    const std::size_t from = is_v2 ? 4 : 2;  // of sequence, system, component, id
    MavlinkFrame frame;
    frame.sequence = static_cast<std::uint8_t>(byte_of(bytes, from));
    frame.system = static_cast<std::uint8_t>(byte_of(bytes, from + 1));
    frame.component = static_cast<std::uint8_t>(byte_of(bytes, from + 2));
    for (std::size_t at = header; at-- > from + 3;) frame.id = frame.id << 8U | byte_of(bytes, at);
    frame.message = find_mavlink_message(frame.id);
    frame.bytes = size;
    const auto payload = bytes.substr(header, byte_of(bytes, 1));
    frame.checksum = wire_number<std::uint16_t>(payload.data() + payload.size());
    frame.payload = payload;
    if (frame.message == nullptr) return frame;
    const auto checked = bytes.substr(1, header - 1 + payload.size());
    if (mavlink_checksum(checked, frame.message->crc_extra) != frame.checksum) return std::nullopt;
    const auto whole = is_v2 ? frame.message->layout.bytes : frame.message->base_bytes;
    frame.payload.resize(std::max(whole, payload.size()), '\0');
    return frame;
}

bool MavlinkSequence::add(const MavlinkFrame& frame) {
    constexpr std::size_t remembered = 96;  // of 256: a second radio may be seconds later
    constexpr std::size_t late = 32;        // more would hide two senders with one id
    const auto key = static_cast<std::uint16_t>(frame.system << 8U | frame.component);
    const auto [found, is_first] = components_.try_emplace(key);
    auto& last = found->second;
    const std::pair seen{frame.sequence, frame.checksum};
    if (std::ranges::find(last.recent, seen) != last.recent.end()) return false;
    if (last.recent.size() < remembered)
        last.recent.push_back(seen);
    else
        last.recent[last.next++ % remembered] = seen;
    ++received_;
    const auto ahead = static_cast<std::uint8_t>(frame.sequence - last.sequence - 1);
    if (!is_first && ahead >= 256 - late) {  // it is late
        if (lost_ > 0) --lost_;
        return true;
    }
    if (!is_first) lost_ += ahead;
    last.sequence = frame.sequence;
    return true;
}

}  // namespace flightwatt::telemetry

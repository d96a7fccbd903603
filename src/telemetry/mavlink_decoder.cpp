#include "telemetry/mavlink_decoder.h"

#include "telemetry/binary/wire_value.h"
#include "telemetry/mavlink/entries.h"
#include "telemetry/mavlink/vehicles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/endian/conversion.hpp>
#include <fmt/format.h>

namespace flightwatt::telemetry {

struct MavlinkVehicles::State {
    std::map<std::string, std::vector<std::size_t>, std::less<>> wanted;  ///< indices of the fields, by message
    std::map<int, Autopilot> autopilots;                                  ///< by system
    MavlinkSequence sequence;
    std::size_t taken_lost = 0;
    std::vector<double> values;  ///< of the last message; a member to reuse its memory
};

MavlinkVehicles::MavlinkVehicles(const std::vector<MessageRequest>& wanted) : state_(std::make_unique<State>()) {
    for (const auto& [message, fields] : wanted)
        for (const auto& field : fields)
            state_->wanted[message].push_back(mavlink_message(message).layout.index_of(field).value());
}

MavlinkVehicles::~MavlinkVehicles() = default;

std::size_t MavlinkVehicles::take_lost() {
    const auto lost = std::max(state_->sequence.lost(), state_->taken_lost);  // one that comes late was counted
    return lost - std::exchange(state_->taken_lost, lost);
}

bool MavlinkVehicles::alternates() const { return state_->sequence.alternates(); }

MavlinkDecoder::MavlinkDecoder(std::shared_ptr<MavlinkVehicles> vehicles, bool is_tlog)
    : vehicles_(std::move(vehicles)), is_tlog_(is_tlog) {}

void MavlinkDecoder::restart() {
    skipped_bytes_ += waiting_.size();
    waiting_.clear();
}

void MavlinkDecoder::push(std::string_view bytes, const OnMessage& on_message) {
    const std::size_t before = is_tlog_ ? tlog_time_bytes : 0;
    waiting_ += bytes;
    std::size_t at = 0;
    while (at + before < waiting_.size()) {
        const auto rest = std::string_view(waiting_).substr(at);
        const auto size = mavlink_frame_bytes(rest.substr(before));
        const bool may_be = size != 0 && (!is_tlog_ || may_be_tlog_entry(rest));
        if (may_be && (!size || before + *size > rest.size())) break;  // its end is to come
        const auto frame = may_be ? read_mavlink_frame(rest.substr(before)) : std::nullopt;
        if (frame && (frame->message != nullptr || may_follow(rest.substr(before + frame->bytes)))) {
            forward(*frame, rest, on_message);
            at += before + frame->bytes;
        } else {
            ++skipped_bytes_;
            ++at;
        }
    }
    waiting_.erase(0, at);
}

/// Whether bytes may be what follows a packet, to confirm one of an unknown message, which has no checksum.
bool MavlinkDecoder::may_follow(std::string_view bytes) const {
    return is_tlog_ ? may_be_tlog_entry(bytes) : mavlink_frame_bytes(bytes) != 0;
}

void MavlinkDecoder::forward(const MavlinkFrame& frame, std::string_view entry, const OnMessage& on_message) {
    constexpr double us_per_s = 1e6;
    auto& state = *vehicles_->state_;
    const bool is_known = frame.message != nullptr;
    if (is_known && frame.message->layout.name == "HEARTBEAT" && is_autopilot(frame))
        add_autopilot(frame, state.autopilots);
    const auto autopilot = state.autopilots.find(frame.system);
    if (autopilot == state.autopilots.end() || !is_of_vehicle(frame, autopilot->second.component)) return;
    if (!state.sequence.add(frame)) return;
    const auto name = is_known ? frame.message->layout.name : fmt::format("MESSAGE_{}", frame.id);
    const auto sender = fmt::format("{}", frame.system);
    state.values.clear();
    if (const auto wanted = state.wanted.find(name); wanted != state.wanted.end())
        for (const auto field : wanted->second) state.values.push_back(value_of(frame, field));
    std::optional<double> unix_s;
    if (is_tlog_) unix_s = static_cast<double>(tlog_time_us(entry)) / us_per_s;
    on_message({sender, name, state.values, entry.substr(is_tlog_ ? tlog_time_bytes : 0, frame.bytes), unix_s});
}

std::optional<MavlinkPacket> read_mavlink_packet(std::string_view bytes) {
    const auto frame = read_mavlink_frame(bytes);
    if (!frame || frame->message == nullptr) return std::nullopt;
    MavlinkPacket packet{frame->message->layout.name, frame->system, frame->component, {}, {}};
    for (const auto& field : frame->message->layout.fields) {
        packet.of[field.name] = field.number(frame->payload);
        if (field.type == WireType::text) packet.text = frame->text(field.name);
    }
    return packet;
}

std::string tlog_entry(double unix_s, std::string_view packet) {
    const auto time_us = static_cast<std::uint64_t>(std::llround(unix_s * 1e6));
    return wire_bytes(boost::endian::endian_reverse(time_us)).append(packet);
}

}  // namespace flightwatt::telemetry

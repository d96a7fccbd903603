#include "telemetry/mavlink_sender.h"

#include "telemetry/binary/wire_value.h"
#include "telemetry/mavlink/messages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace flightwatt::telemetry {
namespace {

std::string field_bytes(WireType type, double value) {
    return with_wire_type(type, [&]<typename T>() {
        if constexpr (std::is_floating_point_v<T>) return wire_bytes(static_cast<T>(value));
        if (std::isnan(value)) return wire_bytes(T{0});
        constexpr auto low = static_cast<double>(std::numeric_limits<T>::lowest());
        constexpr auto high = static_cast<double>(std::numeric_limits<T>::max());
        const double rounded = std::round(value);
        if (rounded >= high) return wire_bytes(std::numeric_limits<T>::max());
        return wire_bytes(static_cast<T>(std::max(rounded, low)));
    });
}

}  // namespace

std::string MavlinkSender::packet(std::string_view message, const Values& values, std::string_view text) {
    const auto& definition = mavlink_message(message);
    std::string payload(definition.base_bytes, '\0');
    const auto put = [&](std::size_t at, std::string_view bytes) {
        for (std::size_t i = 0; i < bytes.size() && at + i < payload.size(); ++i) payload[at + i] = bytes[i];
    };
    const auto& fields = definition.layout.fields;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const auto end = i + 1 < fields.size() ? fields[i + 1].offset : payload.size();
        if (fields[i].type == WireType::text) put(fields[i].offset, text.substr(0, end - fields[i].offset));
        const auto value = values.find(fields[i].name);
        if (value != values.end()) put(fields[i].offset, field_bytes(fields[i].type, value->second));
    }
    while (payload.size() > 1 && payload.back() == '\0') payload.pop_back();
    std::string head{
        static_cast<char>(payload.size()), '\0', '\0', static_cast<char>(sequence_++), static_cast<char>(system_),
        static_cast<char>(component_)};
    head += wire_bytes(definition.id).substr(0, 3);
    return "\xFD" + head + payload + wire_bytes(mavlink_checksum(head + payload, definition.crc_extra));
}

std::string MavlinkSender::heartbeat() {
    constexpr double onboard_computer = 18.0;
    constexpr double no_autopilot = 8.0;
    constexpr double active = 4.0;
    constexpr double version = 3.0;
    return packet("HEARTBEAT", {{"type", onboard_computer},
                                {"autopilot", no_autopilot},
                                {"system_status", active},
                                {"mavlink_version", version}});
}

}  // namespace flightwatt::telemetry

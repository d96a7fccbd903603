#include "telemetry/mavlink/messages.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <string>

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <boost/crc.hpp>
#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

/// A definition: the fields in their order on the wire (by falling size of the type), as in C. Those behind "+" are
/// extensions, which version 1 does not send.
struct Definition {
    std::uint32_t id;
    const char* name;
    const char* fields;
};

constexpr std::array definitions{
    Definition{0, "HEARTBEAT",
               "uint32_t custom_mode; uint8_t type, autopilot, base_mode, system_status, mavlink_version"},
    Definition{1, "SYS_STATUS",
               "uint32_t onboard_control_sensors_present, onboard_control_sensors_enabled,"
               " onboard_control_sensors_health; uint16_t load, voltage_battery; int16_t current_battery;"
               " uint16_t drop_rate_comm, errors_comm, errors_count1, errors_count2, errors_count3, errors_count4;"
               " int8_t battery_remaining; + uint32_t onboard_control_sensors_present_extended,"
               " onboard_control_sensors_enabled_extended, onboard_control_sensors_health_extended"},
    Definition{2, "SYSTEM_TIME", "uint64_t time_unix_usec; uint32_t time_boot_ms"},
    Definition{22, "PARAM_VALUE",
               "float param_value; uint16_t param_count, param_index; char[16] param_id; uint8_t param_type"},
    Definition{24, "GPS_RAW_INT",
               "uint64_t time_usec; int32_t lat, lon, alt; uint16_t eph, epv, vel, cog;"
               " uint8_t fix_type, satellites_visible; + int32_t alt_ellipsoid; uint32_t h_acc, v_acc, vel_acc,"
               " hdg_acc; uint16_t yaw"},
    Definition{30, "ATTITUDE", "uint32_t time_boot_ms; float roll, pitch, yaw, rollspeed, pitchspeed, yawspeed"},
    Definition{33, "GLOBAL_POSITION_INT",
               "uint32_t time_boot_ms; int32_t lat, lon, alt, relative_alt; int16_t vx, vy, vz; uint16_t hdg"},
    Definition{39, "MISSION_ITEM",
               "float param1, param2, param3, param4, x, y, z; uint16_t seq, command; uint8_t target_system,"
               " target_component, frame, current, autocontinue; + uint8_t mission_type"},
    Definition{42, "MISSION_CURRENT",
               "uint16_t seq; + uint16_t total; uint8_t mission_state, mission_mode; uint32_t mission_id, fence_id,"
               " rally_points_id"},
    Definition{43, "MISSION_REQUEST_LIST", "uint8_t target_system, target_component; + uint8_t mission_type"},
    Definition{44, "MISSION_COUNT",
               "uint16_t count; uint8_t target_system, target_component; + uint8_t mission_type; uint32_t opaque_id"},
    Definition{47, "MISSION_ACK",
               "uint8_t target_system, target_component, type; + uint8_t mission_type; uint32_t opaque_id"},
    Definition{51, "MISSION_REQUEST_INT",
               "uint16_t seq; uint8_t target_system, target_component; + uint8_t mission_type"},
    Definition{73, "MISSION_ITEM_INT",
               "float param1, param2, param3, param4; int32_t x, y; float z; uint16_t seq, command;"
               " uint8_t target_system, target_component, frame, current, autocontinue; + uint8_t mission_type"},
    Definition{74, "VFR_HUD", "float airspeed, groundspeed, alt, climb; int16_t heading; uint16_t throttle"},
    Definition{147, "BATTERY_STATUS",
               "int32_t current_consumed, energy_consumed; int16_t temperature; uint16_t[10] voltages;"
               " int16_t current_battery; uint8_t id, battery_function, type; int8_t battery_remaining;"
               " + int32_t time_remaining; uint8_t charge_state; uint16_t[4] voltages_ext; uint8_t mode;"
               " uint32_t fault_bitmask"},
    Definition{148, "AUTOPILOT_VERSION",
               "uint64_t capabilities, uid; uint32_t flight_sw_version, middleware_sw_version, os_sw_version,"
               " board_version; uint16_t vendor_id, product_id; uint8_t[8] flight_custom_version,"
               " middleware_custom_version, os_custom_version; + uint8_t[18] uid2"},
    Definition{164, "SIMSTATE", "float roll, pitch, yaw, xacc, yacc, zacc, xgyro, ygyro, zgyro; int32_t lat, lng"},
    Definition{168, "WIND", "float direction, speed, speed_z"},
    Definition{181, "BATTERY2", "uint16_t voltage; int16_t current_battery"},
    Definition{230, "ESTIMATOR_STATUS",
               "uint64_t time_usec; float vel_ratio, pos_horiz_ratio, pos_vert_ratio, mag_ratio, hagl_ratio,"
               " tas_ratio, pos_horiz_accuracy, pos_vert_accuracy; uint16_t flags"},
    Definition{231, "WIND_COV",
               "uint64_t time_usec; float wind_x, wind_y, wind_z, var_horiz, var_vert, wind_alt, horiz_accuracy,"
               " vert_accuracy"},
    Definition{242, "HOME_POSITION",
               "int32_t latitude, longitude, altitude; float x, y, z; float[4] q; float approach_x, approach_y,"
               " approach_z; + uint64_t time_usec"},
    Definition{245, "EXTENDED_SYS_STATE", "uint8_t vtol_state, landed_state"},
    Definition{251, "NAMED_VALUE_FLOAT", "uint32_t time_boot_ms; float value; char[10] name"},
    Definition{253, "STATUSTEXT", "uint8_t severity; char[50] text; + uint16_t id; uint8_t chunk_seq"},
    Definition{291, "ESC_STATUS", "uint64_t time_usec; int32_t[4] rpm; float[4] voltage, current; uint8_t index"},
};

std::vector<std::string> parts_of(const std::string& text, const char* separators) {
    std::vector<std::string> parts;
    boost::split(parts, text, boost::is_any_of(separators));
    for (auto& part : parts) boost::trim(part);
    return parts;
}

/// Adds a field, or the elements of an array of `elements` (0: none). A text is one field of its first byte.
void add_field(MavlinkMessage& message, const std::string& name, WireType type, std::size_t elements) {
    auto& layout = message.layout;
    const auto end = layout.bytes + std::max<std::size_t>(elements, 1) * size_of(type);
    const bool is_array = elements > 0 && type != WireType::text;
    if (!is_array) layout.fields.push_back({name, layout.bytes, type});
    for (std::size_t i = 0; is_array && i < elements; ++i)
        layout.fields.push_back({fmt::format("{}[{}]", name, i), layout.bytes + i * size_of(type), type});
    layout.bytes = end;
}

MavlinkMessage message_of(const Definition& definition) {
    MavlinkMessage message{definition.id, {.name = definition.name}};
    auto described = message.layout.name + " ";
    bool is_extension = false;
    for (auto group : parts_of(definition.fields, ";")) {
        if (group.starts_with('+')) {
            is_extension = true;
            group = boost::trim_copy(group.substr(1));
            message.base_bytes = message.layout.bytes;
        }
        const auto space = group.find(' ');
        const auto bracket = group.substr(0, space).find('[');
        const auto type = group.substr(0, std::min(bracket, space));
        std::size_t elements = 0;
        if (bracket != std::string::npos) std::from_chars(&group[bracket + 1], &group[space], elements);
        const auto wire = wire_type_of(type).value();
        for (const auto& name : parts_of(group.substr(space), ",")) {
            add_field(message, name, wire, elements);
            if (is_extension) continue;
            described += fmt::format("{} {} ", type, name);
            if (elements > 0) described += static_cast<char>(elements);
        }
    }
    if (!is_extension) message.base_bytes = message.layout.bytes;
    const auto crc = mavlink_checksum(described, std::nullopt);
    message.crc_extra = static_cast<std::uint8_t>((crc & 0xFF) ^ (crc >> 8));
    return message;
}

}  // namespace

std::uint16_t mavlink_checksum(std::string_view bytes, std::optional<std::uint8_t> crc_extra) {
    boost::crc_optimal<16, 0x1021, 0xFFFF, 0, true, true> crc;
    crc.process_bytes(bytes.data(), bytes.size());
    if (crc_extra) crc.process_byte(*crc_extra);
    return crc.checksum();
}

const std::vector<MavlinkMessage>& mavlink_messages() {
    static const auto messages = [] {
        std::vector<MavlinkMessage> all;
        std::ranges::transform(definitions, std::back_inserter(all), message_of);
        return all;
    }();
    return messages;
}

const MavlinkMessage* find_mavlink_message(std::uint32_t id) {
    const auto& all = mavlink_messages();
    const auto found = std::ranges::lower_bound(all, id, {}, &MavlinkMessage::id);
    return found != all.end() && found->id == id ? &*found : nullptr;
}

const MavlinkMessage& mavlink_message(std::string_view name) {
    return *std::ranges::find_if(mavlink_messages(), [&](const auto& of) { return of.layout.name == name; });
}

}  // namespace flightwatt::telemetry

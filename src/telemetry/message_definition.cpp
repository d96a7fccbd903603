#include "telemetry/message_definition.h"

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>

#include <boost/algorithm/string/case_conv.hpp>
#include <fmt/format.h>
#include <pugixml.hpp>

namespace flightwatt::telemetry {
namespace {

MessageDefinition read_message(const pugi::xml_node& node) {
    MessageDefinition message{xml_attribute(node, "name"), {}, ".log"};
    for (const auto& field : node.children("field")) {
        message.fields.push_back({xml_attribute(field, "name"), xml_attribute(field, "type"),
                                  xml_attribute(field, "unit"), xml_attribute(field, "alt_unit"),
                                  parse_number(xml_attribute(field, "alt_unit_coef"))});
    }
    return message;
}

/// A built-in layout: its fields with their units, "name:unit" or "name".
struct BuiltinLayout {
    const char* message;
    const char* origin;
    std::string_view fields;
};

// Real logs and Paparazzi's own definition of the 4-field ENERGY have the integer energy [mAh] before the power.
// 0.00390625 m is 2^-8 m.
constexpr BuiltinLayout builtin_layouts[] = {
    {"ENERGY", "2009 (4 fields)", "bat:V amp:A energy:mAh power:W"},
    {"ENERGY", "2018 (6 fields)", "throttle:% voltage:V current:A power:W charge:Ah energy:Wh"},
    {"ENERGY", "2023 (7 fields)", "throttle:% voltage:V current:A power:W avg_power:W charge:Ah energy:Wh"},
    {"BAT", "2005 (7 fields)",
     "throttle:pprz voltage:1e-1V flight_time:s kill_auto_throttle block_time:s stage_time:s energy:mAh"},
    {"BAT", "2010 (8 fields)",
     "throttle:pprz voltage:1e-1V amps:A flight_time:s kill_auto_throttle block_time:s stage_time:s energy:mAh"},
    {"ESC", "2016 (7 fields)", "amps:A bat_volts:V power:W rpm motor_volts:V energy:Wh motor_id"},
    {"ESC", "10 fields",
     "amps:A bat_volts:V power:W rpm motor_volts:V energy:Wh temperature temperature_dev node_id motor_id"},
    {"POWER_DEVICE", "2024 (4 fields)", "node_id circuit current:A voltage:V"},
    {"COMMANDS", "1 field", "values"},
    {"ESTIMATOR", "2 fields", "z:m z_dot:m/s"},
    {"GPS", "before 2011 (10 fields)",
     "mode utm_east:cm utm_north:cm course:decideg alt:cm speed:cm/s climb:cm/s itow:ms utm_zone gps_nb_err"},
    {"GPS", "since 2011 (11 fields)",
     "mode utm_east:cm utm_north:cm course:decideg alt:mm speed:cm/s climb:cm/s week itow:ms utm_zone gps_nb_err"},
    {"GPS_INT", "16 fields",
     "ecef_x:cm ecef_y:cm ecef_z:cm lat:1e7deg lon:1e7deg alt:mm hmsl:mm ecef_xd:cm/s ecef_yd:cm/s ecef_zd:cm/s "
     "pacc:cm sacc:cm/s tow pdop numsv fix"},
    {"GPS_INT", "17 fields",
     "ecef_x:cm ecef_y:cm ecef_z:cm lat:1e7deg lon:1e7deg alt:mm hmsl:mm ecef_xd:cm/s ecef_yd:cm/s ecef_zd:cm/s "
     "pacc:cm sacc:cm/s tow pdop numsv fix comp_id"},
    {"GPS_LLA", "11 fields",
     "lat:1e7deg lon:1e7deg alt:mm hmsl:mm course:decideg speed:cm/s climb:cm/s week itow:ms mode gps_nb_err"},
    {"AIR_DATA", "6 fields", "pressure diff_p temp:degC qnh amsl_baro:m airspeed:m/s"},
    {"AIR_DATA", "7 fields", "pressure diff_p temp:degC qnh amsl_baro:m airspeed:m/s tas:m/s"},
    {"WIND_INFO", "5 fields", "ac_id pad0 east:m/s north:m/s airspeed:m/s"},
    {"WIND_INFO", "6 fields", "ac_id flags east:m/s north:m/s up:m/s airspeed:m/s"},
    {"ROTORCRAFT_FP", "14 fields",
     "east:0.00390625m north:0.00390625m up:0.00390625m veast vnorth vup:0.0000019m/s phi:0.0139882deg theta "
     "psi:0.0139882deg carrot_east carrot_north carrot_up carrot_psi thrust"},
    {"ROTORCRAFT_FP", "15 fields",
     "east:0.00390625m north:0.00390625m up:0.00390625m veast vnorth vup:0.0000019m/s phi:0.0139882deg theta "
     "psi:0.0139882deg carrot_east carrot_north carrot_up carrot_psi thrust flight_time:s"},
    {"ROVER_STATUS", "7 fields", "rc_status frame_rate gps_status ap_mode ap_motors_on cpu_time:s vsupply:V"},
    {"ATTITUDE", "3 fields", "phi:rad psi:rad theta:rad"},
    {"TAKEOFF", "1 field", "cpu_time:s"},
    {"PPRZ_MODE", "6 fields", "ap_mode ap_gaz ap_lateral ap_horizontal if_calib_mode mcu1_status"},
    {"NAVIGATION", "6 fields", "cur_block cur_stage pos_x:m pos_y:m field_4 field_5"},
    {"NAVIGATION", "8 fields", "cur_block cur_stage pos_x:m pos_y:m field_4 field_5 field_6 field_7"},
    {"NAVIGATION", "12 fields",
     "cur_block cur_stage pos_x:m pos_y:m field_4 field_5 field_6 field_7 field_8 field_9 field_10 field_11"},
    {"NAVIGATION_REF", "3 fields", "utm_east:m utm_north:m utm_zone"},
    {"NAVIGATION_REF", "4 fields", "utm_east:m utm_north:m utm_zone ground_alt:m"},
};

MessageDefinition definition_of(const BuiltinLayout& layout) {
    MessageDefinition definition{layout.message, {}, layout.origin};
    for (auto rest = layout.fields; !rest.empty();) {
        const auto field = take_word(rest);
        const auto name = field.substr(0, field.find(':'));
        const auto unit = field.substr(std::min(name.size() + 1, field.size()));
        definition.fields.push_back({std::string(name), "", std::string(unit), "", std::nullopt});
    }
    return definition;
}

std::map<std::string, std::vector<MessageDefinition>, std::less<>> all_definitions() {
    std::map<std::string, std::vector<MessageDefinition>, std::less<>> all;
    for (const auto& layout : builtin_layouts) all[layout.message].push_back(definition_of(layout));
    return all;
}

}  // namespace

std::string xml_attribute(const pugi::xml_node& node, std::string_view lower) {
    const std::string name(lower);
    if (const auto found = node.attribute(name.c_str())) return found.value();
    return node.attribute(boost::algorithm::to_upper_copy(name).c_str()).value();
}

std::vector<ProtocolMessage> parse_protocol(const std::string& text, const std::filesystem::path& file) {
    const auto begin = text.find("<protocol");
    constexpr std::string_view closing = "</protocol>";
    const auto end = begin == std::string::npos ? begin : text.find(closing, begin);
    if (end == std::string::npos) {
        throw InputError({file.string()}, "has no <protocol> element with message definitions",
                         "expected the .log of Paparazzi's server, or a messages.xml");
    }
    pugi::xml_document document;
    const auto parsed = document.load_buffer(text.data() + begin, end + closing.size() - begin);
    if (!parsed) {
        const auto offset = begin + static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0));
        throw InputError({file.string(), line_of_offset(text, offset)},
                         fmt::format("its <protocol> is not XML: {}", parsed.description()));
    }
    std::vector<ProtocolMessage> messages;
    for (const auto& group : document.child("protocol").children()) {
        const std::string_view tag = group.name();
        if (tag != "class" && tag != "msg_class") continue;
        const auto class_name = xml_attribute(group, "name");
        const auto class_id = xml_attribute(group, "id");
        for (const auto& message : group.children("message"))
            messages.push_back({class_name, class_id, xml_attribute(message, "id"), read_message(message)});
    }
    if (messages.empty())
        throw InputError({file.string(), line_of_offset(text, begin)}, "its <protocol> defines no message");
    return messages;
}

FieldConversion find_conversion(std::string_view message, const FieldDefinition& field) {
    const bool centiamperes = message == "BAT" && field.name == "amps";
    if (const auto unit = units::parse_unit(field.unit)) {
        const bool really_hundredths = centiamperes && unit->factor == 1.0;
        return {unit->quantity, really_hundredths ? 0.01 : unit->factor};
    }
    if (const auto unit = units::parse_unit(field.alt_unit); unit && field.alt_unit_coef) {
        return {unit->quantity, unit->factor * *field.alt_unit_coef};
    }
    return {};
}

std::string undeclared_unit(const MessageDefinition& definition, std::size_t field) {
    const auto& declared = definition.fields[field];
    if (!declared.unit.empty() || !declared.alt_unit.empty()) return "";
    std::set<std::string> units;
    for (const auto& layout : builtin_definitions(definition.name)) {
        const auto index = field_index(layout, declared.name);
        if (!index) continue;
        if (std::ranges::equal(layout.fields, definition.fields, {}, &FieldDefinition::name, &FieldDefinition::name))
            return layout.fields[*index].unit;
        units.insert(layout.fields[*index].unit);
    }
    return units.size() == 1 ? *units.begin() : "";
}

std::optional<std::size_t> field_index(const MessageDefinition& definition, std::string_view field) {
    const auto found = std::ranges::find(definition.fields, field, &FieldDefinition::name);
    if (found == definition.fields.end()) return std::nullopt;
    return static_cast<std::size_t>(found - definition.fields.begin());
}

const std::vector<MessageDefinition>& builtin_definitions(std::string_view message) {
    static const auto definitions = all_definitions();
    static const std::vector<MessageDefinition> none;
    const auto found = definitions.find(message);
    return found == definitions.end() ? none : found->second;
}

}  // namespace flightwatt::telemetry

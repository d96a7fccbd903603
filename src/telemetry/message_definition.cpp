#include "telemetry/message_definition.h"

#include <algorithm>

namespace flightwatt::telemetry {
namespace {

/// A built-in layout: "name:unit" a field, "-" for no unit.
MessageDefinition layout(std::string name, std::string origin, const std::vector<std::string>& fields) {
    MessageDefinition definition{std::move(name), {}, std::move(origin)};
    for (const auto& field : fields) {
        const auto colon = field.find(':');
        const auto unit = field.substr(colon + 1);
        definition.fields.push_back({field.substr(0, colon), "", unit == "-" ? "" : unit, "", std::nullopt});
    }
    return definition;
}

using Layouts = std::map<std::string, std::vector<MessageDefinition>, std::less<>>;

Layouts power_layouts() {
    Layouts all;
    all["ENERGY"] = {
        // Real logs and Paparazzi's own definition have the integer energy [mAh] before the power.
        layout("ENERGY", "2009 (4 fields)", {"bat:V", "amp:A", "energy:mAh", "power:W"}),
        layout("ENERGY", "2018 (6 fields)",
               {"throttle:%", "voltage:V", "current:A", "power:W", "charge:Ah", "energy:Wh"}),
        layout("ENERGY", "2023 (7 fields)",
               {"throttle:%", "voltage:V", "current:A", "power:W", "avg_power:W", "charge:Ah", "energy:Wh"}),
    };
    all["BAT"] = {
        layout("BAT", "2005 (7 fields)",
               {"throttle:pprz", "voltage:1e-1V", "flight_time:s", "kill_auto_throttle:-", "block_time:s",
                "stage_time:s", "energy:mAh"}),
        layout("BAT", "2010 (8 fields)",
               {"throttle:pprz", "voltage:1e-1V", "amps:A", "flight_time:s", "kill_auto_throttle:-",
                "block_time:s", "stage_time:s", "energy:mAh"}),
    };
    all["ESC"] = {
        layout("ESC", "2016 (7 fields)",
               {"amps:A", "bat_volts:V", "power:W", "rpm:-", "motor_volts:V", "energy:Wh", "motor_id:-"}),
    };
    all["POWER_DEVICE"] = {
        layout("POWER_DEVICE", "2024 (4 fields)", {"node_id:-", "circuit:-", "current:A", "voltage:V"}),
    };
    return all;
}

Layouts all_layouts() {
    auto all = power_layouts();
    all["ESTIMATOR"] = {layout("ESTIMATOR", "2 fields", {"z:m", "z_dot:m/s"})};
    all["GPS"] = {
        layout("GPS", "before 2011 (10 fields)",
               {"mode:-", "utm_east:cm", "utm_north:cm", "course:decideg", "alt:cm", "speed:cm/s",
                "climb:cm/s", "itow:ms", "utm_zone:-", "gps_nb_err:-"}),
        layout("GPS", "since 2011 (11 fields)",
               {"mode:-", "utm_east:cm", "utm_north:cm", "course:decideg", "alt:mm", "speed:cm/s",
                "climb:cm/s", "week:-", "itow:ms", "utm_zone:-", "gps_nb_err:-"}),
    };
    all["GPS_INT"] = {
        layout("GPS_INT", "16 fields",
               {"ecef_x:cm", "ecef_y:cm", "ecef_z:cm", "lat:1e7deg", "lon:1e7deg", "alt:mm", "hmsl:mm",
                "ecef_xd:cm/s", "ecef_yd:cm/s", "ecef_zd:cm/s", "pacc:cm", "sacc:cm/s", "tow:-", "pdop:-",
                "numsv:-", "fix:-"}),
        layout("GPS_INT", "17 fields",
               {"ecef_x:cm", "ecef_y:cm", "ecef_z:cm", "lat:1e7deg", "lon:1e7deg", "alt:mm", "hmsl:mm",
                "ecef_xd:cm/s", "ecef_yd:cm/s", "ecef_zd:cm/s", "pacc:cm", "sacc:cm/s", "tow:-", "pdop:-",
                "numsv:-", "fix:-", "comp_id:-"}),
    };
    all["AIR_DATA"] = {
        layout("AIR_DATA", "6 fields",
               {"pressure:-", "diff_p:-", "temp:-", "qnh:-", "amsl_baro:m", "airspeed:m/s"}),
        layout("AIR_DATA", "7 fields",
               {"pressure:-", "diff_p:-", "temp:-", "qnh:-", "amsl_baro:m", "airspeed:m/s", "tas:m/s"}),
    };
    all["WIND_INFO"] = {
        layout("WIND_INFO", "5 fields", {"ac_id:-", "pad0:-", "east:m/s", "north:m/s", "airspeed:m/s"}),
        layout("WIND_INFO", "6 fields",
               {"ac_id:-", "flags:-", "east:m/s", "north:m/s", "up:m/s", "airspeed:m/s"}),
    };
    constexpr auto fixed_point = "0.00390625m";  // 2^-8 m
    for (const auto* version : {"14 fields", "15 fields"}) {
        std::vector<std::string> fields;
        for (const auto* name : {"east", "north", "up"})
            fields.push_back(std::string(name) + ":" + fixed_point);
        for (const auto* name :
             {"veast:-", "vnorth:-", "vup:0.0000019m/s", "phi:0.0139882deg", "theta:-", "psi:0.0139882deg"})
            fields.emplace_back(name);
        for (const auto* name :
             {"carrot_east:-", "carrot_north:-", "carrot_up:-", "carrot_psi:-", "thrust:-"}) {
            fields.emplace_back(name);
        }
        if (version == std::string_view("15 fields")) fields.emplace_back("flight_time:s");
        all["ROTORCRAFT_FP"].push_back(layout("ROTORCRAFT_FP", version, fields));
    }
    all["ATTITUDE"] = {layout("ATTITUDE", "3 fields", {"phi:rad", "psi:rad", "theta:rad"})};
    all["GPS_LLA"] = {layout("GPS_LLA", "11 fields",
                             {"lat:1e7deg", "lon:1e7deg", "alt:mm", "hmsl:mm", "course:decideg", "speed:cm/s",
                              "climb:cm/s", "week:-", "itow:ms", "mode:-", "gps_nb_err:-"})};
    all["TAKEOFF"] = {layout("TAKEOFF", "1 field", {"cpu_time:s"})};
    all["PPRZ_MODE"] = {
        layout(
            "PPRZ_MODE", "6 fields",
            {"ap_mode:-", "ap_gaz:-", "ap_lateral:-", "ap_horizontal:-", "if_calib_mode:-", "mcu1_status:-"}),
    };
    for (const auto* rest : {"6", "8", "12"}) {
        std::vector<std::string> fields{"cur_block:-", "cur_stage:-", "pos_x:m", "pos_y:m"};
        while (fields.size() < std::stoul(rest))
            fields.push_back("field_" + std::to_string(fields.size()) + ":-");
        all["NAVIGATION"].push_back(layout("NAVIGATION", std::string(rest) + " fields", fields));
    }
    all["NAVIGATION_REF"] = {
        layout("NAVIGATION_REF", "3 fields", {"utm_east:m", "utm_north:m", "utm_zone:-"}),
        layout("NAVIGATION_REF", "4 fields", {"utm_east:m", "utm_north:m", "utm_zone:-", "ground_alt:m"}),
    };
    return all;
}

}  // namespace

FieldConversion conversion_of(std::string_view message, const FieldDefinition& field) {
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

std::optional<std::size_t> field_index(const MessageDefinition& definition, std::string_view field) {
    const auto found = std::find_if(definition.fields.begin(), definition.fields.end(),
                                    [&](const FieldDefinition& f) { return f.name == field; });
    if (found == definition.fields.end()) return std::nullopt;
    return static_cast<std::size_t>(found - definition.fields.begin());
}

const std::vector<MessageDefinition>& builtin_definitions(std::string_view message) {
    static const auto layouts = all_layouts();
    static const std::vector<MessageDefinition> none;
    const auto found = layouts.find(message);
    return found == layouts.end() ? none : found->second;
}

}  // namespace flightwatt::telemetry

#include "synthetic/log_writer.h"

#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pugixml.hpp>

namespace flightwatt::synthetic {
namespace {

void add_message(pugi::xml_node& parent, const telemetry::MessageDefinition& definition, int id) {
    auto message = parent.append_child("message");
    message.append_attribute("NAME") = definition.name.c_str();
    message.append_attribute("ID") = id;
    for (const auto& field : definition.fields) {
        auto node = message.append_child("field");
        if (!field.unit.empty()) node.append_attribute("UNIT") = field.unit.c_str();
        node.append_attribute("TYPE") = field.type.c_str();
        node.append_attribute("NAME") = field.name.c_str();
    }
}

void add_aircraft(pugi::xml_node& conf, const telemetry::AircraftConfiguration& aircraft) {
    auto node = conf.append_child("aircraft");
    node.append_attribute("name") = aircraft.name.c_str();
    node.append_attribute("ac_id") = aircraft.id.c_str();
    auto plan = node.append_child("flight_plan");
    plan.append_attribute("name") = "Survey";
    if (aircraft.ground_altitude_m) {
        plan.append_attribute("ground_alt") = fmt::format("{:g}", *aircraft.ground_altitude_m).c_str();
    }
    auto blocks = plan.append_child("blocks");
    for (const auto& [number, name] : aircraft.block_names) {
        auto block = blocks.append_child("block");
        block.append_attribute("name") = name.c_str();
        block.append_attribute("no") = number;
    }
    auto section = node.append_child("airframe").append_child("section");
    section.append_attribute("NAME") = "BAT";
    if (aircraft.current_origin == telemetry::CurrentOrigin::sensor) {
        auto define = section.append_child("define");
        define.append_attribute("VALUE") = "(_adc-632)*4.14";
        define.append_attribute("NAME") = "MilliAmpereOfAdc(_adc)";
    }
}

}  // namespace

std::string ocaml_float(double value) {
    const double sent = std::round(value * 1e6) / 1e6;
    auto text = fmt::format("{:.12g}", sent);
    if (text.find_first_of(".en") == std::string::npos) text += '.';
    return text;
}

std::string data_line(double time_s, std::string_view sender, std::string_view message,
                      const std::vector<std::string>& fields) {
    return fmt::format("{:.3f} {} {} {}\n", time_s, sender, message, fmt::join(fields, " "));
}

std::string to_log_xml(const LogDocument& document) {
    pugi::xml_document xml;
    xml.append_child(pugi::node_comment).set_value(document.comment.c_str());
    auto configuration = xml.append_child("configuration");
    configuration.append_attribute("time_of_day") = fmt::format("{:.2f}", document.time_of_day_s).c_str();
    configuration.append_attribute("data_file") = document.data_file.c_str();
    auto conf = configuration.append_child("conf");
    add_aircraft(conf, document.aircraft);
    auto telemetry = configuration.append_child("protocol").append_child("msg_class");
    telemetry.append_attribute("NAME") = "telemetry";
    telemetry.append_attribute("ID") = 1;
    int id = 1;
    for (const auto& definition : document.telemetry) add_message(telemetry, definition, id++);
    std::ostringstream text;
    xml.save(text, "  ", pugi::format_indent | pugi::format_no_declaration);
    return std::move(text).str();
}

}  // namespace flightwatt::synthetic

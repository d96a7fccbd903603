#pragma once

#include "base/units.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pugi {
class xml_node;
}

namespace flightwatt::telemetry {

/// One field of a message as a .log declares it. An array is one field.
struct FieldDefinition {
    std::string name;
    std::string type;
    std::string unit;
    std::string alt_unit;
    std::optional<double> alt_unit_coef;
};

/// A message: its name and fields in order.
struct MessageDefinition {
    std::string name;
    std::vector<FieldDefinition> fields;
    std::string origin;  ///< ".log", or which built-in definition was assumed
};

/// Conversion of a field's raw value to the base unit of its quantity.
struct FieldConversion {
    std::optional<units::Quantity> quantity;  ///< absent: a number without a unit, such as a mode or a block
    double factor = 1.0;
};

/// Returns the conversion of a field by its declared unit, else by the alternative unit and its coefficient
/// (ROTORCRAFT_FP.up: 2^-8 m). BAT.amps, an integer declared "A", counts 0.01 A in every version of Paparazzi.
FieldConversion find_conversion(std::string_view message, const FieldDefinition& field);

/// Returns the built-in unit of a field that the .log's `definition` declares without one (Paparazzi's POWER_DEVICE).
/// Empty if the field has a unit, if none is known, and if the layouts with this field differ and none matches the
/// definition.
std::string undeclared_unit(const MessageDefinition& definition, std::size_t field);

/// Returns the index of a field; std::nullopt if the message has none of that name.
std::optional<std::size_t> field_index(const MessageDefinition& definition, std::string_view field);

/// Returns the built-in definitions for logs without a .log: every layout that Paparazzi has had of `message`, each
/// with another number of fields. Empty for an unknown message.
const std::vector<MessageDefinition>& builtin_definitions(std::string_view message);

/// A message of a <protocol> with its class, and the numbers of both as in the file.
struct ProtocolMessage {
    std::string class_name;
    std::string class_id;  ///< empty in older logs
    std::string id;
    MessageDefinition definition;
};

/// Returns an attribute by its lower-case name, which the file may have in upper case; empty without it.
std::string xml_attribute(const pugi::xml_node& node, std::string_view lower);

/// Returns the messages of the <protocol> element of a .log or messages.xml, in order; only this element is read as
/// XML. Throws InputError if it is missing, not XML, or defines no message.
std::vector<ProtocolMessage> parse_protocol(const std::string& text, const std::filesystem::path& file);

}  // namespace flightwatt::telemetry

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

/// One field of a message as the flight's own .log declares it. Arrays are one field.
struct FieldDefinition {
    std::string name;
    std::string type;
    std::string unit;
    std::string alt_unit;
    std::optional<double> alt_unit_coef;
};

struct MessageDefinition {
    std::string name;
    std::vector<FieldDefinition> fields;
    std::string origin;  ///< ".log", or which built-in definition was assumed
};

/// What turns a field's raw value into the base unit of its quantity.
struct FieldConversion {
    std::optional<units::Quantity> quantity;  ///< absent: a number without a unit, such as a mode or a block
    double factor = 1.0;
};

/// By the declared unit, else by the alternative unit and its coefficient (ROTORCRAFT_FP.up: 2^-8 m).
/// BAT.amps, an integer declared "A", counts 0.01 A in every version of Paparazzi.
FieldConversion find_conversion(std::string_view message, const FieldDefinition& field);

/// The unit that Paparazzi's own definitions give a field that `definition`, of a .log, gives none: those of its own
/// POWER_DEVICE have none. Empty where it has one, where none is known, and where layouts that have the field differ
/// and none has the definition's fields.
std::string undeclared_unit(const MessageDefinition& definition, std::size_t field);

/// Index of a field; std::nullopt if the message has none of that name.
std::optional<std::size_t> field_index(const MessageDefinition& definition, std::string_view field);

/// Built-in definitions of the messages that FlightWatt reads, for logs that come without a .log: every
/// layout of `message` that Paparazzi has had, told apart by their numbers of fields. Empty if unknown.
const std::vector<MessageDefinition>& builtin_definitions(std::string_view message);

/// A message of a <protocol>, with what it and its class are called and numbered; numbers as they stand there.
struct ProtocolMessage {
    std::string class_name;
    std::string class_id;  ///< empty in older logs
    std::string id;
    MessageDefinition definition;
};

/// An attribute by its name in lower case; it may be upper case in the file.
std::string xml_attribute(const pugi::xml_node& node, std::string_view lower);

/// The messages of the <protocol> element of a .log or messages.xml, in their order. Only it is read as XML. Throws
/// InputError where there is none, it is no XML, or it defines no message.
std::vector<ProtocolMessage> parse_protocol(const std::string& text, const std::filesystem::path& file);

}  // namespace flightwatt::telemetry

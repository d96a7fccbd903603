#pragma once

#include "telemetry/message_definition.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pugi {
class xml_node;
}

namespace flightwatt::telemetry {

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

#pragma once

#include "telemetry/link_encoder.h"

#include <string>
#include <vector>

namespace flightwatt::test {

/// Definitions of two messages.
inline telemetry::MessageDictionary small_dictionary() {
    return telemetry::parse_message_dictionary(R"(<protocol><msg_class NAME="telemetry" ID="1">
<message name="ENERGY" id="12"><field name="throttle" type="uint8" unit="%"/><field name="voltage" type="float" unit="V"/>
<field name="current" type="float" unit="A"/><field name="power" type="float" unit="W"/>
<field name="charge" type="float" unit="Ah"/><field name="energy" type="float" unit="Wh"/></message>
<message name="ALIVE" id="2"><field name="md5sum" type="uint8[]"/></message></msg_class>
<msg_class NAME="datalink" ID="2"><message name="PING" id="8"/></msg_class></protocol>)",
                                               "messages.xml");
}

/// The frames of lines.
inline std::string frames_of(const std::vector<std::string>& lines,
                             telemetry::LinkVersion version = telemetry::LinkVersion::v2) {
    const auto dictionary = small_dictionary();
    telemetry::LinkEncoder encoder(dictionary, version);
    std::string frames;
    for (const auto& line : lines) encoder.append_frame(line, frames);
    return frames;
}

/// So many lines that differ.
inline std::vector<std::string> energy_lines(int count, int sender = 20) {
    std::vector<std::string> lines;
    for (int i = 0; i < count; ++i)
        lines.push_back(std::to_string(sender) + " ENERGY " + std::to_string(i % 100) + " 11.5 1.5 17.25 0.125 1.5");
    return lines;
}

}  // namespace flightwatt::test

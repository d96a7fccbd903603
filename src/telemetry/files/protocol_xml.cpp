#include "telemetry/files/protocol_xml.h"

#include "base/error.h"
#include "base/number.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include <fmt/format.h>
#include <pugixml.hpp>

namespace flightwatt::telemetry {
namespace {

std::size_t line_of(std::string_view text, std::size_t offset) {
    const auto* begin = text.data();
    return 1 + static_cast<std::size_t>(std::count(begin, begin + std::min(offset, text.size()), '\n'));
}

MessageDefinition read_message(const pugi::xml_node& node) {
    MessageDefinition message{xml_attribute(node, "name"), {}, ".log"};
    for (const auto& field : node.children("field")) {
        message.fields.push_back({xml_attribute(field, "name"), xml_attribute(field, "type"),
                                  xml_attribute(field, "unit"), xml_attribute(field, "alt_unit"),
                                  parse_number(xml_attribute(field, "alt_unit_coef"))});
    }
    return message;
}

}  // namespace

std::string xml_attribute(const pugi::xml_node& node, std::string_view lower) {
    std::string upper(lower);
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    const auto found = node.attribute(std::string(lower).c_str());
    return found ? found.value() : node.attribute(upper.c_str()).value();
}

std::vector<ProtocolMessage> parse_protocol(const std::string& text, const std::filesystem::path& file) {
    const auto begin = text.find("<protocol");
    constexpr std::string_view closing = "</protocol>";
    const auto end = begin == std::string::npos ? begin : text.find(closing, begin);
    if (end == std::string::npos) {
        throw InputError({file.string()}, "holds no <protocol> element with message definitions",
                         "expected the .log that Paparazzi's server wrote beside the .data, or a messages.xml");
    }
    pugi::xml_document document;
    const auto parsed = document.load_buffer(text.data() + begin, end + closing.size() - begin);
    if (!parsed) {
        const auto offset = begin + static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0));
        throw InputError({file.string(), line_of(text, offset)},
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
    if (messages.empty()) throw InputError({file.string(), line_of(text, begin)}, "its <protocol> defines no message");
    return messages;
}

}  // namespace flightwatt::telemetry

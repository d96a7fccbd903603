#include "exchange/tracks/xml_text.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

namespace flightwatt::exchange {

void add_text(pugi::xml_node& parent, const char* name, std::string_view text) {
    // A file's name may be any bytes: JSON's writer replaces those that are not UTF-8.
    const auto dumped = nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    auto clean = nlohmann::json::parse(dumped).get<std::string>();
    std::ranges::replace_if(
        clean, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
    parent.append_child(name).text().set(clean.c_str());
}

std::string xml_text(pugi::xml_document& document) {
    auto declaration = document.prepend_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    std::ostringstream stream;
    document.save(stream, "  ", pugi::format_default, pugi::encoding_utf8);
    return stream.str();
}

std::string degrees_text(double degrees) { return fmt::format("{:.7f}", degrees); }

std::string metres_text(double metres) { return fmt::format("{:.2f}", metres); }

}  // namespace flightwatt::exchange

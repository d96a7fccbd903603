#pragma once

#include <string>
#include <string_view>

namespace pugi {
class xml_document;
class xml_node;
}  // namespace pugi

namespace flightwatt::exchange {

/// A child element that holds `text`, in which '?' stands for bytes that XML 1.0 in UTF-8 cannot hold.
void add_text(pugi::xml_node& parent, const char* name, std::string_view text);

/// The document, indented, after the declaration that it is given.
std::string xml_text(pugi::xml_document& document);

/// Degrees with 7 decimals (a centimetre), metres with 2.
std::string degrees_text(double degrees);
std::string metres_text(double metres);

}  // namespace flightwatt::exchange

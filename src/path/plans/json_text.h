#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace flightwatt::path {

using Json = nlohmann::json;

/// Parses JSON. Throws InputError with the line of text that is not JSON, and of a number that is out of range.
Json parse_json(std::string_view text, const std::string& file, const std::string& hint);

}  // namespace flightwatt::path

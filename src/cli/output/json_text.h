#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace flightwatt::cli {

/// Indented, with a line break at its end. A name that is not UTF-8 (a file's) does not spoil the answer.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace flightwatt::cli

#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace flightwatt::cli {

/// Indented, with a line break at its end. A name that is not UTF-8 (a file's) does not spoil the answer.
inline std::string json_text(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// null for what is not known.
template <typename T>
nlohmann::ordered_json optional_json(const std::optional<T>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace flightwatt::cli

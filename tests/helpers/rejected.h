#pragma once

#include "base/error.h"
#include "helpers/test_paths.h"

#include <fstream>
#include <string>
#include <string_view>

namespace flightwatt::test {

/// What a user would read of an InputError that `attempt` throws, "file:line:column: message; hint", with
/// `folder` taken away wherever it stands; empty if nothing is thrown.
template <typename Attempt>
std::string rejected(const Attempt& attempt, const std::filesystem::path& folder = {}) {
    std::string text;
    try {
        attempt();
    } catch (const InputError& error) {
        text = to_string(error.where()) + ": " + error.what();
        if (!error.hint().empty()) text += "; " + error.hint();
    }
    const auto prefix = folder.string() + "/";
    while (!folder.empty() && text.find(prefix) != std::string::npos) text.erase(text.find(prefix), prefix.size());
    return text;
}

inline std::filesystem::path write_text(const std::filesystem::path& path, std::string_view text) {
    std::ofstream(path) << text;
    return path;
}

}  // namespace flightwatt::test

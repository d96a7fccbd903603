#pragma once

#include "cli/options.h"

#include <string>
#include <vector>

namespace flightwatt::test {

/// Sets the variables of the options as a command with these words does. Throws UsageError.
inline void give_options(const cli::Options& options, std::vector<std::string> words) {
    words.insert(words.begin(), "program");
    std::vector<char*> argv;
    argv.reserve(words.size());
    for (auto& word : words) argv.push_back(word.data());
    options.assign(options.parse(static_cast<int>(argv.size()), argv.data()));
}

}  // namespace flightwatt::test

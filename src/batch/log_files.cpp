#include "batch/log_files.h"

#include "base/error.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <map>
#include <regex>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt {
namespace {

bool is_log_name(const std::filesystem::path& path) {
    static const std::regex ending("\\.data(\\.(gz|bz2|xz|zst))?$");
    return std::regex_search(path.filename().string(), ending);
}

void add_folder(const std::filesystem::path& folder, std::vector<std::filesystem::path>& paths) {
    std::error_code error;
    std::filesystem::recursive_directory_iterator entries(folder, error);
    if (error) throw InputError({folder.string()}, fmt::format("cannot be listed: {}", error.message()));
    for (const auto& entry : entries) {
        if (entry.is_regular_file() && is_log_name(entry.path())) paths.push_back(entry.path());
    }
}

}  // namespace

std::vector<LogFile> find_logs(const std::vector<std::string>& inputs) {
    std::vector<std::filesystem::path> paths;
    for (const auto& input : inputs) {
        if (std::filesystem::is_directory(input))
            add_folder(input, paths);
        else if (std::filesystem::exists(input))
            paths.emplace_back(input);
        else
            throw InputError({input}, "does not exist", "expected a .data log or a folder of them");
    }
    for (auto& path : paths) path = path.lexically_normal();
    std::sort(paths.begin(), paths.end());
    paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
    if (paths.empty()) {
        throw InputError({}, fmt::format("no .data log in {}", fmt::join(inputs, ", ")),
                         "expected *.data, also .gz, .bz2, .xz or .zst");
    }
    std::vector<LogFile> logs;
    std::map<std::string, std::size_t> uses;
    for (auto& path : paths) {
        auto name = flight_name(path);
        const auto use = ++uses[name];
        if (use > 1) name += fmt::format("_{}", use);
        logs.push_back({std::move(path), std::move(name)});
    }
    return logs;
}

}  // namespace flightwatt

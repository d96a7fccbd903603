#include "batch/log_files.h"

#include "base/error.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt {
namespace {

bool is_log_name(const std::filesystem::path& path) {
    const auto name = path.filename().string();
    constexpr std::array<std::string_view, 5> endings{".data", ".data.gz", ".data.bz2", ".data.xz",
                                                      ".data.zst"};
    return std::any_of(endings.begin(), endings.end(),
                       [&](std::string_view ending) { return name.ends_with(ending); });
}

void add_folder(const std::filesystem::path& folder, std::vector<std::filesystem::path>& paths) {
    std::error_code error;
    std::filesystem::recursive_directory_iterator entry(folder, error);
    while (!error && entry != std::filesystem::recursive_directory_iterator()) {
        std::error_code ignored;
        // What has a log's name and is no file (a link to nowhere) is rejected later, not passed over.
        if (is_log_name(entry->path()) && !entry->is_directory(ignored)) paths.push_back(entry->path());
        entry.increment(error);
    }
    if (error) throw InputError({folder.string()}, fmt::format("cannot be listed: {}", error.message()));
}

/// The same for every way to write a file's path. Links to a file stay apart: each has its own .log.
std::filesystem::path identity(const std::filesystem::path& path) {
    std::error_code error;
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    const auto canonical = std::filesystem::canonical(folder, error);
    return error ? path : canonical / path.filename();
}

std::vector<std::filesystem::path> each_once(std::vector<std::filesystem::path> paths) {
    for (auto& path : paths) path = path.lexically_normal();
    std::sort(paths.begin(), paths.end());
    std::set<std::filesystem::path> seen;
    std::erase_if(paths, [&](const auto& path) { return !seen.insert(identity(path)).second; });
    return paths;
}

/// The log's own name, or, where another log has that, the next free one of NAME_2, NAME_3, ...
std::string free_name(const std::filesystem::path& path, const std::set<std::string>& taken) {
    auto name = flight_name(path);
    if (name.empty()) name = "unnamed";
    auto free = name;
    for (int use = 2; taken.contains(free); ++use) free = fmt::format("{}_{}", name, use);
    return free;
}

}  // namespace

std::vector<LogFile> find_logs(const std::vector<std::string>& inputs) {
    std::vector<std::filesystem::path> paths;
    for (const auto& input : inputs) {
        std::error_code error;
        const auto status = std::filesystem::status(input, error);
        if (std::filesystem::is_directory(status)) {
            add_folder(input, paths);
            continue;
        }
        if (!std::filesystem::exists(status)) {
            const auto cause = input.empty() || !error || error == std::errc::no_such_file_or_directory
                                   ? "does not exist"
                                   : error.message();
            throw InputError({input.empty() ? "''" : input}, cause,
                             "expected a .data log or a folder of them");
        }
        paths.emplace_back(input);
    }
    paths = each_once(std::move(paths));
    if (paths.empty()) {
        throw InputError({}, fmt::format("no .data log in {}", fmt::join(inputs, ", ")),
                         "expected *.data, also .gz, .bz2, .xz or .zst");
    }
    std::vector<LogFile> logs;
    std::set<std::string> taken;
    for (auto& path : paths) {
        auto name = free_name(path, taken);
        taken.insert(name);
        logs.push_back({std::move(path), std::move(name)});
    }
    return logs;
}

}  // namespace flightwatt

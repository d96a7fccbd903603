#include "batch/log_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <system_error>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::batch {
namespace {

bool is_log_name(const std::filesystem::path& path) {
    const auto name = path.filename().string();
    constexpr std::array<std::string_view, 5> endings{".data", ".data.gz", ".data.bz2", ".data.xz", ".data.zst"};
    return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return name.ends_with(ending); });
}

/// What the nearest not-fitted.txt between the folder that was given and the log says; empty without one.
std::string why_not_fitted(const std::filesystem::path& log, const std::filesystem::path& given) {
    auto inner = log.parent_path().lexically_relative(given);  // "." for the folder itself
    for (; !inner.empty() && inner != "."; inner = inner.parent_path()) {
        const auto file = given / inner / "not-fitted.txt";
        if (!std::filesystem::exists(file)) continue;
        const auto text = read_file(file);
        auto reason = text.substr(0, text.find_first_of("\r\n"));
        if (reason.empty()) {
            throw InputError({file.string(), 1}, "is empty", "its first line says why these logs are not fitted");
        }
        return reason;
    }
    return {};
}

void add_folder(const std::filesystem::path& folder, std::vector<LogFile>& logs) {
    std::error_code error;
    std::filesystem::recursive_directory_iterator entry(folder, error);
    while (!error && entry != std::filesystem::recursive_directory_iterator()) {
        std::error_code ignored;
        // What has a log's name and is no file (a link to nowhere) is rejected later, not passed over.
        if (is_log_name(entry->path()) && !entry->is_directory(ignored)) {
            logs.push_back({entry->path(), {}, why_not_fitted(entry->path(), folder)});
        }
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

std::vector<LogFile> each_once(std::vector<LogFile> logs) {
    for (auto& log : logs) log.path = log.path.lexically_normal();
    std::sort(logs.begin(), logs.end(), [](const LogFile& a, const LogFile& b) {
        return std::tie(a.path, a.why_not_fitted) < std::tie(b.path, b.why_not_fitted);
    });
    std::set<std::filesystem::path> seen;
    std::erase_if(logs, [&](const auto& log) { return !seen.insert(identity(log.path)).second; });
    return logs;
}

/// The log's own name, or, where another log has that, the next free one of NAME_2, NAME_3, ...
std::string free_name(const std::filesystem::path& path, const std::set<std::string>& taken) {
    auto name = telemetry::flight_name(path);
    if (name.empty()) name = "unnamed";
    auto free = name;
    for (int use = 2; taken.contains(free); ++use) free = fmt::format("{}_{}", name, use);
    return free;
}

}  // namespace

std::vector<LogFile> find_logs(const std::vector<std::string>& inputs) {
    std::vector<LogFile> logs;
    for (const auto& input : inputs) {
        std::error_code error;
        const auto status = std::filesystem::status(input, error);
        if (std::filesystem::is_directory(status)) {
            add_folder(input, logs);
            continue;
        }
        if (!std::filesystem::exists(status)) {
            const auto cause = input.empty() || !error || error == std::errc::no_such_file_or_directory
                                   ? "does not exist"
                                   : error.message();
            throw InputError({input.empty() ? "''" : input}, cause, "expected a .data log or a folder of them");
        }
        logs.push_back({input, {}, {}});
    }
    logs = each_once(std::move(logs));
    if (logs.empty()) {
        throw InputError({}, fmt::format("no .data log in {}", fmt::join(inputs, ", ")),
                         "expected *.data, also .gz, .bz2, .xz or .zst");
    }
    std::set<std::string> taken;
    for (auto& log : logs) {
        log.flight = free_name(log.path, taken);
        taken.insert(log.flight);
    }
    return logs;
}

}  // namespace flightwatt::batch

#include "base/overwrite_guard.h"

#include "base/error.h"

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>
#include <unordered_set>

#include <fmt/format.h>

namespace flightwatt {
namespace {

struct FileUse {
    std::mutex mutex;  ///< of the members below, places of files behind all symbolic links
    std::unordered_set<std::string> inputs{};
    std::map<std::string, std::string> declared{};  ///< results, with their option
    std::map<std::string, std::string> written{};
};

std::atomic<bool> watched = false;
thread_local int own_files = 0;

FileUse& file_use() {
    static FileUse use;
    return use;
}

/// Of a regular file; a result replaces a name, so that other hard links keep their content. std::nullopt for devices
/// and pipes, which may take several results.
std::optional<std::string> place_of(const std::filesystem::path& path, bool may_be_new = false) {
    std::error_code unknown;
    const auto status = std::filesystem::status(path, unknown);
    const bool is_new = status.type() == std::filesystem::file_type::not_found;
    if (is_new ? !may_be_new : !std::filesystem::is_regular_file(status)) return std::nullopt;
    const auto place = std::filesystem::weakly_canonical(std::filesystem::absolute(path, unknown), unknown);
    if (unknown || place.empty()) return std::nullopt;
    return place.string();
}

[[noreturn]] void refuse_second(const std::string& one, const std::string& other) {
    throw UsageError(fmt::format("{} and {} are one file; name another one for one of them", one, other));
}

void refuse_if_read(const FileUse& use, const std::string& place, const std::string& output) {
    if (use.inputs.contains(place)) throw UsageError(output + " is an input, which would be lost; name another file");
}

}  // namespace

void enable_overwrite_guard() { watched = true; }

void register_input(const std::filesystem::path& path) {
    if (!watched || own_files > 0) return;
    const auto place = place_of(path);
    if (!place) return;
    auto& use = file_use();
    const std::lock_guard lock(use.mutex);
    if (const auto output = use.declared.find(*place); output != use.declared.end())
        throw UsageError(
            fmt::format("{} is the input {}, which would be lost; name another file", output->second, path.string()));
    use.inputs.insert(*place);
}

void register_output(const std::filesystem::path& path, const std::string& option) {
    if (!watched) return;
    const auto place = place_of(path, true);
    if (!place) return;
    auto& use = file_use();
    const std::lock_guard lock(use.mutex);
    const auto name = option.empty() ? path.string() : option + " " + path.string();
    refuse_if_read(use, *place, name);
    const auto [other, is_new] = use.declared.emplace(*place, name);
    if (!is_new) refuse_second(other->second, name);
}

void check_overwrite(const std::filesystem::path& path) {
    if (!watched) return;
    const auto place = place_of(path);
    if (!place) return;
    auto& use = file_use();
    const std::lock_guard lock(use.mutex);
    refuse_if_read(use, *place, path.string());
    const auto before = use.written.find(*place);
    if (before == use.written.end()) return;
    if (own_files == 0) refuse_second(before->second, path.string());
    use.written.erase(before);
}

void mark_written(const std::filesystem::path& path) {
    if (!watched || own_files > 0) return;
    const auto place = place_of(path);
    if (!place) return;
    auto& use = file_use();
    const std::lock_guard lock(use.mutex);
    use.written.insert_or_assign(*place, path.string());
}

OverwriteExemption::OverwriteExemption() { ++own_files; }
OverwriteExemption::~OverwriteExemption() { --own_files; }

}  // namespace flightwatt

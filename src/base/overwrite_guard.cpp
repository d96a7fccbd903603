#include "base/overwrite_guard.h"

#include "base/error.h"

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <unordered_set>

#include <boost/functional/hash.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

namespace flightwatt {
namespace {

/// Device, inode and time of birth: an inode's number is given to another file after the file is deleted.
using FileId = std::tuple<std::uint32_t, std::uint32_t, std::uint64_t, std::int64_t, std::uint32_t>;

/// Of a regular file, behind all links.
std::optional<FileId> id_of(const std::filesystem::path& path) {
    struct statx found {};
    if (::statx(AT_FDCWD, path.c_str(), 0, STATX_TYPE | STATX_INO | STATX_BTIME, &found) != 0) return std::nullopt;
    if (!S_ISREG(found.stx_mode)) return std::nullopt;
    const bool has_birth = (found.stx_mask & STATX_BTIME) != 0;
    return FileId{found.stx_dev_major, found.stx_dev_minor, found.stx_ino, has_birth ? found.stx_btime.tv_sec : 0,
                  has_birth ? found.stx_btime.tv_nsec : 0};
}

std::uint64_t fingerprint_of(const FileId& id) {
    std::size_t seed = 0;
    std::apply([&](const auto&... parts) { (boost::hash_combine(seed, parts), ...); }, id);
    return seed;
}

struct FileUse {
    std::mutex mutex;                            ///< of the members below
    std::unordered_set<std::uint64_t> inputs{};  ///< their fingerprints: of an archive, names would take room
    std::map<FileId, std::string> declared;      ///< files that exist, with their option
    std::map<FileId, std::string> written;
    std::map<std::string, std::string> declared_paths;
};

std::atomic<bool> watched = false;
thread_local int own_files = 0;

FileUse& file_use() {
    static FileUse use;
    return use;
}

std::string named(const std::filesystem::path& path, const std::string& option) {
    return option.empty() ? path.string() : option + " " + path.string();
}

[[noreturn]] void refuse_second(const std::string& one, const std::string& other) {
    throw UsageError(fmt::format("{} and {} are one file; name another one for one of them", one, other));
}

void refuse_if_read(const FileUse& use, const std::optional<FileId>& id, const std::string& output) {
    if (id && use.inputs.contains(fingerprint_of(*id)))
        throw UsageError(output + " is an input, which would be lost; name another file");
}

}  // namespace

void enable_overwrite_guard() { watched = true; }

void register_input(const std::filesystem::path& path) {
    if (!watched || own_files > 0) return;
    const auto id = id_of(path);
    if (!id) return;
    auto& use = file_use();
    const std::lock_guard lock(use.mutex);
    if (const auto output = use.declared.find(*id); output != use.declared.end()) {
        throw UsageError(
            fmt::format("{} is the input {}, which would be lost; name another file", output->second, path.string()));
    }
    use.inputs.insert(fingerprint_of(*id));
}

void register_output(const std::filesystem::path& path, const std::string& option) {
    if (!watched) return;
    std::error_code unknown;
    const auto place = std::filesystem::weakly_canonical(std::filesystem::absolute(path, unknown), unknown);
    const auto id = id_of(path);
    auto& use = file_use();
    const std::lock_guard lock(use.mutex);
    const auto name = named(path, option);
    refuse_if_read(use, id, name);
    // Devices and pipes may take several results.
    if (!id && std::filesystem::exists(path, unknown)) return;
    if (id) {
        const auto [other, is_new] = use.declared.emplace(*id, name);
        if (!is_new) refuse_second(other->second, name);
    }
    if (unknown || place.empty()) return;
    const auto [other, is_new] = use.declared_paths.emplace(place.string(), name);
    if (!is_new) refuse_second(other->second, name);
}

void check_overwrite(const std::filesystem::path& path) {
    if (!watched) return;
    const auto id = id_of(path);
    if (!id) return;
    auto& use = file_use();
    const std::lock_guard lock(use.mutex);
    refuse_if_read(use, id, path.string());
    const auto before = use.written.find(*id);
    if (before == use.written.end()) return;
    if (own_files == 0) refuse_second(before->second, path.string());
    use.written.erase(before);
}

void mark_written(const std::filesystem::path& path) {
    if (!watched) return;
    const auto id = id_of(path);
    if (!id || own_files > 0) return;
    auto& use = file_use();
    const std::lock_guard lock(use.mutex);
    use.written.insert_or_assign(*id, path.string());
}

OverwriteExemption::OverwriteExemption() { ++own_files; }
OverwriteExemption::~OverwriteExemption() { --own_files; }

}  // namespace flightwatt

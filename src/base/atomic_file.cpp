#include "base/atomic_file.h"

#include "base/error.h"
#include "base/overwrite_guard.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <random>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace flightwatt {
namespace {

std::string write_remedy(const std::filesystem::path& path, int error) {
    if (error == ENOENT) return fmt::format("; make its folder first: mkdir -p {}", path.parent_path().string());
    if (error == EISDIR) return "; name a file in it";
    if (error == ENOTDIR || error == EEXIST) return "; a file is in the way: give another name";
    return error == EACCES || error == EROFS ? "; choose a folder that you may write to" : "";
}

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
    throw OutputError(
        fmt::format("cannot write {}: {}{}", path.string(), std::strerror(error), write_remedy(path, error)));
}

bool write_all(int file, std::string_view content) {
    while (!content.empty()) {
        const auto written = ::write(file, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        content.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

/// Target of a result of that name.
struct Destination {
    std::filesystem::path file;              ///< behind all links
    bool is_special = false;                 ///< a device or a pipe, which cannot be replaced
    std::optional<struct stat> before = {};  ///< of the file that is replaced
};

Destination destination_of(const std::filesystem::path& path) {
    Destination destination{path};
    constexpr int max_links = 40;  // as the kernel
    for (int links = 0;; ++links) {
        // A link of the system to an open file (-o /dev/stdout) has no usable name.
        destination.is_special = destination.is_special || destination.file.string().starts_with("/proc/");
        std::error_code none;
        const auto next = std::filesystem::read_symlink(destination.file, none);
        if (none) break;
        if (links == max_links) fail(path, ELOOP);
        destination.file = next.is_absolute() ? next : destination.file.parent_path() / next;
    }
    struct stat found {};
    if (::stat(path.c_str(), &found) != 0) return destination;
    if (S_ISDIR(found.st_mode)) fail(path, EISDIR);
    destination.is_special = destination.is_special || !S_ISREG(found.st_mode);
    if (destination.is_special) {
        destination.file = path;
    } else {
        destination.before = found;
    }
    return destination;
}

std::filesystem::path unfinished_name(const std::filesystem::path& folder) {
    std::random_device random;
    return folder / fmt::format(".flightwatt-{:08x}{:08x}", random(), random());
}

/// Copies permissions and owner of the replaced file.
bool keep_permissions(int file, const struct stat& before) {
    if (::fchown(file, before.st_uid, before.st_gid) != 0 &&
        ::fchown(file, static_cast<uid_t>(-1), before.st_gid) != 0) {
        return ::fchmod(file, before.st_mode & 0777) == 0;  // another's file: ours now, without its special bits
    }
    return ::fchmod(file, before.st_mode & 07777) == 0;
}

TextSink sink_of(int file, const std::filesystem::path& path) {
    return [file, path](std::string_view piece) {
        if (!write_all(file, piece)) fail(path, errno);
    };
}

void write_directly(const std::filesystem::path& path, const TextWriter& write) {
    const int file = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (file < 0) fail(path, errno);
    try {
        write(sink_of(file, path));
    } catch (...) {
        ::close(file);
        throw;
    }
    if (::close(file) != 0) fail(path, errno);
}

/// False where the folder of unfinished files is not there, or of another file system than the destination.
bool replace(const std::filesystem::path& path, const Destination& destination, const TextWriter& write,
             const std::filesystem::path& folder) {
    // Its name does not depend on the result's: that may be as long as names can be.
    const auto unfinished = unfinished_name(folder);
    const int file = ::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno == ENOENT) return false;
    if (file < 0) fail(path, errno);
    try {
        write(sink_of(file, path));
        if (destination.before && !keep_permissions(file, *destination.before)) fail(path, errno);
    } catch (...) {
        ::close(file);
        ::unlink(unfinished.c_str());
        throw;
    }
    if (::close(file) == 0 && ::rename(unfinished.c_str(), destination.file.c_str()) == 0) return true;
    const int error = errno;
    ::unlink(unfinished.c_str());
    if (error == EXDEV) return false;
    fail(path, error);
}

}  // namespace

void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           const std::filesystem::path& temporary_folder) {
    const TextWriter write = [content](const TextSink& sink) { sink(content); };
    write_file_atomically(path, write, temporary_folder);
}

void write_file_atomically(const std::filesystem::path& path, const TextWriter& write,
                           const std::filesystem::path& temporary_folder) {
    const auto destination = destination_of(path);
    if (destination.is_special) return write_directly(path, write);
    check_overwrite(path);
    // Without the right to write it a file is not replaced either, though its folder would allow that.
    if (destination.before && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) fail(path, errno);
    auto folder = destination.file.parent_path();
    if (folder.empty()) folder = ".";
    if (temporary_folder.empty() || !replace(path, destination, write, temporary_folder)) {
        if (!replace(path, destination, write, folder)) fail(path, ENOENT);
    }
    mark_written(path);
}

void write_files_atomically(const std::map<std::filesystem::path, std::string>& files) {
    struct Renaming {
        std::filesystem::path unfinished;
        std::filesystem::path file;
    };
    std::map<std::filesystem::path, Renaming> renamed;
    try {
        for (const auto& [path, content] : files) {
            const auto destination = destination_of(path);
            check_overwrite(path);
            if (destination.is_special) fail(path, EEXIST);
            if (destination.before && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) fail(path, errno);
            const auto& [unfinished, file] =
                renamed[path] = {unfinished_name(destination.file.parent_path()), destination.file};
            write_file_atomically(unfinished, content);
        }
        for (const auto& [path, names] : renamed) {
            if (::rename(names.unfinished.c_str(), names.file.c_str()) != 0) fail(path, errno);
            mark_written(path);
        }
    } catch (...) {
        for (const auto& [path, names] : renamed) ::unlink(names.unfinished.c_str());
        throw;
    }
}

void link_or_copy_file(const std::filesystem::path& source, const std::filesystem::path& path,
                       const std::filesystem::path& temporary_folder) {
    const auto link = unfinished_name(temporary_folder);
    if (::link(source.c_str(), link.c_str()) != 0)
        return write_file_atomically(path, read_file(source, std::numeric_limits<std::size_t>::max()),
                                     temporary_folder);
    check_overwrite(path);
    const bool is_done = ::rename(link.c_str(), path.c_str()) == 0;
    const int error = errno;
    ::unlink(link.c_str());  // rename does nothing where both are names of one file
    if (!is_done) fail(path, error);
    mark_written(path);
}

bool file_holds(const std::filesystem::path& path, std::string_view text) {
    std::ifstream stream(path, std::ios::binary);
    return stream && std::string(std::istreambuf_iterator<char>(stream), {}) == text;
}

void make_directories(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) {
        throw OutputError(fmt::format("cannot make the folder {}: {}{}", path.string(), error.message(),
                                      write_remedy(path, error.value())));
    }
}

}  // namespace flightwatt

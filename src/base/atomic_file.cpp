#include "base/atomic_file.h"

#include "base/error.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace flightwatt {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
    throw OutputError(fmt::format("cannot write {}: {}", path.string(), std::strerror(error)));
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

}  // namespace

void write_file_atomically(const std::filesystem::path& path, std::string_view content) {
    std::error_code unknown;  // a name that is too long, say: opening it will tell
    if (std::filesystem::is_directory(path, unknown)) fail(path, EISDIR);
    // Devices and pipes (-o /dev/stdout) cannot be replaced: write them directly.
    std::error_code ignored;
    const bool special = std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored);
    std::string target = special ? path.string() : path.string() + ".XXXXXX";
    const int file = special ? ::open(target.c_str(), O_WRONLY | O_CLOEXEC) : ::mkstemp(target.data());
    if (file < 0) fail(path, errno);
    const bool written = write_all(file, content) && (special || ::fchmod(file, 0644) == 0);
    int error = errno;
    const bool closed = ::close(file) == 0;
    if (written && !closed) error = errno;
    if (!written || !closed) {
        if (!special) ::unlink(target.c_str());
        fail(path, error);
    }
    if (!special && ::rename(target.c_str(), path.c_str()) != 0) {
        error = errno;
        ::unlink(target.c_str());
        fail(path, error);
    }
}

void make_directories(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) {
        throw OutputError(fmt::format("cannot make the folder {}: {}", path.string(), error.message()));
    }
}

}  // namespace flightwatt

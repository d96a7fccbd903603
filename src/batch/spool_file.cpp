#include "batch/spool_file.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <random>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace flightwatt::batch {
namespace {

/// Of a system that makes no file without a name: one whose name is taken away at once.
int open_and_unlink(const std::filesystem::path& folder) {
    std::random_device random;
    const auto path = folder / fmt::format(".flightwatt-{:08x}{:08x}", random(), random());
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file >= 0) ::unlink(path.c_str());
    return file;
}

/// False where not all can be written or read.
template <typename Transfer>
bool transfer_all(const Transfer& transfer, std::size_t size, std::uint64_t at) {
    for (std::size_t done = 0; done < size;) {
        const auto moved = transfer(done, size - done, static_cast<off_t>(at + done));
        if (moved < 0 && errno == EINTR) continue;
        if (moved == 0) errno = EIO;
        if (moved <= 0) return false;
        done += static_cast<std::size_t>(moved);
    }
    return true;
}

}  // namespace

SpoolFile::SpoolFile(const std::filesystem::path& folder)
    : folder_(folder), file_(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600)) {
    if (file_ < 0) file_ = open_and_unlink(folder);
    if (file_ < 0) fail("make");
}

SpoolFile::~SpoolFile() { ::close(file_); }

void SpoolFile::fail(const char* what) const {
    throw OutputError(fmt::format("cannot {} a file in {}: {}", what, folder_.string(), std::strerror(errno)));
}

std::uint64_t SpoolFile::add(std::string_view text) {
    const std::uint64_t size = text.size();
    std::string framed(sizeof(size) + text.size(), '\0');
    std::memcpy(framed.data(), &size, sizeof(size));
    std::ranges::copy(text, framed.begin() + sizeof(size));
    const std::lock_guard lock(mutex_);
    const auto at = end_;
    const auto write = [&](std::size_t from, std::size_t most, off_t place) {
        return ::pwrite(file_, framed.data() + from, most, place);
    };
    if (!transfer_all(write, framed.size(), at)) fail("write");
    end_ += framed.size();
    return at;
}

std::string SpoolFile::read(std::uint64_t at) const {
    const auto read_into = [&](char* text, std::size_t size, std::uint64_t place) {
        const auto read = [&](std::size_t from, std::size_t most, off_t where) {
            return ::pread(file_, text + from, most, where);
        };
        if (!transfer_all(read, size, place)) fail("read back");
    };
    std::array<char, sizeof(std::uint64_t)> framed{};
    read_into(framed.data(), framed.size(), at);
    std::uint64_t size = 0;
    std::memcpy(&size, framed.data(), sizeof(size));
    std::string text(size, '\0');
    read_into(text.data(), text.size(), at + sizeof(size));
    return text;
}

}  // namespace flightwatt::batch

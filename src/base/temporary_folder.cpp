#include "base/temporary_folder.h"

#include "base/atomic_file.h"
#include "base/error.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

namespace flightwatt {

TemporaryFolder::TemporaryFolder() {
    const char* temporary = std::getenv("TMPDIR");
    auto pattern = fmt::format("{}/flightwatt-XXXXXX", temporary != nullptr ? temporary : "/tmp");
    if (::mkdtemp(pattern.data()) == nullptr)
        throw OutputError(fmt::format("{}: cannot make a folder: {}", pattern, std::strerror(errno)));
    path_ = pattern;
}

TemporaryFolder::TemporaryFolder(const std::filesystem::path& path) : path_(path) { make_directories(path_); }

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace flightwatt

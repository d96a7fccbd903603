#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>

namespace flightwatt::batch {

/// A file without a name, for what would fill the memory: it is gone with this, and with the program, however that
/// ends. For any number of threads.
class SpoolFile {
  public:
    /// Throws OutputError where no file can be made in the folder.
    explicit SpoolFile(const std::filesystem::path& folder);
    ~SpoolFile();
    SpoolFile(const SpoolFile&) = delete;
    SpoolFile& operator=(const SpoolFile&) = delete;

    /// Where the text stands that was added, for `read`. Throws OutputError.
    std::uint64_t add(std::string_view text);
    /// Throws OutputError where the file cannot be read, or nothing was added there.
    std::string read(std::uint64_t at) const;

  private:
    [[noreturn]] void fail(const char* what) const;

    std::filesystem::path folder_;
    int file_ = -1;
    std::mutex mutex_;  ///< guards what follows
    std::uint64_t end_ = 0;
};

}  // namespace flightwatt::batch

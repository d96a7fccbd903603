#pragma once

#include <filesystem>

namespace flightwatt {

/// A new folder, which is removed with this object and all that is in it. Throws OutputError if it cannot be made.
class TemporaryFolder {
  public:
    /// Makes one in TMPDIR (/tmp).
    TemporaryFolder();
    /// Makes one at this path.
    explicit TemporaryFolder(const std::filesystem::path& path);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace flightwatt

#pragma once

#include <filesystem>

namespace flightwatt {

/// A new folder in TMPDIR (/tmp), which is removed with this object and all that is in it.
class TemporaryFolder {
  public:
    /// Throws OutputError if the folder cannot be made.
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace flightwatt

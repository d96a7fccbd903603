#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <boost/iostreams/device/mapped_file.hpp>

namespace flightwatt::telemetry {

/// The text of a .data file: mapped, or decompressed into memory (.gz, .bz2, .xz, .zst, told by content).
/// Throws InputError for a missing file, a folder, an empty file, a ZIP archive or broken compression.
class DataFile {
  public:
    explicit DataFile(const std::filesystem::path& path);
    std::string_view text() const { return text_; }

  private:
    boost::iostreams::mapped_file_source mapped_;
    std::string decompressed_;
    std::string_view text_;
};

}  // namespace flightwatt::telemetry

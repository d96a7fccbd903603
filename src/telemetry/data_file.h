#pragma once

#include "base/input_file.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::telemetry {

/// A regular file that is not empty, mapped into memory. Where it is cut while it is mapped, its rest reads as zeros
/// from then on instead of ending the program (SIGBUS), and is_damaged() tells. Any thread may read; any number of
/// files up to `max_mapped` may be mapped at a time.
class MappedFile {
  public:
    static constexpr std::size_t max_mapped = 1024;

    /// Throws InputError where the system cannot map it. `file` may be closed after.
    explicit MappedFile(const InputFile& file);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::string_view text() const { return text_; }
    /// Whether a part was asked for that the file had no more, or that could not be read.
    bool is_damaged() const;

  private:
    std::string_view text_;
    std::size_t slot_ = 0;
};

/// What a compressed log may unpack to, and a series hold, unless told: some ten hours of flight. More is refused, as
/// reading takes up to nine times as much memory.
inline constexpr std::size_t default_max_log_bytes = 100'000'000;

/// The text of a .data file: mapped, or decompressed into memory (.gz, .bz2, .xz, .zst, told by content).
/// Throws InputError for a missing file, a folder, an empty file, a ZIP archive, broken compression, or one that
/// unpacks to more than `max_bytes`.
class DataFile {
  public:
    explicit DataFile(const std::filesystem::path& path, std::size_t max_bytes = default_max_log_bytes);
    std::string_view text() const { return text_; }
    /// Throws InputError if the file was cut since: what was read of its text may then be zeros. To be asked after
    /// reading. A file that grows is read as it was.
    void require_unchanged() const;

  private:
    std::optional<InputFile> file_;  ///< of a text that is mapped
    std::optional<MappedFile> mapped_;
    std::string decompressed_;
    std::string_view text_;
};

}  // namespace flightwatt::telemetry

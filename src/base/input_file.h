#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace flightwatt {

/// Size limit of a file that is read as a whole; it refuses endless files (/dev/zero, a pipe) before memory is full.
inline constexpr std::size_t max_file_bytes = 128'000'000;

/// A file that is open for reading, or a pipe that the program was started with (/dev/fd/63). Throws InputError where
/// it cannot be opened, in the system's words, and at once for folders, devices and named pipes.
class InputFile {
  public:
    explicit InputFile(const std::filesystem::path& path);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    int descriptor() const { return descriptor_; }
    const std::filesystem::path& path() const { return path_; }
    /// Of a regular file, when it was opened; 0 for pipes and devices.
    std::size_t size() const { return size_; }
    /// Throws InputError if the file is shorter now than it was then. One that grows is as good as it was.
    void require_not_truncated() const;

  private:
    std::filesystem::path path_;
    int descriptor_ = -1;
    bool is_regular_ = false;
    std::size_t size_ = 0;
};

/// The whole file. Throws InputError where it is missing, a folder, unreadable, truncated while it is read, or larger
/// than `max_bytes`, with `hint` on the latter.
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes = max_file_bytes,
                      std::string_view hint = "is it the file that was meant?");

/// Kinds of files that are taken for one another. A table may be a series or a profile.
enum class FileKind {
    unknown,
    mission,
    mechanical_model,
    battery,
    disturbances,
    specification,
    profile,
    plan,
    log,
    table,
    foreign
};

/// Kind of a file by its content, recognised also where it has errors.
FileKind kind_of_text(std::string_view text);

/// Throws InputError "is a log, not a mission", with the remedy, for the text of a file that is of another known kind.
void require_kind(std::string_view text, FileKind expected, const std::string& file);

/// Why a file cannot be opened for reading; no error where it can be. A pipe is not opened.
std::error_code open_error(const std::filesystem::path& path);

/// The folder of the running program; empty if unknown.
std::filesystem::path executable_folder();

/// A folder of files that come with the programs: that of the environment variable `variable`, or
/// ../share/flightwatt/NAME from the folder of the running program. Throws InputError "`what` are not there" where it
/// is absent.
std::filesystem::path data_folder(const std::string& name, const char* variable, const std::string& what);

}  // namespace flightwatt

#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace flightwatt::live {

/// The bytes of a file from its beginning, and those that are written to it from then on. Where the file gets shorter
/// or another takes its name, that is read from its beginning; where it is gone for a while, it is waited for.
class FileTail {
  public:
    /// `expected` says what file it should be. Throws InputError where there is no such file, or it is no regular one.
    FileTail(std::filesystem::path path, const char* expected);
    ~FileTail();
    FileTail(const FileTail&) = delete;
    FileTail& operator=(const FileTail&) = delete;

    struct Piece {
        std::string_view bytes;  ///< until the next call; none: nothing was written
        bool anew = false;       ///< the first of another file
    };
    /// What was written, waited for at most so long. Zeros at the end of it wait, too, where they are `room`: set aside
    /// for what is still to be written.
    Piece read(std::chrono::milliseconds timeout, bool zeros_are_padding = false);

    const std::filesystem::path& path() const { return path_; }

  private:
    bool open();
    void close();
    std::size_t read_more(bool zeros_are_padding);
    void reopen_if_replaced();

    std::filesystem::path path_;
    int file_ = -1;
    ::off_t offset_ = 0;
    bool anew_ = false;
    std::vector<char> bytes_;
};

}  // namespace flightwatt::live

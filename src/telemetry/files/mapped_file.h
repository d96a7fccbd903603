#pragma once

#include "base/input_file.h"

#include <cstddef>
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

}  // namespace flightwatt::telemetry

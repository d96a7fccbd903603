#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

/// Lines out of bytes as they come in, in any pieces. Memory is bounded: a line that is longer than any message is
/// dropped, and counted.
class LineBuffer {
  public:
    static constexpr std::size_t max_line = 16'384;  ///< bytes; Paparazzi's messages have at most 255

    /// Appends the lines that are whole now, without their breaks (\n or \r\n).
    void push(std::string_view bytes, std::vector<std::string>& lines);
    /// The last line, which lacks its break; empty if there is none.
    std::string take_partial_line();

    std::size_t overlong() const { return overlong_; }

  private:
    std::string rest_;
    bool dropping_ = false;
    std::size_t overlong_ = 0;
};

}  // namespace flightwatt::live

#include "live/sources/line_buffer.h"

#include <utility>

namespace flightwatt::live {

void LineBuffer::push(std::string_view bytes, std::vector<std::string>& lines) {
    while (!bytes.empty()) {
        const auto line_break = bytes.find('\n');
        const auto piece = bytes.substr(0, line_break);
        if (!dropping_ && rest_.size() + piece.size() > max_line) {
            dropping_ = true;
            ++overlong_;
            rest_.clear();
        }
        if (!dropping_) rest_ += piece;
        if (line_break == std::string_view::npos) return;
        if (!dropping_) lines.push_back(take_partial_line());
        dropping_ = false;
        bytes.remove_prefix(line_break + 1);
    }
}

std::string LineBuffer::take_partial_line() {
    auto line = std::exchange(rest_, {});
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
}

}  // namespace flightwatt::live

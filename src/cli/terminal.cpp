#include "cli/terminal.h"

#include "base/text.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

bool progress_is_hidden = false;

constexpr auto min_interval = std::chrono::milliseconds(100);
constexpr auto rate_window = std::chrono::seconds(10);

}  // namespace

std::size_t terminal_columns(std::FILE* stream) {
    constexpr std::size_t usual = 80;
    winsize size{};
    return ::ioctl(::fileno(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

std::string wrapped(const std::string& text, std::size_t columns, std::string_view indentation) {
    std::istringstream words(text);
    std::string lines;
    std::size_t used = 0;
    for (std::string word; words >> word;) {
        const auto width = character_count(word);
        if (used > 0 && used + 1 + width > columns) {
            lines += "\n";
            lines += indentation;
            used = indentation.size();
        } else if (used > 0) {
            lines += ' ';
            ++used;
        }
        lines += word;
        used += width;
    }
    return lines;
}

std::string fitted(const std::string& text, std::FILE* stream, std::size_t margin) {
    if (::isatty(::fileno(stream)) == 0) return text;
    const auto columns = std::max(terminal_columns(stream), 2 * margin) - margin;
    std::istringstream lines(text);
    std::string result;
    std::string paragraph;
    const auto end_paragraph = [&] {
        if (!paragraph.empty()) result += wrapped(paragraph, columns, "") + "\n";
        paragraph.clear();
    };
    for (std::string line; std::getline(lines, line);) {
        if (!line.empty() && line.front() != ' ') {
            paragraph += (paragraph.empty() ? "" : " ") + line;
            continue;
        }
        end_paragraph();
        result += line + "\n";
    }
    end_paragraph();
    if (!text.ends_with('\n') && !result.empty()) result.pop_back();
    return result;
}

bool is_coloured(std::FILE* stream) {
    const char* none = std::getenv("NO_COLOR");
    const char* kind = std::getenv("TERM");
    return (none == nullptr || *none == '\0') && kind != nullptr && std::string_view(kind) != "dumb" &&
           ::isatty(::fileno(stream)) != 0;
}

bool standard_output_redraws() {
    const char* kind = std::getenv("TERM");
    return ::isatty(STDOUT_FILENO) != 0 && kind != nullptr && *kind != '\0' && std::string_view(kind) != "dumb";
}

void hide_progress() { progress_is_hidden = true; }

std::FILE* standard_error_terminal() {
    const bool is_read = ::isatty(STDERR_FILENO) != 0 || std::getenv("FLIGHTWATT_PROGRESS") != nullptr;
    return is_read && !progress_is_hidden ? stderr : nullptr;
}

ProgressBar::ProgressBar(std::string unit, std::FILE* terminal)
    : terminal_(terminal), unit_(std::move(unit)), recent_{{Clock::now(), 0}} {}

ProgressBar::~ProgressBar() { hide(); }

void ProgressBar::show(std::size_t done, std::size_t all) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    if (terminal_ == nullptr || now - recent_.back().first < min_interval) return;
    recent_.emplace_back(now, done);
    while (recent_.size() > 2 && now - recent_.front().first > rate_window) recent_.pop_front();
    auto text = fmt::format("{}/{} {}", done, all, unit_);
    if (const auto before = recent_.front().second; done > before) {
        const std::chrono::duration<double> window = now - recent_.front().first;
        const auto per_one_s = window.count() / static_cast<double>(done - before);
        const auto left_s = std::ceil(per_one_s * static_cast<double>(all - std::min(done, all)));
        text += fmt::format(", {} left", duration_text(left_s));
    }
    // One column less: a full last one makes some terminals wrap.
    text.resize(std::min(text.size(), terminal_columns(terminal_) - 1));
    erase();
    std::fwrite(text.data(), 1, text.size(), terminal_);  // a closed terminal is ignored
    std::fflush(terminal_);
    drawn_width_ = text.size();
}

void ProgressBar::hide() {
    const std::lock_guard lock(mutex_);
    erase();
}

/// With blanks: every terminal knows them.
void ProgressBar::erase() {
    if (drawn_width_ > 0) {
        const auto blanks = fmt::format("\r{}\r", std::string(drawn_width_, ' '));
        std::fwrite(blanks.data(), 1, blanks.size(), terminal_);
        std::fflush(terminal_);
    }
    drawn_width_ = 0;
}

Progress ProgressBar::callback() {
    return [this](std::size_t done, std::size_t all) { show(done, all); };
}

}  // namespace flightwatt::cli

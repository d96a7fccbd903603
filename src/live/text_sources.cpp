#include "live/text_sources.h"

#include "base/error.h"
#include "base/file_use.h"
#include "live/sources/line_buffer.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace flightwatt::live {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t bytes_a_call = 65536;  // a thousand lines

/// Lines as messages, with what is no message counted.
class TextMessages {
  public:
    void push(std::string_view bytes, std::vector<IncomingMessage>& messages) {
        std::vector<std::string> lines;
        buffer_.push(bytes, lines);
        for (const auto& line : lines) add(line, messages);
        if (buffer_.overlong() > 0) report_.unusable["lines longer than any message"] = buffer_.overlong();
    }
    /// The last line, if it lacks its break.
    void finish(std::vector<IncomingMessage>& messages) { add(buffer_.take_rest(), messages); }
    void begin_anew() {
        if (!buffer_.take_rest().empty()) ++report_.unusable["lines cut off by a restart"];
        ++report_.restarts;
        restarted_ = true;
    }
    const SourceReport& report() const { return report_; }

  private:
    void add(const std::string& line, std::vector<IncomingMessage>& messages) {
        if (line.empty()) return;
        auto message = message_of_line(line);
        if (!message) {
            ++report_.unusable["lines that are no message (TIME SENDER NAME ...)"];
            return;
        }
        message->after_restart = std::exchange(restarted_, false);
        ++report_.messages;
        messages.push_back(std::move(*message));
    }

    LineBuffer buffer_;
    SourceReport report_;
    bool restarted_ = false;
};

class StandardInput : public MessageSource {
  public:
    void receive(milliseconds timeout, std::vector<IncomingMessage>& messages) override {
        pollfd wanted{STDIN_FILENO, POLLIN, 0};
        if (at_end_ || ::poll(&wanted, 1, static_cast<int>(timeout.count())) <= 0) return;
        std::vector<char> bytes(bytes_a_call);
        const auto count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
        if (count > 0) {
            text_.push({bytes.data(), static_cast<std::size_t>(count)}, messages);
        } else if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
            text_.finish(messages);
            at_end_ = true;
        }
    }
    bool at_end() const override { return at_end_; }
    std::string description() const override { return "the standard input"; }
    const SourceReport& report() const override { return text_.report(); }

  private:
    TextMessages text_;
    bool at_end_ = false;
};

class FollowedFile : public MessageSource {
  public:
    explicit FollowedFile(std::filesystem::path path) : path_(std::move(path)) {
        note_input(path_);
        if (std::filesystem::is_directory(path_) || !open()) {
            throw InputError({path_.string()},
                             std::filesystem::exists(path_) ? "cannot be read" : "there is no such file",
                             "expected the .data file that the ground station writes");
        }
        struct stat status {};
        if (::fstat(file_, &status) == 0 && !S_ISREG(status.st_mode)) {
            ::close(file_);
            throw InputError({path_.string()}, "is no regular file", "of a pipe: flightwatt watch - < PIPE");
        }
    }
    ~FollowedFile() override { close(); }

    void receive(milliseconds timeout, std::vector<IncomingMessage>& messages) override {
        constexpr milliseconds look_again{20};
        const auto until = std::chrono::steady_clock::now() + timeout;
        while (!read_more(messages)) {
            reopen_if_replaced();
            const auto left = until - std::chrono::steady_clock::now();
            if (left <= milliseconds(0)) return;
            std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(left, look_again));
        }
    }
    std::string description() const override { return "following " + path_.string(); }
    const SourceReport& report() const override { return text_.report(); }

  private:
    bool open() {
        file_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
        offset_ = 0;
        return file_ >= 0;
    }
    void close() {
        if (file_ >= 0) ::close(file_);
        file_ = -1;
    }

    bool read_more(std::vector<IncomingMessage>& messages) {
        if (file_ < 0) return false;
        struct stat status {};
        if (::fstat(file_, &status) == 0 && status.st_size < offset_) {  // it was cut and is written anew
            offset_ = 0;
            text_.begin_anew();
        }
        std::vector<char> bytes(bytes_a_call);
        const auto count = ::pread(file_, bytes.data(), bytes.size(), offset_);
        if (count <= 0) return false;
        offset_ += count;
        text_.push({bytes.data(), static_cast<std::size_t>(count)}, messages);
        return true;
    }

    void reopen_if_replaced() {
        struct stat named {};
        if (::stat(path_.c_str(), &named) != 0) return;  // gone for a while: what is open is still read
        struct stat opened {};
        const bool is_same = file_ >= 0 && ::fstat(file_, &opened) == 0 && opened.st_ino == named.st_ino &&
                             opened.st_dev == named.st_dev;
        if (is_same) return;
        close();
        if (open()) text_.begin_anew();
    }

    std::filesystem::path path_;
    int file_ = -1;
    ::off_t offset_ = 0;
    TextMessages text_;
};

}  // namespace

std::unique_ptr<MessageSource> standard_input() { return std::make_unique<StandardInput>(); }

std::unique_ptr<MessageSource> follow_data_file(const std::filesystem::path& path) {
    return std::make_unique<FollowedFile>(path);
}

}  // namespace flightwatt::live

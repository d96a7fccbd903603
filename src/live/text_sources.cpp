#include "live/text_sources.h"

#include "live/sources/followed_bytes.h"
#include "live/sources/line_buffer.h"

#include <cerrno>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <poll.h>
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
    void finish(std::vector<IncomingMessage>& messages) { add(buffer_.take_partial_line(), messages); }
    void begin_anew() {
        if (!buffer_.take_partial_line().empty()) ++report_.unusable["lines cut off by a restart"];
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
        message->is_after_restart = std::exchange(restarted_, false);
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
    explicit FollowedFile(const std::filesystem::path& path)
        : followed_(path,
                    "expected the .data file that the ground station writes; of a pipe: flightwatt watch - < PIPE") {}

    void receive(milliseconds timeout, std::vector<IncomingMessage>& messages) override {
        const auto piece = followed_.read(timeout);
        if (piece.anew) text_.begin_anew();
        text_.push(piece.bytes, messages);
    }
    std::string description() const override { return "following " + followed_.path().string(); }
    const SourceReport& report() const override { return text_.report(); }

  private:
    FileTail followed_;
    TextMessages text_;
};

}  // namespace

std::unique_ptr<MessageSource> standard_input() { return std::make_unique<StandardInput>(); }

std::unique_ptr<MessageSource> follow_data_file(const std::filesystem::path& path) {
    return std::make_unique<FollowedFile>(path);
}

}  // namespace flightwatt::live

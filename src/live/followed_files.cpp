#include "live/followed_files.h"

#include "base/error.h"
#include "base/overwrite_guard.h"
#include "flight/telemetry_series.h"
#include "live/sources/message_readers.h"

#include <algorithm>
#include <cerrno>
#include <thread>
#include <type_traits>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace flightwatt::live {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t bytes_per_read = 16'384;  // fewer messages than MessageQueue::max_per_call

/// Reads a file from its beginning while it grows. If the file is truncated or replaced, reading restarts at its
/// beginning; while it is missing, read() waits.
class FileTail {
  public:
    /// `expected` describes the file in errors. Throws InputError where it is missing or not a regular file.
    FileTail(std::filesystem::path path, const char* expected) : path_(std::move(path)), bytes_(bytes_per_read) {
        register_input(path_);
        if (std::filesystem::is_directory(path_) || !open()) {
            throw InputError({path_.string()},
                             std::filesystem::exists(path_) ? "cannot be read" : "there is no such file", expected);
        }
        struct stat status {};
        if (::fstat(file_, &status) == 0 && S_ISREG(status.st_mode)) return;
        close();
        throw InputError({path_.string()}, "is not a regular file", expected);
    }
    ~FileTail() { close(); }
    FileTail(const FileTail&) = delete;
    FileTail& operator=(const FileTail&) = delete;

    struct Chunk {
        std::string_view bytes;    ///< valid until the next call; empty: nothing was written
        bool is_new_file = false;  ///< the first bytes after truncation or replacement
    };
    /// Returns appended bytes, waiting up to `timeout`. Where `zeros_are_padding`, zeros at the end of the file are
    /// preallocated space and are not returned.
    Chunk read(milliseconds timeout, bool zeros_are_padding) {
        using Clock = std::chrono::steady_clock;
        constexpr milliseconds poll_interval{20};
        const auto until = Clock::now() + timeout;
        for (;;) {
            if (const auto count = read_more(zeros_are_padding); count > 0)
                return {{bytes_.data(), count}, std::exchange(is_new_file_, false)};
            if (reopen_if_replaced()) continue;
            const auto left = until - Clock::now();
            if (left <= Clock::duration::zero()) return {};
            std::this_thread::sleep_for(std::min<Clock::duration>(left, poll_interval));
        }
    }

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

    std::size_t read_more(bool zeros_are_padding) {
        if (file_ < 0) return 0;
        struct stat status {};
        if (::fstat(file_, &status) == 0 && status.st_size < offset_) {  // truncated
            offset_ = 0;
            is_new_file_ = true;
        }
        const auto count = ::pread(file_, bytes_.data(), bytes_.size(), offset_);
        if (count <= 0) return 0;
        auto written = static_cast<std::size_t>(count);
        while (zeros_are_padding && written > 0 && bytes_[written - 1] == '\0') --written;
        offset_ += static_cast<::off_t>(written);
        return written;
    }

    /// True if another file has the name now; it is open and unread.
    bool reopen_if_replaced() {
        struct stat named {};
        if (::stat(path_.c_str(), &named) != 0) return false;  // missing: the open file is still read
        struct stat opened {};
        const bool is_same = file_ >= 0 && ::fstat(file_, &opened) == 0 && opened.st_ino == named.st_ino &&
                             opened.st_dev == named.st_dev;
        if (is_same) return false;
        close();
        is_new_file_ = open();
        return is_new_file_;
    }

    std::filesystem::path path_;
    int file_ = -1;
    ::off_t offset_ = 0;
    bool is_new_file_ = false;
    std::vector<char> bytes_;
};

class StandardInput : public MessageSource {
  public:
    void receive(milliseconds timeout, std::vector<IncomingMessage>& messages) override {
        pollfd wanted{STDIN_FILENO, POLLIN, 0};
        if (at_end_ || ::poll(&wanted, 1, static_cast<int>(timeout.count())) <= 0) return;
        std::vector<char> bytes(bytes_per_read);
        const auto count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
        if (count > 0) {
            reader_.push({bytes.data(), static_cast<std::size_t>(count)});
        } else if (count == 0 || (errno != EINTR && errno != EAGAIN)) {
            reader_.flush();
            at_end_ = true;
        }
        queue_.take(milliseconds(0), messages, report_);
    }
    bool at_end() const override { return at_end_; }
    const SourceReport& report() const override { return report_; }

  private:
    MessageQueue queue_{1.0};
    SourceReport report_;
    TextReader reader_{queue_};
    bool at_end_ = false;
};

template <typename Reader>
class FollowedFile : public MessageSource {
  public:
    template <typename... Arguments>
    FollowedFile(const std::filesystem::path& path, const char* expected, Arguments... arguments)
        : tail_(path, expected), reader_(queue_, std::move(arguments)...) {}

    void receive(milliseconds timeout, std::vector<IncomingMessage>& messages) override {
        constexpr bool is_binary = std::is_same_v<Reader, LinkReader>;  // cards preallocate such files
        const auto chunk = tail_.read(timeout, is_binary);
        if (chunk.is_new_file) {
            reader_.restart();
            queue_.count_restart();
        }
        reader_.push(chunk.bytes);
        queue_.take(milliseconds(0), messages, report_);
    }
    const SourceReport& report() const override { return report_; }

  private:
    FileTail tail_;
    MessageQueue queue_{1.0};
    SourceReport report_;
    Reader reader_;
};

}  // namespace

std::unique_ptr<MessageSource> open_standard_input() { return std::make_unique<StandardInput>(); }

std::unique_ptr<MessageSource> follow_data_file(const std::filesystem::path& path) {
    return std::make_unique<FollowedFile<TextReader>>(
        path, "expected the .data file that the ground station writes; for a pipe: flightwatt watch - < PIPE");
}

std::unique_ptr<MessageSource> follow_tlog(const std::filesystem::path& path) {
    return std::make_unique<FollowedFile<MavlinkReader>>(
        path, "expected the .tlog that a ground station writes",
        std::make_shared<telemetry::MavlinkVehicles>(flight::mavlink_flight_messages()), true);
}

std::unique_ptr<MessageSource> follow_binary_log(const std::filesystem::path& path,
                                                 telemetry::MessageDictionary definitions) {
    return std::make_unique<FollowedFile<LinkReader>>(
        path, "expected the log that an autopilot or a modem's program writes",
        std::make_shared<const telemetry::MessageDictionary>(std::move(definitions)));
}

}  // namespace flightwatt::live

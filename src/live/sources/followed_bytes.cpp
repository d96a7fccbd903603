#include "live/sources/followed_bytes.h"

#include "base/error.h"
#include "base/overwrite_guard.h"

#include <algorithm>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace flightwatt::live {
namespace {

constexpr std::size_t max_bytes_a_piece = 65'536;  // a thousand messages

}  // namespace

FileTail::FileTail(std::filesystem::path path, const char* expected)
    : path_(std::move(path)), bytes_(max_bytes_a_piece) {
    register_input(path_);
    if (std::filesystem::is_directory(path_) || !open()) {
        throw InputError({path_.string()}, std::filesystem::exists(path_) ? "cannot be read" : "there is no such file",
                         expected);
    }
    struct stat status {};
    if (::fstat(file_, &status) == 0 && S_ISREG(status.st_mode)) return;
    close();
    throw InputError({path_.string()}, "is no regular file", expected);
}

FileTail::~FileTail() { close(); }

bool FileTail::open() {
    file_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    offset_ = 0;
    return file_ >= 0;
}

void FileTail::close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
}

FileTail::Piece FileTail::read(std::chrono::milliseconds timeout, bool zeros_are_padding) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds look_again{20};
    const auto until = Clock::now() + timeout;
    for (;;) {
        if (const auto count = read_more(zeros_are_padding); count > 0)
            return {{bytes_.data(), count}, std::exchange(anew_, false)};
        reopen_if_replaced();
        const auto left = until - Clock::now();
        if (left <= Clock::duration::zero()) return {};
        std::this_thread::sleep_for(std::min<Clock::duration>(left, look_again));
    }
}

std::size_t FileTail::read_more(bool zeros_are_padding) {
    if (file_ < 0) return 0;
    struct stat status {};
    if (::fstat(file_, &status) == 0 && status.st_size < offset_) {  // it was cut and is written anew
        offset_ = 0;
        anew_ = true;
    }
    const auto count = ::pread(file_, bytes_.data(), bytes_.size(), offset_);
    if (count <= 0) return 0;
    auto written = static_cast<std::size_t>(count);
    while (zeros_are_padding && written > 0 && bytes_[written - 1] == '\0') --written;
    offset_ += static_cast<::off_t>(written);
    return written;
}

void FileTail::reopen_if_replaced() {
    struct stat named {};
    if (::stat(path_.c_str(), &named) != 0) return;  // gone for a while: what is open is still read
    struct stat opened {};
    const bool is_same =
        file_ >= 0 && ::fstat(file_, &opened) == 0 && opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
    if (is_same) return;
    close();
    if (open()) anew_ = true;
}

}  // namespace flightwatt::live

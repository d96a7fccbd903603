#include "live/recorder.h"

#include "base/atomic_file.h"
#include "base/error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

namespace flightwatt::live {

namespace {

/// Creates an empty file; false if it exists. Throws OutputError.
bool make_new_file(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno == EEXIST) return false;
    if (file < 0) throw OutputError(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
    ::close(file);
    return true;
}

}  // namespace

Recorder::Recorder(std::filesystem::path folder, std::string name, std::optional<std::string> log_text,
                   std::string ending)
    : folder_(std::move(folder)), name_(std::move(name)), log_text_(std::move(log_text)), ending_(std::move(ending)) {
    make_directories(folder_);
}

void Recorder::open_next() {
    constexpr std::size_t max_files = 10'000;
    while (++number_ < max_files) {
        const auto stem = number_ == 1 ? name_ : fmt::format("{}_{}", name_, number_);
        const auto data = folder_ / (stem + ending_);
        const auto log = folder_ / (stem + ".log");
        if (std::filesystem::exists(log) || !make_new_file(data)) continue;
        if (log_text_) write_file_atomically(log, *log_text_);
        out_ = std::ofstream(data, std::ios::app | std::ios::binary);
        file_ = data;
        return;
    }
    throw OutputError(fmt::format("{} holds {} logs of this name", folder_.string(), max_files));
}

void Recorder::write(std::string_view lines, bool clock_restarted) {
    if (!failure_.empty()) return;
    try {
        if (clock_restarted || file_.empty()) open_next();
        out_.write(lines.data(), static_cast<std::streamsize>(lines.size()));
        out_.flush();
        if (!out_) throw OutputError(fmt::format("cannot write {}: {}", file_.string(), std::strerror(errno)));
    } catch (const OutputError& error) {
        failure_ = error.what();
    }
}

double recording_start_unix_s(double now_unix_s) {
    constexpr double first_unix_s = 978'307'200.0;  // 2001-01-01
    return std::max(now_unix_s, first_unix_s);
}

std::string log_name(std::int64_t unix_s) {
    return fmt::format("{:%y_%m_%d__%H_%M_%S}", fmt::gmtime(static_cast<std::time_t>(unix_s)));
}

}  // namespace flightwatt::live

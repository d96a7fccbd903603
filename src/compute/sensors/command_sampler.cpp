#include "base/number.h"
#include "compute/power_sampler.h"
#include "compute/processes/supervised_processes.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <termios.h>
#include <unistd.h>

namespace flightwatt::compute {
namespace {

using Clock = std::chrono::steady_clock;

/// A pseudo terminal without echo and translations: programs that print through stdio flush each line into it, into a
/// pipe only each block. `ends`: ours, the program's. Returns false with errno without one.
bool open_terminal(int (&ends)[2]) {
    std::array<char, 128> name{};
    ends[0] = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (ends[0] < 0 || ::grantpt(ends[0]) != 0 || ::unlockpt(ends[0]) != 0 ||
        ::ptsname_r(ends[0], name.data(), name.size()) != 0)
        return false;
    ends[1] = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    ::termios settings{};
    if (ends[1] < 0 || ::tcgetattr(ends[1], &settings) != 0) return false;
    ::cfmakeraw(&settings);
    return ::tcsetattr(ends[1], TCSANOW, &settings) == 0 && ::fcntl(ends[0], F_SETFL, O_NONBLOCK) == 0;
}

class CommandSampler {
  public:
    explicit CommandSampler(const SamplerSettings& settings)
        : command_(settings.command), folder_(settings.folder), interval_s_(settings.interval_s) {
        start();
    }
    ~CommandSampler() { stop(); }
    CommandSampler(const CommandSampler&) = delete;
    CommandSampler& operator=(const CommandSampler&) = delete;

    int file() const { return output_; }

    std::vector<PowerReading> read() {
        std::vector<PowerReading> readings;
        take_output(readings);
        const auto ended = running_ ? running_->ended() : std::vector<FinishedCommand>();
        if (!ended.empty()) {
            take_output(readings);  // its last output
            require_success(ended.front());
            stop();
        }
        const double since_start_s = std::chrono::duration<double>(Clock::now() - started_).count();
        if (!running_ && since_start_s >= interval_s_) start();
        return readings;
    }

  private:
    std::string name() const { return fmt::format("{}", fmt::join(command_, " ")); }

    void start() {
        int ends[2] = {-1, -1};
        if (!open_terminal(ends)) {
            throw OutputError(fmt::format("cannot make a pseudo terminal: {}", std::strerror(errno)));
        }
        output_ = ends[0];
        started_ = Clock::now();
        lines_ = 0;
        pending_.clear();
        constexpr std::chrono::milliseconds patience(500);  // no cleanup to wait for
        running_.emplace(std::vector<std::vector<std::string>>{command_},
                         SupervisionOptions{ends[1], STDERR_FILENO, patience, folder_, false});
        ::close(ends[1]);
    }

    void stop() {
        running_.reset();
        if (output_ >= 0) ::close(output_);
        output_ = -1;
    }

    void require_success(const FinishedCommand& ended) const {
        if (ended.start_error == 0 && ended.wait_status == 0 && lines_ > 0) return;
        throw NoResultError(
            fmt::format("the sampler '{}' {}{}", name(), ended.start_error == 0 ? "ended: " : "", to_string(ended)) +
            (lines_ == 0 ? ", without a reading" : ""));
    }

    void take_output(std::vector<PowerReading>& readings) {
        if (output_ < 0) return;
        std::array<char, 4096> buffer;
        while (true) {
            const auto count = ::read(output_, buffer.data(), buffer.size());
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) return;
            pending_.append(buffer.data(), static_cast<std::size_t>(count));
            take_lines(readings);
            constexpr std::size_t max_line = 4096;
            if (pending_.size() <= max_line) continue;
            throw InputError({name(), lines_ + 1}, "the sampler prints no line ends, expected watts, a number a line");
        }
    }

    void take_lines(std::vector<PowerReading>& readings) {
        for (auto end = pending_.find('\n'); end != std::string::npos; end = pending_.find('\n')) {
            auto line = pending_.substr(0, end);
            pending_.erase(0, end + 1);
            line.erase(0, line.find_first_not_of(" \t"));
            line.erase(line.find_last_not_of(" \t\r") + 1);
            const auto power_w = parse_number(line);
            if (!power_w) {
                throw InputError({name(), lines_ + 1},
                                 fmt::format("the sampler printed '{}', expected watts, a number a line", line));
            }
            ++lines_;
            readings.push_back({Clock::now(), *power_w});
        }
    }

    std::vector<std::string> command_;
    std::filesystem::path folder_;
    double interval_s_;
    std::optional<SupervisedProcesses> running_;
    int output_ = -1;
    Clock::time_point started_;
    std::string pending_;    ///< an incomplete line
    std::size_t lines_ = 0;  ///< since the start
};

}  // namespace

PowerSampler open_command_sampler(const SamplerSettings& settings) {
    auto meter = std::make_shared<CommandSampler>(settings);
    PowerSampler sampler;
    sampler.kind = SamplerKind::command;
    sampler.source = fmt::format("{}", fmt::join(settings.command, " "));
    sampler.read = [meter] { return meter->read(); };
    sampler.file = [meter] { return meter->file(); };
    return sampler;
}

}  // namespace flightwatt::compute

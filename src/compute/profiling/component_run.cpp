#include "compute/profiling/component_run.h"

#include "base/error.h"
#include "base/overwrite_guard.h"
#include "compute/processes/supervised_processes.h"
#include "compute/sensors/power_trace.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

namespace flightwatt::compute {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

Clock::duration ticks(double time_s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_s));
}

/// Output file of the commands, removed if empty.
class OutputFile {
  public:
    explicit OutputFile(const std::filesystem::path& path) : path_(path) {
        if (path.empty()) return;
        check_overwrite(path);
        file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        if (file_ < 0) {
            throw OutputError(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
        }
    }
    ~OutputFile() {
        if (file_ < 0) return;
        ::close(file_);
        std::error_code ignored;
        if (std::filesystem::file_size(path_, ignored) == 0) std::filesystem::remove(path_, ignored);
    }
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    int file() const { return file_; }

  private:
    std::filesystem::path path_;
    int file_ = -1;
};

/// Samples power until the run is over.
class Watch {
  public:
    Watch(Clock::time_point start, SupervisedProcesses* processes, const ProfileTiming& timing, const RunContext& frame)
        : processes_(processes), timing_(timing), frame_(frame), start_(start), next_(start_) {
        frame_.sampler->read();  // discards earlier readings
    }

    ComponentRun run() {
        while (!over_at_ && Clock::now() < limit()) {
            wait();
            take_ends();
            take_readings();
        }
        finish();
        return std::move(run_);
    }

  private:
    Clock::time_point limit() const {
        return start_ + ticks(timing_.duration_s ? timing_.warm_up_s + *timing_.duration_s : timing_.timeout_s);
    }

    Clock::time_point end() const { return std::min(over_at_.value_or(limit()), limit()); }

    void wait() {
        const auto until = std::min(next_, limit());
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
        pollfd files[3] = {{frame_.signals, POLLIN, 0},
                           {frame_.sampler->file(), POLLIN, 0},
                           {processes_ == nullptr ? -1 : processes_->poll_fd(), POLLIN, 0}};
        const auto wait_ms = std::clamp<long>(static_cast<long>(left.count()), 0, 60000);
        if (::poll(files, 3, static_cast<int>(wait_ms)) <= 0) return;
        if (files[0].revents != 0) throw Interrupted(frame_.received_signal());
    }

    void take_ends() {
        if (processes_ == nullptr || over_at_) return;
        for (const auto& ended : processes_->ended()) {
            if (ended.start_error == 0 && ended.time > limit()) return;
            if (!over_at_) over_at_ = ended.time;
            if (ended.start_error != 0) {
                run_.status = RunStatus::not_started;
                run_.note = to_string(ended);
                return;
            }
            if (ended.wait_status != 0 && run_.note.empty()) run_.note = to_string(ended);
        }
    }

    void take_readings() {
        // A sensor is polled on a fixed time grid; missed points are skipped.
        const bool is_polled = frame_.sampler->file() < 0;
        if (is_polled && Clock::now() < next_) return;
        while (next_ <= Clock::now()) next_ += ticks(frame_.interval_s);
        for (const auto& reading : frame_.sampler->read()) {
            const double time_s = seconds(reading.time - start_);
            if (time_s < timing_.warm_up_s || reading.time > end()) continue;
            if (!run_.trace.time_s.empty() && time_s <= run_.trace.time_s.back()) continue;
            run_.trace.add(time_s, reading.power_w);
        }
    }

    void finish() {
        take_ends();  // on a busy machine, starting may take longer than the run
        if (run_.status == RunStatus::not_started) return;
        run_.duration_s = std::max(0.0, seconds(end() - start_) - timing_.warm_up_s);
        const bool ended_first = over_at_ && *over_at_ < limit();
        if (!run_.note.empty()) {
            run_.status = RunStatus::failed;
        } else if (ended_first && timing_.duration_s) {
            run_.status = RunStatus::ended_early;
            run_.note = fmt::format("ended after {:.2f} s", seconds(*over_at_ - start_));
        } else if (!ended_first && !timing_.duration_s) {
            run_.status = RunStatus::timed_out;
            run_.note = fmt::format("still ran after {} s", timing_.timeout_s);
        } else {
            run_.status = run_.trace.time_s.empty() ? RunStatus::no_samples : RunStatus::ok;
        }
        if (run_.status == RunStatus::no_samples) run_.note = "ended before the first sample";
    }

    SupervisedProcesses* processes_;
    const ProfileTiming& timing_;
    const RunContext& frame_;
    Clock::time_point start_;
    Clock::time_point next_;                    ///< when the sensor is polled
    std::optional<Clock::time_point> over_at_;  ///< when the first command ended
    ComponentRun run_;
};

void note(ComponentRun& run, const std::string& text) { run.note += (run.note.empty() ? "" : "; ") + text; }

void note_ending(const ShutdownReport& report, bool ended_by_itself, ComponentRun& run) {
    if (ended_by_itself && report.left_processes) note(run, "left processes behind, ended");
    if (report.killed) note(run, "did not end by SIGTERM, killed");
}

}  // namespace

std::string_view to_string(RunStatus status) {
    constexpr std::array<std::string_view, 6> names{"failed",      "ended_early", "timed_out",
                                                    "not_started", "no_samples",  "ok"};
    return names[static_cast<std::size_t>(status)];
}

ComponentRun run_component(const std::vector<std::vector<std::string>>& commands, const ProfileTiming& timing,
                           const RunContext& frame) {
    if (commands.empty()) return Watch(Clock::now(), nullptr, timing, frame).run();
    const OutputFile output(frame.output);
    const auto patience = std::chrono::duration_cast<std::chrono::milliseconds>(ticks(frame.kill_timeout_s));
    const auto start = Clock::now();  // before starting the commands: a delay does not shorten their run
    SupervisedProcesses processes(commands, {output.file(), output.file(), patience, frame.folder});
    auto run = Watch(start, &processes, timing, frame).run();
    const bool by_itself = run.status != RunStatus::timed_out && (run.status != RunStatus::ok || !timing.duration_s);
    note_ending(processes.end(), by_itself, run);
    return run;
}

ComponentRun run_of_recording(const PowerTrace& recording, const ProfileTiming& timing, double interval_s) {
    ComponentRun run;
    const double first_s = recording.time_s.front();
    const double limit_s =
        timing.duration_s ? timing.warm_up_s + *timing.duration_s : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < recording.time_s.size(); ++i) {
        const double time_s = recording.time_s[i] - first_s;
        if (time_s < timing.warm_up_s || time_s > limit_s) continue;
        run.trace.add(time_s, recording.power_w[i]);
    }
    run.status = run.trace.time_s.empty() ? RunStatus::no_samples : RunStatus::ok;
    if (run.status == RunStatus::no_samples) {
        run.note = "the recording ends within the warm-up";
        return run;
    }
    // Each sample counts for an interval, also the first.
    const double mean_s = run.trace.time_s.size() > 1 ? jitter_of({run.trace}).mean_s : interval_s;
    run.duration_s = run.trace.time_s.back() - run.trace.time_s.front() + mean_s;
    if (timing.duration_s && run.duration_s + mean_s < *timing.duration_s) {
        run.status = RunStatus::ended_early;
        run.note = fmt::format("the recording has {:.2f} s after the warm-up", run.duration_s);
    }
    return run;
}

}  // namespace flightwatt::compute

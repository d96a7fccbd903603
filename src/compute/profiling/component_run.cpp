#include "compute/profiling/component_run.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/overwrite_guard.h"
#include "compute/processes/supervised_processes.h"
#include "compute/sensors/power_trace.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

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

/// What the commands print, through a pipe, in a file: its first and its last kept_output_bytes, so that no program
/// fills the disk. No file if nothing was printed.
class KeptOutput {
  public:
    explicit KeptOutput(const std::filesystem::path& path) : path_(path) {
        if (path.empty()) return;
        check_overwrite(path);
        std::error_code none;
        std::filesystem::remove(path, none);  // of an earlier call
        int ends[2] = {-1, -1};
        if (::pipe2(ends, O_CLOEXEC) != 0) {
            throw OutputError(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
        }
        pipe_ = ends[0];
        commands_end_ = ends[1];
        ::fcntl(pipe_, F_SETFL, O_NONBLOCK);
    }
    ~KeptOutput() {
        close_commands_end();
        if (pipe_ >= 0) ::close(pipe_);
    }
    KeptOutput(const KeptOutput&) = delete;
    KeptOutput& operator=(const KeptOutput&) = delete;

    /// Readable when the commands have printed; -1 when none of them can any more.
    int file() const { return pipe_; }
    int commands_end() const { return commands_end_; }
    void close_commands_end() {
        if (commands_end_ >= 0) ::close(std::exchange(commands_end_, -1));
    }

    /// Takes what waits, at most what a pipe holds: a program that prints without end must not keep a run from ending.
    void take() {
        std::array<char, 65536> buffer;
        const auto count = pipe_ < 0 ? -1 : ::read(pipe_, buffer.data(), buffer.size());
        if (count == 0) ::close(std::exchange(pipe_, -1));
        if (count > 0) text_.append(buffer.data(), static_cast<std::size_t>(count));
        if (text_.size() > 8 * kept_output_bytes) leave_out();
    }

    void write() {
        take();
        if (text_.empty()) return;
        leave_out();
        if (left_out_ > 0) text_.insert(kept_output_bytes, fmt::format("\n[{} bytes are left out here]\n", left_out_));
        write_file_atomically(path_, text_);
    }

  private:
    void leave_out() {
        if (text_.size() <= 2 * kept_output_bytes) return;
        const auto middle = text_.size() - 2 * kept_output_bytes;
        text_.erase(kept_output_bytes, middle);
        left_out_ += middle;
    }

    std::filesystem::path path_;
    int pipe_ = -1;
    int commands_end_ = -1;
    std::string text_;
    std::size_t left_out_ = 0;  ///< bytes, after the first kept_output_bytes of the text
};

/// Samples power until the run is over.
class Watch {
  public:
    Watch(Clock::time_point start, SupervisedProcesses* processes, KeptOutput& output, const ProfileTiming& timing,
          const RunContext& frame)
        : processes_(processes),
          output_(output),
          timing_(timing),
          frame_(frame),
          start_(start),
          next_(start_),
          limit_(start + ticks(timing.duration_s ? timing.warm_up_s + *timing.duration_s : timing.timeout_s)) {
        frame_.sampler->read();  // discards earlier readings
    }

    ComponentRun run() {
        while (!over_at_ && (Clock::now() < limit_ || awaits_sample())) {
            wait();
            take_ends();
            take_readings();
        }
        finish();
        return std::move(run_);
    }

  private:
    /// Whether a run of a given duration had no sample yet: it is prolonged up to its first one, as on a busy machine a
    /// short run may be over before that.
    bool awaits_sample() const {
        constexpr double patience_s = 10.0;
        return timing_.duration_s && run_.trace.time_s.empty() && Clock::now() < limit_ + ticks(patience_s);
    }

    Clock::time_point end() const { return std::min(over_at_.value_or(limit_), limit_); }

    void wait() {
        const auto until = Clock::now() < limit_ ? std::min(next_, limit_) : next_;
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
        pollfd files[4] = {{frame_.signals, POLLIN, 0},
                           {frame_.sampler->file(), POLLIN, 0},
                           {output_.file(), POLLIN, 0},
                           {processes_ == nullptr ? -1 : processes_->poll_fd(), POLLIN, 0}};
        const auto wait_ms = std::clamp<long>(static_cast<long>(left.count()), 0, 60000);
        if (::poll(files, 4, static_cast<int>(wait_ms)) <= 0) return;
        if (files[0].revents != 0) throw Interrupted(frame_.received_signal());
        output_.take();
    }

    void take_ends() {
        if (processes_ == nullptr || over_at_) return;
        for (const auto& ended : processes_->ended()) {
            if (ended.start_error == 0 && ended.time > limit_ && !run_.trace.time_s.empty()) return;
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
        const auto before = run_.trace.time_s.size();
        for (const auto& reading : frame_.sampler->read()) {
            const double time_s = seconds(reading.time - start_);
            if (time_s < timing_.warm_up_s) continue;
            if (awaits_sample()) limit_ = std::max(limit_, reading.time);
            if (reading.time > end()) continue;
            if (!run_.trace.time_s.empty() && time_s <= run_.trace.time_s.back()) continue;
            run_.trace.add(time_s, reading.power_w);
        }
        if (run_.trace.time_s.size() > before) ++arrivals_;
    }

    void finish() {
        take_ends();  // on a busy machine, starting may take longer than the run
        if (run_.status == RunStatus::not_started) return;
        run_.duration_s = std::max(0.0, seconds(end() - start_) - timing_.warm_up_s);
        const bool ended_first = over_at_ && *over_at_ < limit_;
        if (!run_.note.empty()) {
            run_.status = RunStatus::failed;
        } else if (ended_first && timing_.duration_s) {
            run_.status = RunStatus::ended_early;
            run_.note = fmt::format("ended after {:.2f} s", seconds(*over_at_ - start_));
        } else if (!ended_first && !timing_.duration_s) {
            run_.status = RunStatus::timed_out;
            run_.note = fmt::format("still ran after {} s", timing_.timeout_s);
        } else if (run_.trace.time_s.empty()) {
            run_.status = RunStatus::no_samples;
            run_.note = "ended before the first sample: does the sampler print each at once?";
        } else if (come_in_bursts(run_.trace.time_s.size(), arrivals_)) {
            run_.note =
                fmt::format("{} samples came in {} bursts: the sampler must print each at once (flush, or stdbuf -oL)",
                            run_.trace.time_s.size(), arrivals_);
        } else {
            run_.status = RunStatus::ok;
        }
    }

    SupervisedProcesses* processes_;
    KeptOutput& output_;
    const ProfileTiming& timing_;
    const RunContext& frame_;
    Clock::time_point start_;
    Clock::time_point next_;                    ///< when the sensor is polled
    Clock::time_point limit_;                   ///< when the run is over at the latest
    std::optional<Clock::time_point> over_at_;  ///< when the first command ended
    std::size_t arrivals_ = 0;                  ///< calls of the sampler that gave samples
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

bool come_in_bursts(std::size_t samples, std::size_t arrivals) {
    constexpr std::size_t many_at_once = 32;   // stdio's buffers hold 200 lines or more; fewer wait for a busy machine
    constexpr std::size_t many_arrivals = 20;  // a block, a twentieth of the run, changes the mean little
    return samples >= many_at_once * arrivals && arrivals < many_arrivals;
}

ComponentRun run_component(const std::vector<std::vector<std::string>>& commands, const ProfileTiming& timing,
                           const RunContext& frame) {
    KeptOutput output(commands.empty() ? std::filesystem::path() : frame.output);
    if (commands.empty()) return Watch(Clock::now(), nullptr, output, timing, frame).run();
    const auto patience = std::chrono::duration_cast<std::chrono::milliseconds>(ticks(frame.kill_timeout_s));
    const auto start = Clock::now();  // before starting the commands: a delay does not shorten their run
    SupervisedProcesses processes(commands, {output.commands_end(), output.commands_end(), patience, frame.folder});
    output.close_commands_end();
    auto run = Watch(start, &processes, output, timing, frame).run();
    const bool by_itself = run.status != RunStatus::timed_out && (run.status != RunStatus::ok || !timing.duration_s);
    const auto report = processes.end([&] { output.take(); });
    output.write();
    if (!report.survivor.empty()) {
        throw NoResultError(
            fmt::format("{} of {} cannot be ended: its power would count for the later runs; end it, then "
                        "the same command continues",
                        report.survivor, commands.front().front()));
    }
    note_ending(report, by_itself, run);
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

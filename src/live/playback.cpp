#include "live/playback.h"

#include "base/error.h"
#include "live/source.h"
#include "telemetry/data_file.h"

#include <algorithm>
#include <thread>

namespace flightwatt::live {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::chrono::milliseconds longest_wait{50};  // until somebody asks whether to stop
constexpr char card_frame = '\x99';

/// Waits in short steps; false: it was stopped.
bool wait_for(Clock::time_point then, PlaybackTarget& target, const std::function<bool()>& stop) {
    for (;;) {
        if (stop()) return false;
        const auto now = Clock::now();
        if (now >= then) return true;
        target.wait_until(std::min(then, now + longest_wait));
    }
}

/// When a message is due: [s] of the log's time since its first.
class LogClock {
  public:
    /// Returns the time since the first message that it was told of.
    double advance_to(double time_s, PlaybackReport& report) {
        const double step_s = last_s_ ? std::max(0.0, time_s - *last_s_) : 0.0;
        if (step_s > longest_played_gap_s) ++report.shortened_gaps;
        report.log_s += std::min(step_s, longest_played_gap_s);
        last_s_ = time_s;
        return report.log_s;
    }

  private:
    std::optional<double> last_s_;
};

void send(PlaybackTarget& target, const IncomingMessage& message, PlaybackReport& report) {
    const auto why_not = target.send(*message.time_s, message.text);
    if (why_not.empty()) {
        ++report.messages;
    } else {
        ++report.left_out[std::string(why_not)];
    }
}

/// What was sent gets out, if it is fetched.
void drain(PlaybackTarget& target, const std::function<bool()>& stop) {
    constexpr std::chrono::seconds longest{10};
    const auto end = Clock::now() + longest;
    while (!target.is_idle() && Clock::now() < end && !stop()) target.wait_until(Clock::now() + longest_wait);
}

}  // namespace

void PlaybackTarget::wait_until(Clock::time_point then) { std::this_thread::sleep_until(then); }

PlaybackReport play(const std::filesystem::path& log, double speed, PlaybackTarget& target,
                    const std::function<bool()>& stop) {
    const telemetry::DataFile file(log);
    if (file.text().starts_with(card_frame)) {
        throw InputError({log.string()}, "it is a binary log, and text is played",
                         "flightwatt convert " + log.string() + " -o NAME.data writes the text");
    }
    PlaybackReport report;
    LogClock clock;
    const auto begin = Clock::now();
    for (auto rest = file.text(); !rest.empty() && !report.stopped;) {
        auto line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        const auto message = message_of_line(line);
        if (!message) {
            ++report.left_out["they are no messages with a time"];
            continue;
        }
        const auto due = begin + std::chrono::duration_cast<Clock::duration>(
                                     Seconds(clock.advance_to(*message->time_s, report) / speed));
        report.stopped = !wait_for(due, target, stop);
        if (report.stopped) break;
        report.latest_s = std::max(report.latest_s, Seconds(Clock::now() - due).count());
        send(target, *message, report);
    }
    file.require_unchanged();
    drain(target, stop);
    report.played_s = Seconds(Clock::now() - begin).count();
    return report;
}

}  // namespace flightwatt::live

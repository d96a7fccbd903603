#include "live/state/clock_filter.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace flightwatt::live {

bool ClockFilter::push(IncomingMessage message, std::vector<IncomingMessage>& accepted) {
    const double time_s = *message.time_s += offset_s_;
    if (started_ && std::abs(time_s - latest_s_) > max_off_s) return hold(std::move(message), accepted);
    unconfirmed_ += held_.size();
    held_.clear();
    latest_s_ = started_ ? std::max(latest_s_, time_s) : time_s;
    started_ = true;
    accepted.push_back(std::move(message));
    return false;
}

bool ClockFilter::hold(IncomingMessage message, std::vector<IncomingMessage>& accepted) {
    if (!held_.empty() && std::abs(*message.time_s - *held_.back().time_s) > max_step_s) {
        unconfirmed_ += held_.size();
        held_.clear();
    }
    held_.push_back(std::move(message));
    if (held_.size() < min_confirmations) return false;
    const double step_s = *held_.front().time_s - latest_s_;
    const bool restarted = step_s < -max_step_s || step_s > max_gap_s;
    const double back_s = restarted ? offset_s_ : std::min(step_s, 0.0);
    if (!restarted && step_s < 0.0) ++steps_back_;
    offset_s_ -= back_s;
    for (auto& held : held_) *held.time_s -= back_s;
    latest_s_ = std::ranges::max(held_, {}, &IncomingMessage::time_s).time_s.value();
    std::ranges::move(std::exchange(held_, {}), std::back_inserter(accepted));
    return restarted;
}

void ClockFilter::flush(std::vector<IncomingMessage>& accepted) {
    for (auto& held : std::exchange(held_, {})) {
        if (*held.time_s < latest_s_) {
            ++unconfirmed_;
            continue;
        }
        latest_s_ = *held.time_s;
        accepted.push_back(std::move(held));
    }
}

}  // namespace flightwatt::live

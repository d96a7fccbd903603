#include "live/state/clock_filter.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::live {

bool ClockFilter::push(Line line, std::vector<Line>& accepted) {
    line.time_s += offset_s_;
    const double ahead_s = line.time_s - latest_s_;
    if (started_ && (ahead_s > max_ahead_s || ahead_s < -max_step_s)) return hold(std::move(line), accepted);
    unconfirmed_ += held_.size();
    held_.clear();
    handle_recovery(line);
    if (!started_ || is_guess_ || line.time_s > latest_s_ + late_s) near_latest_ = 0;
    latest_s_ = started_ && !is_guess_ ? std::max(latest_s_, line.time_s) : line.time_s;
    started_ = true;
    is_guess_ = false;
    handle_late_line(line);
    accept_line(std::move(line), accepted);
    return false;
}

void ClockFilter::accept_line(Line line, std::vector<Line>& accepted) {
    if (line.arrival_s) pace_.add(line.time_s, *line.arrival_s);
    accepted.push_back(std::move(line));
}

void ClockFilter::handle_late_line(Line& line) {
    const bool is_late = line.time_s < latest_s_ - late_s;
    late_ = is_late ? late_ + 1 : 0;
    near_latest_ += is_late ? 0 : 1;
    if (late_ < late_lines) return;
    late_ = 0;
    if (near_latest_ < min_confirmations) {
        ++unconfirmed_;
        latest_s_ = line.time_s;
        return;
    }
    stepped_back_s_ = latest_s_ - line.time_s;
    stepped_at_s_ = latest_s_;
    offset_s_ += stepped_back_s_;
    line.time_s = latest_s_;
    ++steps_back_;
}

/// Takes a step back that was none: lines out of order, of which this is one from ahead.
void ClockFilter::handle_recovery(Line& line) {
    const double ahead_s = line.time_s - latest_s_;
    if (latest_s_ > stepped_at_s_ + max_step_s) stepped_back_s_ = 0.0;
    if (stepped_back_s_ == 0.0 || ahead_s < late_s || std::abs(ahead_s - stepped_back_s_) > late_s) return;
    offset_s_ -= stepped_back_s_;
    line.time_s -= stepped_back_s_;
    stepped_back_s_ = 0.0;
    --steps_back_;
}

bool ClockFilter::hold(Line line, std::vector<Line>& accepted) {
    if (!held_.empty() && std::abs(line.time_s - held_.back().time_s) > max_step_s) {
        unconfirmed_ += held_.size();
        held_.clear();
    }
    held_.push_back(std::move(line));
    if (held_.size() < min_confirmations) return false;
    const bool anew = !is_guess_ && held_.front().time_s < latest_s_;
    if (anew) {
        for (auto& held : held_) held.time_s -= offset_s_;
        offset_s_ = 0.0;
        stepped_back_s_ = 0.0;
        pace_ = {};
    } else if (!is_guess_) {
        undo_step();
    }
    latest_s_ = std::ranges::max(held_, {}, &Line::time_s).time_s;
    late_ = 0;
    is_guess_ = false;
    near_latest_ = min_confirmations;
    for (auto& held : held_) accept_line(std::move(held), accepted);
    held_.clear();
    return anew;
}

/// Of lines that are ahead of the latest one.
void ClockFilter::undo_step() {
    const auto& first = held_.front();
    const auto before_s = pace_.last_arrival_s();
    if (!before_s || !first.arrival_s) return;
    const double step_s = first.time_s - latest_s_ - (*first.arrival_s - *before_s);
    if (step_s <= max_ahead_s) return;
    for (auto& held : held_) held.time_s -= step_s;
    offset_s_ -= step_s;
    set_ahead_s_ += step_s;
}

void ClockFilter::flush(std::vector<Line>& accepted) {
    for (auto& line : held_) {
        if (is_guess_ || line.time_s < latest_s_) {
            ++unconfirmed_;
            continue;
        }
        latest_s_ = line.time_s;
        accepted.push_back(std::move(line));
    }
    held_.clear();
}

}  // namespace flightwatt::live

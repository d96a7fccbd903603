#include "live/state/sender_clocks.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flightwatt::live {

bool ClockFilter::push(Line line, std::vector<Line>& accepted) {
    line.time_s += offset_s_;
    if (started_ && std::abs(line.time_s - latest_s_) > max_off_s) return hold(std::move(line), accepted);
    unconfirmed_ += held_.size();
    held_.clear();
    latest_s_ = started_ ? std::max(latest_s_, line.time_s) : line.time_s;
    started_ = true;
    accept_line(std::move(line), accepted);
    return false;
}

void ClockFilter::accept_line(Line line, std::vector<Line>& accepted) {
    if (line.arrival_s) pace_.add(line.time_s, *line.arrival_s);
    accepted.push_back(std::move(line));
}

bool ClockFilter::hold(Line line, std::vector<Line>& accepted) {
    if (!held_.empty() && std::abs(line.time_s - held_.back().time_s) > max_step_s) {
        unconfirmed_ += held_.size();
        held_.clear();
    }
    held_.push_back(std::move(line));
    if (held_.size() < min_confirmations) return false;
    const double step_s = held_.front().time_s - latest_s_;
    const bool restarted = step_s < -max_step_s;
    if (restarted) {
        shift_held(offset_s_);
        pace_ = {};
    } else if (step_s < 0.0) {
        shift_held(step_s);
        ++steps_back_;
    } else if (const double set_s = set_ahead_of_arrivals_s(); set_s > max_off_s) {
        shift_held(set_s);
        set_ahead_s_ += set_s;
    }
    latest_s_ = std::ranges::max(held_, {}, &Line::time_s).time_s;
    for (auto& held : held_) accept_line(std::move(held), accepted);
    held_.clear();
    return restarted;
}

void ClockFilter::shift_held(double back_s) {
    for (auto& held : held_) held.time_s -= back_s;
    offset_s_ -= back_s;
}

/// By how much the held lines are further ahead than their arrivals; 0 where the arrivals are not meaningful.
double ClockFilter::set_ahead_of_arrivals_s() const {
    const auto& first = held_.front();
    const auto before_s = pace_.last_arrival_s();
    if (!before_s || !first.arrival_s) return 0.0;
    return first.time_s - latest_s_ - (*first.arrival_s - *before_s);
}

void ClockFilter::flush(std::vector<Line>& accepted) {
    for (auto& line : held_) {
        if (line.time_s < latest_s_) {
            ++unconfirmed_;
            continue;
        }
        latest_s_ = line.time_s;
        accepted.push_back(std::move(line));
    }
    held_.clear();
}

std::string_view sender_of(std::string_view text) { return text.substr(0, text.find(' ')); }

SenderClocks::Clock& SenderClocks::clock_of(std::string_view sender) {
    if (const auto known = clocks_.find(sender); known != clocks_.end()) return known->second;
    if (clocks_.empty()) followed_ = sender;
    return clocks_[std::string(clocks_.size() < max_senders ? sender : std::string_view())];
}

const ClockFilter& SenderClocks::followed_clock() const {
    static const ClockFilter not_started;
    const auto followed = clocks_.find(followed_);
    return followed == clocks_.end() ? not_started : followed->second.filter;
}

SenderClocks::RestartScope SenderClocks::push(ClockFilter::Line line, bool source_restarted,
                                              std::vector<ClockFilter::Line>& accepted) {
    const std::string sender(sender_of(line.text));
    const auto known = clocks_.find(sender);
    const auto& reference = known == clocks_.end() ? followed_clock() : known->second.filter;
    const bool all = source_restarted && reference.is_late(line.time_s);
    if (all) {
        unconfirmed_before_ = unconfirmed();
        clocks_.clear();
        others_s_ = 0.0;
    }
    auto& clock = clock_of(sender);
    const bool restarted = clock.filter.push(std::move(line), accepted);
    if (!accepted.empty()) advance(sender, restarted, clock);
    return all ? RestartScope::all : restarted ? RestartScope::sender : RestartScope::none;
}

void SenderClocks::advance(std::string_view sender, bool restarted, Clock& clock) {
    if (is_followed(sender)) return reset_silence();
    if (restarted || !clock.begin_s) clock.begin_s = clock.filter.latest_s();
    others_s_ = std::max(others_s_, clock.filter.latest_s() - *clock.begin_s);
}

void SenderClocks::reset_silence() {
    others_s_ = 0.0;
    for (auto& [sender, clock] : clocks_) clock.begin_s.reset();
}

void SenderClocks::flush(std::vector<ClockFilter::Line>& accepted) {
    for (auto& [sender, clock] : clocks_) clock.filter.flush(accepted);
}

void SenderClocks::follow(const std::string& sender) {
    if (is_followed(sender) || !clocks_.contains(sender)) return;
    followed_ = sender;
    reset_silence();
}

std::size_t SenderClocks::unconfirmed() const {
    std::size_t unconfirmed = unconfirmed_before_;
    for (const auto& [sender, clock] : clocks_) unconfirmed += clock.filter.unconfirmed();
    return unconfirmed;
}

}  // namespace flightwatt::live

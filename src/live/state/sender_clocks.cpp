#include "live/state/sender_clocks.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flightwatt::live {

bool ClockFilter::push(Line line, std::vector<Line>& accepted) {
    line.time_s += offset_s_;
    const double ahead_s = line.time_s - latest_s_;
    const double max_behind_s = is_guess_ ? max_step_s : max_off_s;
    if (started_ && (ahead_s > max_off_s || ahead_s < -max_behind_s)) return hold(std::move(line), accepted);
    unconfirmed_ += held_.size();
    held_.clear();
    latest_s_ = started_ && !is_guess_ ? std::max(latest_s_, line.time_s) : line.time_s;
    started_ = true;
    is_guess_ = false;
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
    const bool anew = !is_guess_ && step_s < -max_step_s;
    if (anew) {
        set_held_back(offset_s_);
        pace_ = {};
    } else if (!is_guess_ && step_s < 0.0) {
        set_held_back(step_s);
        ++steps_back_;
    } else if (const double set_s = set_ahead_of_arrivals_s(); !is_guess_ && set_s > max_off_s) {
        set_held_back(set_s);
        set_ahead_s_ += set_s;
    }
    latest_s_ = std::ranges::max(held_, {}, &Line::time_s).time_s;
    is_guess_ = false;
    for (auto& held : held_) accept_line(std::move(held), accepted);
    held_.clear();
    return anew;
}

void ClockFilter::set_held_back(double by_s) {
    for (auto& held : held_) held.time_s -= by_s;
    offset_s_ -= by_s;
}

/// Of lines that are ahead of the latest one: how much further than those of the arrivals. 0 where that is not known.
double ClockFilter::set_ahead_of_arrivals_s() const {
    const auto& first = held_.front();
    const auto before_s = pace_.last_arrival_s();
    if (!before_s || !first.arrival_s) return 0.0;
    return first.time_s - latest_s_ - (*first.arrival_s - *before_s);
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

std::string_view sender_of(std::string_view text) { return text.substr(0, text.find(' ')); }

SenderClocks::Clock& SenderClocks::clock_of(std::string_view sender) {
    if (const auto known = clocks_.find(sender); known != clocks_.end()) return known->second;
    if (clocks_.empty()) {
        followed_ = sender;
        return clocks_[followed_];
    }
    const std::string name(clocks_.size() < max_senders ? sender : std::string_view());
    if (const auto shared = clocks_.find(name); shared != clocks_.end()) return shared->second;
    return clocks_.emplace(name, Clock{ClockFilter(latest_s()), 0, 0.0}).first->second;
}

SenderClocks::RestartScope SenderClocks::push(ClockFilter::Line line, bool restarted,
                                              std::vector<ClockFilter::Line>& believed) {
    const std::string sender(sender_of(line.text));
    const bool all = restarted && started() && clock_of(sender).filter.is_late(line.time_s);
    if (all) {
        unconfirmed_before_ = unconfirmed();
        clocks_.clear();
        others_s_ = 0.0;
    }
    auto& clock = clock_of(sender);
    const bool anew = clock.filter.push(std::move(line), believed);
    if (!believed.empty()) advance(sender, anew, clock);
    return all ? RestartScope::all : anew ? RestartScope::sender : RestartScope::none;
}

void SenderClocks::advance(std::string_view sender, bool anew, Clock& clock) {
    if (is_followed(sender)) {
        ++round_;
        others_s_ = 0.0;
        return;
    }
    if (anew || clock.round != round_) clock.begin_s = clock.filter.latest_s();
    clock.round = round_;
    others_s_ = std::max(others_s_, clock.filter.latest_s() - clock.begin_s);
}

void SenderClocks::flush(std::vector<ClockFilter::Line>& believed) {
    for (auto& [sender, clock] : clocks_) clock.filter.flush(believed);
}

void SenderClocks::follow(const std::string& sender) {
    if (is_followed(sender) || !clocks_.contains(sender)) return;
    followed_ = sender;
    ++round_;
    others_s_ = 0.0;
}

double SenderClocks::latest_s() const {
    const auto followed = clocks_.find(followed_);
    return followed == clocks_.end() ? 0.0 : followed->second.filter.latest_s() + others_s_;
}

std::size_t SenderClocks::unconfirmed() const {
    std::size_t unconfirmed = unconfirmed_before_;
    for (const auto& [sender, clock] : clocks_) unconfirmed += clock.filter.unconfirmed();
    return unconfirmed;
}

std::size_t SenderClocks::steps_back() const {
    const auto followed = clocks_.find(followed_);
    return followed == clocks_.end() ? 0 : followed->second.filter.steps_back();
}

double SenderClocks::set_ahead_s() const {
    const auto followed = clocks_.find(followed_);
    return followed == clocks_.end() ? 0.0 : followed->second.filter.set_ahead_s();
}

}  // namespace flightwatt::live

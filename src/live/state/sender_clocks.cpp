#include "live/state/sender_clocks.h"

#include <algorithm>
#include <utility>

namespace flightwatt::live {

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

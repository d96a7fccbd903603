#include "live/sources/ivy_messages.h"

#include "base/number.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

constexpr std::string_view replay_prefix = "replay";
constexpr std::string_view time_prefix = "time";
constexpr std::size_t max_aircraft = 256;  // their ids are bytes
constexpr std::size_t max_waiting = 1000;

bool is_id(std::string_view word) {
    constexpr std::size_t max_digits = 5;
    return !word.empty() && word.size() <= max_digits &&
           std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// "20" of "replay20"; empty where the word is not of that kind.
std::string_view id_after(std::string_view prefix, std::string_view word) {
    if (!word.starts_with(prefix) || !is_id(word.substr(prefix.size()))) return {};
    return word.substr(prefix.size());
}

}  // namespace

void IvyMessages::handle(std::string_view said) {
    const auto first = said.find_first_not_of(' ');
    if (first == std::string_view::npos) return void(++no_messages_);
    said.remove_prefix(first);
    const auto blank = said.find(' ');
    if (blank == std::string_view::npos) return void(++no_messages_);
    const auto sender = said.substr(0, blank);
    const auto rest = said.substr(blank);  // with its blank
    if (const auto id = id_after(time_prefix, sender); !id.empty()) {
        const auto time_s = parse_number(rest.substr(std::min(rest.find_first_not_of(' '), rest.size())));
        if (!time_s || !std::isfinite(*time_s)) return void(++no_messages_);
        ++times_;
        if (const auto replay = replays_.find(id); !has_aircraft_ && replay != replays_.end()) {
            replay->second.time_s = time_s;
            latest_time_s_ = time_s;
            hand_on(replay->second);
        }
        return;
    }
    const auto id = id_after(replay_prefix, sender);
    if (id.empty()) {
        if (is_id(sender)) has_aircraft_ = true;
        // What the ground says beside a replay is said on its clock.
        return sink_({has_aircraft_ ? std::nullopt : latest_time_s_, std::string(said)});
    }
    if (has_aircraft_ || (replays_.size() >= max_aircraft && !replays_.contains(id))) return void(++unheeded_replays_);
    auto& replay = replays_[std::string(id)];
    replay.waiting.push_back(fmt::format("{}{}", id, rest));
    if (replay.waiting.size() > max_waiting) hand_on(replay);
}

void IvyMessages::hand_on(Replay& replay) {
    for (auto& text : replay.waiting) sink_({replay.time_s, std::move(text)});
    replay.waiting.clear();
}

void IvyMessages::release() {
    for (auto& [id, replay] : replays_) hand_on(replay);
}

bool IvyMessages::has_pending() const {
    return std::any_of(replays_.begin(), replays_.end(),
                       [](const auto& replay) { return !replay.second.waiting.empty(); });
}

}  // namespace flightwatt::live

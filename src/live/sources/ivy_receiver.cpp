#include "live/sources/ivy_receiver.h"

#include "base/number.h"
#include "live/sources.h"
#include "live/sources/ivy_agent.h"
#include "live/sources/receiving_source.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <string>
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

/// Everything, as one group: the library of every agent understands it, and no agent takes it for a message that its
/// program never sends.
constexpr const char* everything = "(.*)";

/// Telemetry from an Ivy bus.
class IvyReceiver {
  public:
    IvyReceiver(boost::asio::io_context& context, MessageQueue& queue, IvyBus bus)
        : messages_(queue),
          agent_(context,
                 {.bus = std::move(bus),
                  .name = "FlightWatt watch",
                  .subscriptions = {everything},
                  .on_message = [this](const auto& groups) { messages_.handle(groups.empty() ? "" : groups.front()); },
                  .on_unusable = [&queue](std::string_view reason) { queue.count(reason); },
                  .on_peer_lost = [&queue] { queue.count_restart(); }}) {}

    std::string description() const {
        const auto& bus = agent_.setup().bus;
        return fmt::format("the Ivy bus {}:{}", fmt::join(bus.networks, ","), bus.port);
    }

    void start() { agent_.start(); }

    void stop() {
        agent_.stop();
        messages_.release();
    }

  private:
    IvyMessages messages_;
    IvyAgent agent_;
};

}  // namespace

void IvyMessages::handle(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const auto blank = text.find(' ');
    if (blank == std::string_view::npos) return count_malformed();
    const auto sender = text.substr(0, blank);
    const auto rest = text.substr(blank);  // with its blank
    if (const auto id = id_after(time_prefix, sender); !id.empty()) return handle_time(id, rest);
    const auto id = id_after(replay_prefix, sender);
    if (id.empty()) {
        if (is_id(sender)) has_aircraft_ = true;
        // Messages from the ground next to a replay are on its clock.
        return sink_.push({has_aircraft_ ? std::nullopt : latest_time_s_, std::string(text)});
    }
    if (has_aircraft_ || (replays_.size() >= max_aircraft && !replays_.contains(id)))
        return sink_.count("messages of a replay while an aircraft itself is on the bus", 1);
    auto& replay = replays_[std::string(id)];
    replay.waiting.push_back(fmt::format("{}{}", id, rest));
    if (replay.waiting.size() > max_waiting) forward(replay);
}

void IvyMessages::handle_time(std::string_view id, std::string_view text) {
    const auto time_s = parse_number(text.substr(std::min(text.find_first_not_of(' '), text.size())));
    if (!time_s || !std::isfinite(*time_s)) return count_malformed();
    const auto replay = replays_.find(id);
    if (has_aircraft_ || replay == replays_.end()) return;
    replay->second.time_s = time_s;
    latest_time_s_ = time_s;
    forward(replay->second);
}

void IvyMessages::forward(Replay& replay) {
    for (auto& text : replay.waiting) sink_.push({replay.time_s, std::move(text)});
    replay.waiting.clear();
}

void IvyMessages::release() {
    for (auto& [id, replay] : replays_) forward(replay);
}

std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor) {
    return std::make_unique<ReceivingSource<IvyReceiver>>(clock_factor, parse_ivy_bus(bus));
}

}  // namespace flightwatt::live

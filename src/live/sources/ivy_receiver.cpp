#include "live/sources/ivy_receiver.h"

#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

/// Between "replay20 ..." and "time20 ..." a player does nothing else.
constexpr std::chrono::milliseconds max_wait_for_time{100};

/// Everything, as one group: every agent's library understands it, and none takes it for a message that its program
/// never sends.
constexpr const char* everything = "(.*)";

}  // namespace

IvyReceiver::IvyReceiver(boost::asio::io_context& context, MessageQueue& queue, IvyBus bus)
    : queue_(queue),
      messages_([&queue](IncomingMessage message) { queue.push(std::move(message)); }),
      agent_(context,
             {.bus = std::move(bus),
              .name = "FlightWatt watch",
              .subscriptions = {everything},
              .on_message =
                  [this](const std::vector<std::string_view>& groups) { heed(groups.empty() ? "" : groups.front()); },
              .on_unusable = [&queue](std::string_view reason) { queue.count(reason); },
              .on_peer_lost = [&queue] { queue.count_restart(false); }}),
      timer_(context) {}

std::string IvyReceiver::description() const {
    const auto& bus = agent_.setup().bus;
    return fmt::format("the Ivy bus {}:{}", fmt::join(bus.networks, ","), bus.port);
}

void IvyReceiver::stop() {
    agent_.stop();
    boost::system::error_code ignored;
    timer_.cancel(ignored);
    messages_.release();
}

void IvyReceiver::heed(std::string_view said) {
    messages_.handle(said);
    queue_.count("messages of a replay while an aircraft itself is on the bus",
                 messages_.ignored_replays() - unheeded_replays_);
    queue_.count("messages of a single word", messages_.malformed_lines() - no_messages_);
    unheeded_replays_ = messages_.ignored_replays();
    no_messages_ = messages_.malformed_lines();
    if (messages_.has_pending()) release_soon();
}

void IvyReceiver::release_soon() {
    if (std::exchange(release_is_due_, true)) return;
    timer_.expires_after(max_wait_for_time);
    timer_.async_wait([this, times = messages_.times()](const boost::system::error_code& error) {
        release_is_due_ = false;
        if (error) return;
        if (messages_.times() == times) {
            messages_.release();
        } else if (messages_.has_pending()) {
            release_soon();  // what waits came later
        }
    });
}

}  // namespace flightwatt::live

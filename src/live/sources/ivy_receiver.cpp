#include "live/sources.h"
#include "live/sources/ivy_agent.h"
#include "live/sources/ivy_messages.h"
#include "live/sources/receiving_source.h"

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>

#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

/// Everything, as one group: the library of every agent understands it, and no agent takes it for a message that its
/// program never sends.
constexpr const char* everything = "(.*)";

/// Telemetry from an Ivy bus.
class IvyReceiver : public Receiver {
  public:
    IvyReceiver(boost::asio::io_context& context, MessageQueue& queue, IvyBus bus)
        : messages_(queue),
          agent_(context, {.bus = std::move(bus),
                           .name = "FlightWatt watch",
                           .subscriptions = {everything},
                           .on_message = [this](const auto& groups) { handle(groups.empty() ? "" : groups.front()); },
                           .on_unusable = [&queue](std::string_view reason) { queue.count(reason); },
                           .on_peer_lost = [&queue] { queue.count_restart(); }}),
          timer_(context) {}

    std::string description() const override {
        const auto& bus = agent_.setup().bus;
        return fmt::format("the Ivy bus {}:{}", fmt::join(bus.networks, ","), bus.port);
    }

    void start() override { agent_.start(); }

    void stop() override {
        agent_.stop();
        boost::system::error_code ignored;
        timer_.cancel(ignored);
        messages_.release();
    }

  private:
    void handle(std::string_view text) {
        messages_.handle(text);
        if (messages_.has_pending()) release_soon();
    }

    void release_soon() {
        constexpr std::chrono::milliseconds max_wait_for_time{100};  // a player sends the time at once
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

    IvyMessages messages_;
    IvyAgent agent_;
    boost::asio::steady_timer timer_;
    bool release_is_due_ = false;
};

}  // namespace

std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor) {
    return std::make_unique<ReceivingSource>(clock_factor, [&](auto& context, auto& queue) {
        return std::make_unique<IvyReceiver>(context, queue, parse_ivy_bus(bus));
    });
}

}  // namespace flightwatt::live

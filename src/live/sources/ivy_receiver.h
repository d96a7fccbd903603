#pragma once

#include "live/sources/ivy_agent.h"
#include "live/sources/ivy_messages.h"
#include "live/sources/receiving_source.h"

#include <cstddef>
#include <string>

#include <boost/asio/steady_timer.hpp>

namespace flightwatt::live {

/// Telemetry from an Ivy bus.
class IvyReceiver : public Receiver {
  public:
    IvyReceiver(boost::asio::io_context& context, MessageQueue& queue, IvyBus bus);

    std::string description() const override;
    void start() override { agent_.start(); }
    void stop() override;

  private:
    void heed(std::string_view said);
    void release_soon();

    MessageQueue& queue_;
    IvyMessages messages_;
    IvyAgent agent_;
    boost::asio::steady_timer timer_;
    std::size_t unheeded_replays_ = 0, no_messages_ = 0;
    bool release_is_due_ = false;
};

}  // namespace flightwatt::live

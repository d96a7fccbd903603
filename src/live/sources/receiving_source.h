#pragma once

#include "live/source.h"
#include "live/sources/message_queue.h"

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <boost/asio/io_context.hpp>

namespace flightwatt::live {

/// What receives from a socket or a device. All but the constructor runs in a thread of its own, and waits for nothing
/// but the context.
class Receiver {
  public:
    Receiver() = default;
    virtual ~Receiver() = default;
    Receiver(const Receiver&) = delete;
    Receiver& operator=(const Receiver&) = delete;

    virtual std::string description() const = 0;
    virtual void start() = 0;
    virtual void stop() = 0;
};

/// A source that receives in a thread of its own, so that nothing is lost while somebody computes.
class ReceivingSource : public MessageSource {
  public:
    using MakeReceiver = std::function<std::unique_ptr<Receiver>(boost::asio::io_context&, MessageQueue&)>;

    /// `make` opens what is received from, and may throw.
    ReceivingSource(double clock_factor, const MakeReceiver& make);
    ~ReceivingSource() override;

    void receive(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages) override;
    std::string description() const override { return description_; }
    const SourceReport& report() const override { return report_; }

  private:
    boost::asio::io_context context_;
    MessageQueue queue_;
    std::unique_ptr<Receiver> receiver_;
    std::string description_;
    SourceReport report_;
    std::thread thread_;
};

}  // namespace flightwatt::live

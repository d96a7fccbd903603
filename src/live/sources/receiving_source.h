#pragma once

#include "live/sources.h"
#include "live/sources/message_readers.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>

namespace flightwatt::live {

/// From the thread that a source receives in to the one that asks for messages. What is not fetched is kept up to a
/// bound; then the oldest are dropped, and counted.
class MessageQueue : public MessageSink {
  public:
    static constexpr std::size_t max_waiting = 100'000;  ///< of a lively link an hour or more
    static constexpr std::size_t max_per_call = 4'000;

    /// Messages without a time of their own get that of their arrival, since now, times `clock_factor`.
    explicit MessageQueue(double clock_factor) : clock_factor_(clock_factor) {}

    void push(IncomingMessage message) override;
    void count(std::string_view reason, std::size_t times = 1) override;
    /// The link was opened again.
    void count_restart();

    /// Waits for messages, at most so long, and appends them; `report` becomes what was counted until now.
    void take(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages, SourceReport& report);

  private:
    const std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
    const double clock_factor_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<IncomingMessage> waiting_;
    SourceReport report_;
};

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

/// A source that receives in a thread of its own, so that nothing is lost while the program computes.
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

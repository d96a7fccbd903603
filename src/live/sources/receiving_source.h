#pragma once

#include "live/sources.h"
#include "live/sources/endpoints.h"
#include "live/sources/message_readers.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

namespace flightwatt::live {

/// What a source has received, in whatever thread, and nobody has asked for yet. It is kept up to a bound; then the
/// oldest are dropped, and counted.
class MessageQueue : public MessageSink {
  public:
    static constexpr std::size_t max_waiting = 100'000;  ///< of a lively link an hour or more
    static constexpr std::size_t max_per_call = 4'000;

    /// Messages without a time of their own get that of their arrival, since now, times `clock_factor`.
    explicit MessageQueue(double clock_factor) : clock_factor_(clock_factor) {}

    void push(IncomingMessage message) override;
    void count(std::string_view reason, std::size_t times = 1) override;
    /// The link was opened again, or another file begins.
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
    bool restarted_ = false;  ///< before the next message
};

/// A source that receives in a thread of its own, so that nothing is lost while the program computes. A Receiver opens
/// in its constructor what is received from, and may throw; it has a description, is started and stopped in the thread,
/// and waits for nothing but the context.
template <typename Receiver>
class ReceivingSource : public MessageSource {
  public:
    template <typename... Arguments>
    explicit ReceivingSource(double clock_factor, Arguments&&... arguments)
        : queue_(clock_factor),
          receiver_(context_, queue_, std::forward<Arguments>(arguments)...),
          description_(receiver_.description()) {
        boost::asio::post(context_, [this] { receiver_.start(); });
        thread_ = start_without_signals([this] { context_.run(); });
    }
    ~ReceivingSource() override {
        boost::asio::post(context_, [this] { receiver_.stop(); });
        thread_.join();
    }
    void receive(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages) override {
        queue_.take(timeout, messages, report_);
    }
    std::string description() const override { return description_; }
    const SourceReport& report() const override { return report_; }

  private:
    boost::asio::io_context context_;
    MessageQueue queue_;
    Receiver receiver_;
    std::string description_;
    SourceReport report_;
    std::thread thread_;
};

}  // namespace flightwatt::live

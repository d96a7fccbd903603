#pragma once

#include "live/sources.h"
#include "telemetry/link_decoder.h"
#include "telemetry/mavlink_decoder.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

/// Receiver of messages and of counts of unusable input.
class MessageSink {
  public:
    virtual void push(IncomingMessage message) = 0;
    virtual void count(std::string_view reason, std::size_t times) = 0;

  protected:
    ~MessageSink() = default;
};

/// Queue of the messages that any thread received and that were not taken yet. Beyond `max_waiting` the oldest are
/// dropped and counted.
class MessageQueue final : public MessageSink {
  public:
    static constexpr std::size_t max_waiting = 100'000;  ///< an hour or more of a busy link
    static constexpr std::size_t max_per_call = 4'000;

    /// Opens the queue. A message without a time gets its arrival time since now, times `clock_factor`.
    explicit MessageQueue(double clock_factor) : clock_factor_(clock_factor) {}

    void push(IncomingMessage message) override;
    void count(std::string_view reason, std::size_t times) override;
    /// Counts a restart: the link was reopened, or another file begins.
    void count_restart();

    /// Appends the waiting messages, after waiting up to `timeout` for the first; sets `report` to the counts so far.
    void take(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages, SourceReport& report);

  private:
    const std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
    const double clock_factor_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<IncomingMessage> waiting_;
    SourceReport report_;
    bool restarted_ = false;  ///< a restart precedes the next message
};

/// Splits a byte stream into lines. Longer lines than any message are dropped, so memory is bounded.
class LineBuffer {
  public:
    static constexpr std::size_t max_line = 16'384;  ///< bytes; Paparazzi's messages have at most 255

    /// Appends the complete lines without their breaks (\n or \r\n). Returns the number of lines dropped.
    std::size_t push(std::string_view bytes, std::vector<std::string>& lines);
    /// Removes and returns the last line, which has no break yet; may be empty.
    std::string take_partial_line();

  private:
    std::string partial_;
    bool dropping_ = false;
};

/// Parses the lines of a .data file.
class TextReader {
  public:
    explicit TextReader(MessageSink& sink) : sink_(sink) {}
    void push(std::string_view bytes);
    /// Reads the last line even if it has no break.
    void flush() { read(buffer_.take_partial_line()); }
    void restart() { sink_.count("lines cut off by a restart", buffer_.take_partial_line().empty() ? 0 : 1); }

  private:
    void read(const std::string& line);

    MessageSink& sink_;
    LineBuffer buffer_;
};

/// Turns the bytes of a link into messages.
class ByteReader {
  public:
    virtual ~ByteReader() = default;
    virtual void push(std::string_view bytes) = 0;
    /// Ends the stream and begins another one (file replaced, link reopened).
    virtual void restart() = 0;
};

/// Decodes the bytes of Paparazzi's link or a binary log.
class LinkReader final : public ByteReader {
  public:
    using Definitions = std::shared_ptr<const telemetry::MessageDictionary>;

    /// Decodes by the definitions; framing and version as for LinkDecoder.
    LinkReader(MessageSink& sink, Definitions definitions, std::optional<telemetry::Framing> framing = std::nullopt,
               std::optional<telemetry::LinkVersion> version = std::nullopt);

    void push(std::string_view bytes) override;
    /// Ends the stream.
    void flush();
    void restart() override;

    const telemetry::LinkCounts& counts() const { return decoder_.counts(); }

  private:
    void forward(const telemetry::LinkMessage& message);
    void count_unusable();

    MessageSink& sink_;
    Definitions definitions_;
    std::optional<telemetry::Framing> framing_;
    telemetry::LinkDecoder decoder_;
    telemetry::LinkCounts counted_;
};

/// Decodes MAVLink of a link, or of a .tlog with its times, in seconds since its first message of a vehicle.
class MavlinkReader final : public ByteReader {
  public:
    MavlinkReader(MessageSink& sink, std::shared_ptr<telemetry::MavlinkVehicles> vehicles, bool is_tlog)
        : sink_(sink), vehicles_(std::move(vehicles)), decoder_(vehicles_, is_tlog) {}
    void push(std::string_view bytes) override;
    /// Ends the stream.
    void flush() { restart(); }
    void restart() override;

  private:
    void count_unusable();

    MessageSink& sink_;
    std::shared_ptr<telemetry::MavlinkVehicles> vehicles_;
    telemetry::MavlinkDecoder decoder_;
    std::optional<double> start_unix_s_;
    std::size_t skipped_bytes_ = 0;
};

}  // namespace flightwatt::live

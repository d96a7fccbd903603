#pragma once

#include "live/sources.h"
#include "telemetry/link_decoder.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

/// Takes messages, and counts what cannot be used.
class MessageSink {
  public:
    MessageSink() = default;
    virtual ~MessageSink() = default;
    MessageSink(const MessageSink&) = delete;
    MessageSink& operator=(const MessageSink&) = delete;

    virtual void push(IncomingMessage message) = 0;
    virtual void count(std::string_view reason, std::size_t times) = 0;
};

/// Lines out of bytes as they come in, in any pieces. Memory is bounded: a line that is longer than any message is
/// dropped, and counted.
class LineBuffer {
  public:
    static constexpr std::size_t max_line = 16'384;  ///< bytes; Paparazzi's messages have at most 255

    /// Appends the lines that are whole now, without their breaks (\n or \r\n). Returns how many were too long.
    std::size_t push(std::string_view bytes, std::vector<std::string>& lines);
    /// The last line, which lacks its break; empty if there is none.
    std::string take_partial_line();

  private:
    std::string rest_;
    bool dropping_ = false;
};

/// Messages out of the lines of a .data file.
class TextReader {
  public:
    explicit TextReader(MessageSink& sink) : sink_(sink) {}
    void push(std::string_view bytes);
    /// The last line, if it lacks its break.
    void flush() { read(buffer_.take_partial_line()); }
    void restart() { sink_.count("lines cut off by a restart", buffer_.take_partial_line().empty() ? 0 : 1); }

  private:
    void read(const std::string& line);

    MessageSink& sink_;
    LineBuffer buffer_;
};

/// Messages out of the bytes of a link or a binary log.
class LinkReader {
  public:
    using Definitions = std::shared_ptr<const telemetry::MessageDictionary>;

    /// Framing and version: as of LinkDecoder.
    LinkReader(MessageSink& sink, Definitions definitions, std::optional<telemetry::Framing> framing = std::nullopt,
               std::optional<telemetry::LinkVersion> version = std::nullopt);

    void push(std::string_view bytes);
    /// The bytes end here.
    void flush();
    /// The bytes end here, and others begin: another file, a link that is opened again.
    void restart();

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

}  // namespace flightwatt::live

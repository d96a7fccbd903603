#pragma once

#include "live/sources/message_queue.h"
#include "telemetry/link_decoder.h"

#include <optional>
#include <string_view>

namespace flightwatt::live {

/// What aircraft say over one link, out of its bytes into a queue. What it counts goes there, too.
class LinkReader {
  public:
    LinkReader(const telemetry::MessageDictionary& dictionary, std::optional<telemetry::Framing> framing,
               MessageQueue& queue);

    void push(std::string_view bytes);
    /// The bytes end here: the link is opened anew.
    void flush();

  private:
    void hand_on(const telemetry::LinkMessage& message);
    void count();

    MessageQueue& queue_;
    telemetry::LinkDecoder decoder_;
    telemetry::LinkCounts counted_;
};

}  // namespace flightwatt::live

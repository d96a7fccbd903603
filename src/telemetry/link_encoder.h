#pragma once

#include "telemetry/message_dictionary.h"

#include <map>
#include <string>
#include <string_view>

namespace flightwatt::telemetry {

/// Encodes lines of a .data file as link frames, which LinkDecoder decodes. Floats are rounded to 32 bits.
class LinkEncoder {
  public:
    /// Encodes by the definitions of `dictionary`, which must outlive this.
    LinkEncoder(const MessageDictionary& dictionary, LinkVersion version);

    /// Appends the frame of a line without its time, "20 ENERGY 57 11.62 ...", and returns an empty text. Otherwise
    /// (the sender is not an aircraft, the message is not defined, or its fields do not match the definition) returns
    /// the reason and appends nothing.
    std::string_view append_frame(std::string_view text, std::string& frames);

  private:
    const MessageDictionary* dictionary_;
    LinkVersion version_;
    std::map<std::string_view, const WireMessage*, std::less<>> by_name_;
    std::string payload_;
};

}  // namespace flightwatt::telemetry

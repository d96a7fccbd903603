#pragma once

#include "telemetry/message_dictionary.h"

#include <map>
#include <string>
#include <string_view>

namespace flightwatt::telemetry {

/// Lines of a .data file as the frames of a link that would have brought them: what LinkDecoder takes apart. Floats
/// lose what their wire has no bits for.
class LinkEncoder {
  public:
    LinkEncoder(const MessageDictionary& dictionary, LinkVersion version);

    /// Appends the frame of "20 ENERGY 57 11.62 ...". Where it cannot be one (another sender than an aircraft, a
    /// message that telemetry does not define, fields that its definition does not have), nothing is appended; the
    /// reason is returned, and empty else.
    std::string_view append_frame(std::string_view text, std::string& frames);

  private:
    const MessageDictionary* dictionary_;
    LinkVersion version_;
    std::map<std::string_view, const WireMessage*, std::less<>> by_name_;
    std::string payload_;
};

}  // namespace flightwatt::telemetry

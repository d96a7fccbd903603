#pragma once

#include "telemetry/link_decoder.h"

#include <optional>
#include <string_view>

namespace flightwatt::telemetry {

/// The framing whose frames with right checksums follow each other in most of the bytes; nothing where none does.
/// `is_unchanged`: nothing comes behind, so that a single frame is enough which fills them.
std::optional<Framing> detect_framing(std::string_view bytes, bool is_whole);

/// The header that most frames fit, of the first few thousand; nothing where none fits.
std::optional<LinkVersion> detect_version(std::string_view bytes, Framing framing, const MessageDictionary& dictionary);

/// Calls use.template operator()<framing>().
template <typename Use>
auto with_framing(Framing framing, Use&& use) {
    switch (framing) {
        case Framing::card:
            return use.template operator()<Framing::card>();
        case Framing::link:
            return use.template operator()<Framing::link>();
        case Framing::xbee:
            break;
    }
    return use.template operator()<Framing::xbee>();
}

}  // namespace flightwatt::telemetry

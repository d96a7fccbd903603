#pragma once

#include "telemetry/link_decoder.h"

namespace flightwatt::live {

/// What a decoder could not use since it was `before`, told to `count(reason, times)`.
template <typename Count>
void report_unusable(const telemetry::LinkCounts& now, const telemetry::LinkCounts& before, const Count& count) {
    count("frames of messages that are not defined", now.unknown - before.unknown);
    count("frames of another length than their message's", now.length_mismatches - before.length_mismatches);
    count("bytes between frames", now.skipped_bytes - before.skipped_bytes);
}

/// What the ground says to an aircraft is none of its telemetry.
inline constexpr const char* other_class = "messages of other classes than telemetry";

}  // namespace flightwatt::live

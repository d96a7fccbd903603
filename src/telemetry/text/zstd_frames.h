#pragma once

#include <string_view>

namespace flightwatt::telemetry {

/// Whether `bytes` are whole zstd frames (RFC 8878, section 3.1). The decompressor of Boost takes a frame that is cut
/// off for the end of the file.
bool holds_whole_zstd_frames(std::string_view bytes);

}  // namespace flightwatt::telemetry

#pragma once

#include <string>
#include <string_view>

namespace flightwatt::report {

/// `html` as zlib's deflate (RFC 1950) in base64 (RFC 4648), which the page opens by DecompressionStream("deflate").
/// The same text gives the same block.
std::string compressed_block(std::string_view html);

}  // namespace flightwatt::report

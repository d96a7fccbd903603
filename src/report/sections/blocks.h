#pragma once

#include "report/figure.h"

#include <string>
#include <string_view>

namespace flightwatt::report {

/// Returns `html` as zlib's deflate (RFC 1950) in base64 (RFC 4648), which the page decodes by
/// DecompressionStream("deflate").
std::string compressed_block(std::string_view html);

/// Returns a specification with its inline CSV tables as {"packed": [[name, decimals, [first, step, step ...]], [name,
/// [text, text ...]]]}: a step leads to the next number, in units of the last decimal; null is an empty cell.
/// unpacked() in web/blocks.js makes the same rows. Named datasets are kept.
VegaJson packed_tables(VegaJson spec);

}  // namespace flightwatt::report

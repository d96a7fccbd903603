#pragma once

#include "report/figure.h"

#include <string>
#include <string_view>

namespace flightwatt::report {

/// `html` as zlib's deflate (RFC 1950) in base64 (RFC 4648), which the page opens by DecompressionStream("deflate").
/// The same text gives the same block.
std::string compressed_block(std::string_view html);

/// A specification with its inline CSV tables as columns: {"values": CSV, "format": ...} becomes {"packed": [[name,
/// decimals, [first, step, step ...]], [name, [text, text ...]]]}. A step leads from a number to the next, counted in
/// the last decimal; null is an empty cell. Compressed, that is a third of the CSV. A column whose numbers have
/// exponents or more digits than a double has stands as [name, [number, null ...]]. Nothing is lost: unpacked() in
/// web/blocks.js makes the same rows of it. Named datasets stay what they are.
VegaJson packed_tables(const VegaJson& spec);

}  // namespace flightwatt::report

#pragma once

#include "record/record.h"

#include <string>
#include <string_view>
#include <vector>

/// Numbers of a document: columns of one length, as arrays.
namespace flightwatt::report {

/// Returns a number with that many decimals; null for NaN and infinity.
Json rounded_json(double value, int decimals);

/// Returns a column with that many decimals.
Json rounded_column(const std::vector<double>& values, int decimals);

/// Returns a column with six significant digits.
Json column_of(const std::vector<double>& values);

/// Returns a text as zlib's deflate (RFC 1950) in base64 (RFC 4648), which detailOf() of web/app/src/documents.ts
/// decodes.
std::string deflated_base64(std::string_view text);

}  // namespace flightwatt::report

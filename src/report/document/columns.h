#pragma once

#include "record/record.h"

#include <cstddef>
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

/// Returns the indices, rising, of rows that draw the same line on `columns` pixel columns as all: the first, last,
/// smallest and largest value of each column (M4: Jugel et al., VLDB 2014). All rows if there are at most four a
/// column.
std::vector<std::size_t> downsample_m4(const std::vector<double>& time_s, const std::vector<double>& values,
                                       std::size_t columns);

/// Returns `count` of the values at equal steps, with the first and the last; all if there are no more.
template <typename Value>
std::vector<Value> evenly_chosen(const std::vector<Value>& values, std::size_t count) {
    if (values.size() <= count) return values;
    std::vector<Value> chosen;
    for (std::size_t i = 0; i < count; ++i)
        chosen.push_back(values[count == 1 ? 0 : i * (values.size() - 1) / (count - 1)]);
    return chosen;
}

/// Returns a text as zlib's deflate (RFC 1950) in base64 (RFC 4648), which detailOf() of web/app/src/documents.ts
/// decodes.
std::string deflated_base64(std::string_view text);

/// Returns bytes in base64 (RFC 4648).
std::string base64(const std::string& bytes);

}  // namespace flightwatt::report

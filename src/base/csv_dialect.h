#pragma once

#include "base/csv.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt {

/// The header of a table of another program, and how its cells are separated.
struct CsvHeaderLine {
    CsvDialect dialect;
    std::vector<std::string> columns;
    bool has_all = false;  ///< the names that were searched
};

/// Finds line ends, preamble, header and separator: a line "sep=;", else the line of the first 200 that has most of
/// `names` (find_columns()), else the first after `skip_lines`. A preamble before a header with none of them is no
/// error here. Throws InputError where several separators fit.
CsvHeaderLine find_csv_header(std::string_view text, const std::string& file, const std::vector<std::string>& names,
                              std::optional<std::size_t> skip_lines = std::nullopt);

/// Adds to the dialect of a header whether decimals are written with commas, by all cells. Throws InputError where
/// commas may separate decimals or thousands, and where a column has commas and points.
CsvDialect with_decimals(CsvDialect dialect, std::string_view text, const std::string& file);

}  // namespace flightwatt

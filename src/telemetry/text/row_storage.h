#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>

namespace flightwatt::telemetry {

/// How many rows to make room for, when `rows` have come from the first `bytes_read` of `text_size` bytes:
/// those that the rest promises at this rate and a tenth more, at least half as many again. Memory that is
/// reserved and never written costs nothing, while columns that grow step by step are copied and faulted in
/// again.
std::size_t rows_to_reserve(std::size_t rows, std::size_t bytes_read, std::size_t text_size);

/// Makes room for `rows` rows in every column.
void reserve_rows(MessageTable& table, std::size_t rows);

}  // namespace flightwatt::telemetry

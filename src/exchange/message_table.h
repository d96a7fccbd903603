#pragma once

#include "flight/load_flight.h"

#include <optional>
#include <string>
#include <vector>

/// Columns over time for plotting programs such as PlotJuggler: a CSV without comments, `time_s` first, then a column
/// for each quantity with its unit as suffix. A cell without a value is empty.
namespace flightwatt::exchange {

/// The rows of one message as CSV.
struct MessageCsv {
    std::string csv;
    std::vector<std::string> left_out;  ///< fields without a number in any row: texts and arrays
    std::size_t recordings = 1;         ///< number of recordings in the file
};

/// Returns all rows of a message of one sender in a recording (counted from 1), each field in its quantity's base unit
/// (ENERGY.voltage in V: voltage_v). `sender` may be omitted if there is only one. Throws InputError for a series, for
/// a message or recording that is not in the log (listing those that are), and for several senders.
MessageCsv message_table(const flight::FlightFile& file, const std::string& message,
                         const std::optional<std::string>& sender, std::size_t recording = 1);

/// Returns all tracks of a series, also those not selected: the series file without its comments.
std::string series_table(const flight::FlightSeries& series);

}  // namespace flightwatt::exchange

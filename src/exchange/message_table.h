#pragma once

#include "flight/load_flight.h"

#include <optional>
#include <string>
#include <vector>

/// Columns over time for programs that plot them, such as PlotJuggler: a CSV without comments, `time_s` first, then a
/// column a quantity with its unit as suffix. A cell is empty where its column has no value at that time.
namespace flightwatt::exchange {

struct MessageCsv {
    std::string csv;
    std::vector<std::string> left_out;  ///< fields that hold no number in any row: texts and arrays
    std::size_t rows = 0;
};

/// All rows of one message of one sender, every field in the base unit of its quantity (ENERGY.voltage in V:
/// voltage_v). `sender` may be absent where one alone sent it. Throws InputError for a series, for a message that the
/// log does not hold (it says which it holds), and for one of several senders.
MessageCsv message_table(const flight::FlightFile& file, const std::string& message,
                         const std::optional<std::string>& sender);

/// All tracks of a series, those that are not chosen too: the series file without its comments.
std::string series_table(const flight::FlightSeries& series);

}  // namespace flightwatt::exchange

#pragma once

#include "base/atomic_file.h"
#include "base/text_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Tables as people read them, where the standard output is a terminal; elsewhere they stay whole.
namespace flightwatt::cli {

/// Where a table is shown.
struct Screen {
    bool is_terminal = false;
    bool wide = false;  ///< every column, however wide the terminal
    std::size_t columns = 80;
};

/// The standard output of this program, with --wide.
Screen screen_of(const StageCall& call);

/// What a table is called, and what of it matters most.
struct ScreenTable {
    std::string title;               ///< what was read; not shown elsewhere than on a terminal
    std::vector<std::string> first;  ///< columns that are kept before all others, the most important first
    std::size_t most_rows = 0;       ///< rows in the middle of longer tables are left out; 0: none
};

/// The table in the width of the screen: heads of several lines with the unit of a column (from the suffix of its
/// name) below, long texts on several lines, and below it the names of columns for which there was no room. Elsewhere
/// than on a terminal: to_text(table).
std::string screen_text(TextTable table, const Screen& screen, const ScreenTable& options = {});

/// A CSV text with the decimals that people read, by the units of its columns: 28.3 of 28.261000000000003 s. Columns
/// without a known unit get four digits. Comments are left out; their places are counted in `csv`. Throws InputError
/// where `csv` is none.
TextTable readable_table(std::string_view csv);

/// A result that is a CSV: to --output's file or a pipe as it is, to a terminal as a table.
void write_csv_result(const StageCall& call, std::string_view csv, const ScreenTable& options);
/// The same of a CSV in pieces.
void write_csv_result(const StageCall& call, const TextWriter& write_csv, const ScreenTable& options);

}  // namespace flightwatt::cli

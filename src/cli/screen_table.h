#pragma once

#include "base/atomic_file.h"
#include "base/text_table.h"
#include "cli/stage.h"
#include "cli/terminal.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Tables in the width of a terminal; elsewhere they are complete.
namespace flightwatt::cli {

/// Properties of the standard output.
struct Screen {
    bool is_terminal = false;
    bool wide = false;  ///< every column, however wide the terminal
    std::size_t columns = 80;
};

/// The standard output of this program, with --wide.
Screen screen_of(const StageCall& call);

/// Title and important columns of a table.
struct ScreenTable {
    std::string title;               ///< shown on a terminal
    std::vector<std::string> first;  ///< important columns, the most important first; empty: all are needed
    std::size_t max_rows = 0;        ///< of longer tables the first rows are shown; 0: all
};

/// The table in the width of the screen, durations in minutes: the important columns, long texts shortened, then the
/// names of the others; where all columns are needed, as several tables with the first column in each.
/// Without a terminal: to_text(table).
std::string screen_text(TextTable table, const Screen& screen, const ScreenTable& options = {});

/// A CSV text with decimals by the units of its columns (28.3 s), or four digits. Throws InputError for invalid CSV.
TextTable readable_table(std::string_view csv);

/// Writes a CSV: to --output's file or a pipe as it is, to a terminal as a table.
void write_csv_result(const StageCall& call, std::string_view csv, const ScreenTable& options);
/// The same of a CSV in chunks.
void write_csv_result(const StageCall& call, const TextWriter& write_csv, const ScreenTable& options);

}  // namespace flightwatt::cli

#pragma once

#include "base/text_table.h"
#include "record/json_type.h"

#include <string>
#include <string_view>

namespace flightwatt::report {

/// Tables of a report as LaTeX, an empty line apart.
struct LatexTables {
    std::string text;

    /// Adds a table, if it has rows.
    void add(const CaptionedTable& table) {
        if (!table.table.rows.empty()) add(to_latex(table.table, table.caption, table.label));
    }
    void add(const std::string& latex) { text += (text.empty() || latex.empty() ? "" : "\n") + latex; }
};

/// Returns a table as JSON (PrintedTable of web/app/src/documents.ts).
inline Json printed_json(const TextTable& table, std::string_view caption) {
    return {{"caption", caption}, {"header", table.header}, {"rows", table.rows}};
}

}  // namespace flightwatt::report

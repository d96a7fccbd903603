#include "cli/output/records.h"

#include "base/csv.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

/// What a column shows.
struct Column {
    std::string_view field;
    std::string_view form;
    std::string_view heading;
    bool is_rare = false;
};

Column column_of(std::string_view text) {
    const auto colon = text.find(": ");
    const auto shown = text.substr(0, colon);
    const auto blank = shown.find(' ');
    Column column{shown.substr(0, blank), "", ""};
    if (blank != std::string_view::npos) column.form = shown.substr(blank + 1);
    column.is_rare = column.field.ends_with('?');
    if (column.is_rare) column.field.remove_suffix(1);
    column.heading = colon == std::string_view::npos ? column.field : text.substr(colon + 2);
    return column;
}

/// null for what the record does not have.
Json field_of(const Json& record, std::string_view name) {
    return record.value(Json::json_pointer("/" + std::string(name)), Json());
}

std::string table_cell(const Json& value, std::string_view form) {
    if (value.is_null()) return "-";
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_number_float()) return fmt::format(fmt::runtime(fmt::format("{{:{}}}", form)), value.get<double>());
    return value.dump();
}

std::string csv_text(const Json& value, const CsvWriter& csv) {
    if (value.is_null()) return "";
    if (value.is_string()) return csv_cell(value.get_ref<const std::string&>());
    return value.is_number_float() ? csv.cell(value.get<double>()) : value.dump();
}

}  // namespace

TextTable table_of(const Json& records, const std::vector<std::string_view>& columns, std::string_view usual_form) {
    TextTable table{{}, std::vector<std::vector<std::string>>(records.size())};
    for (const auto text : columns) {
        const auto column = column_of(text);
        const auto form = column.form.empty() ? usual_form : column.form;
        std::vector<std::string> cells;
        cells.reserve(records.size());
        for (const auto& record : records) cells.push_back(table_cell(field_of(record, column.field), form));
        if (column.is_rare && std::ranges::count(cells, "-") == std::ssize(cells)) continue;
        table.header.emplace_back(column.heading);
        for (std::size_t i = 0; i < cells.size(); ++i) table.rows[i].push_back(std::move(cells[i]));
    }
    return table;
}

std::string csv_of(const Json& records, const std::vector<std::string_view>& columns, int digits) {
    std::vector<std::string_view> headings(columns.size());
    std::ranges::transform(columns, headings.begin(), [](auto text) { return column_of(text).heading; });
    CsvWriter csv(headings, digits);
    for (const auto& record : records) {
        std::vector<std::string> cells;
        cells.reserve(columns.size());
        for (const auto text : columns) cells.push_back(csv_text(field_of(record, column_of(text).field), csv));
        csv.add_row(cells);
    }
    return csv.text();
}

}  // namespace flightwatt::cli

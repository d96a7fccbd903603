#include "report/blocks/packed_tables.h"

#include "base/csv.h"
#include "base/number.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace flightwatt::report {
namespace {

constexpr std::size_t most_digits = 15;  ///< that a double keeps, and JavaScript with it

/// How many decimals the cells have at most; none where a cell is not of a sign, digits and a point alone.
std::optional<std::size_t> decimals_of(const CsvTable& table, std::size_t column) {
    std::size_t most = 0;
    std::size_t whole = 0;
    for (const auto& row : table.rows) {
        const std::string_view text = row.cells[column].text;
        const auto digits = text.substr(text.starts_with('-') ? 1 : 0);
        if (digits.find_first_not_of("0123456789.") != std::string_view::npos) return std::nullopt;
        const auto point = digits.find('.');
        whole = std::max(whole, std::min(point, digits.size()));
        if (point != std::string_view::npos) most = std::max(most, digits.size() - point - 1);
    }
    if (whole + most > most_digits) return std::nullopt;
    return most;
}

/// "-1.5" with three decimals: -1500.
std::int64_t in_last_decimal(const std::string& text, std::size_t decimals) {
    std::string digits;
    std::ranges::remove_copy(text, std::back_inserter(digits), '.');
    const auto point = text.find('.');
    digits.append(decimals - (point == std::string::npos ? 0 : text.size() - point - 1), '0');
    return std::strtoll(digits.c_str(), nullptr, 10);
}

VegaJson steps(const CsvTable& table, std::size_t column, std::size_t decimals) {
    auto numbers = VegaJson::array();
    std::int64_t last = 0;
    for (const auto& row : table.rows) {
        const auto& text = row.cells[column].text;
        if (text.empty()) {
            numbers.push_back(nullptr);
            continue;
        }
        const auto number = in_last_decimal(text, decimals);
        numbers.push_back(number - last);
        last = number;
    }
    return numbers;
}

VegaJson cells(const CsvTable& table, std::size_t column, bool are_numbers) {
    auto all = VegaJson::array();
    for (const auto& row : table.rows) {
        const auto& text = row.cells[column].text;
        if (!are_numbers) {
            all.push_back(text);
        } else if (text.empty()) {
            all.push_back(nullptr);
        } else {
            all.push_back(cell_number(table, row, column));
        }
    }
    return all;
}

VegaJson packed_table(const std::string& csv, const VegaJson& parse) {
    const auto table = parse_csv(csv, "a figure's table");
    auto columns = VegaJson::array();
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        const bool are_numbers = parse.contains(table.columns[c]);
        const auto decimals = are_numbers ? decimals_of(table, c) : std::nullopt;
        if (decimals)
            columns.push_back({table.columns[c], *decimals, steps(table, c, *decimals)});
        else
            columns.push_back({table.columns[c], cells(table, c, are_numbers)});
    }
    return {{"packed", columns}};
}

bool is_csv(const VegaJson& data) {
    return data.contains("values") && data["values"].is_string() && data.contains("format") &&
           data["format"].value("type", "") == "csv";
}

}  // namespace

VegaJson packed_tables(const VegaJson& spec) {
    if (!spec.is_structured()) return spec;
    if (spec.is_object() && is_csv(spec))
        return packed_table(spec["values"].get_ref<const std::string&>(), spec["format"]["parse"]);
    auto packed = spec.is_array() ? VegaJson::array() : VegaJson::object();
    for (const auto& [key, part] : spec.items()) {
        if (spec.is_array())
            packed.push_back(packed_tables(part));
        else
            packed[key] = packed_tables(part);
    }
    return packed;
}

}  // namespace flightwatt::report

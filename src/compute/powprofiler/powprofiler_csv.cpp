#include "compute/powprofiler/powprofiler_csv.h"

#include "base/error.h"
#include "base/number.h"

#include <map>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

constexpr unsigned total_power_flag = 100;
constexpr unsigned first_parameter_flag = 200;

bool is_known_flag(std::uint64_t flag) {
    const bool quantity = flag >= total_power_flag && flag < first_parameter_flag &&
                          (flag - total_power_flag) % 30 < 3 && flag < total_power_flag + 90;
    return flag == 0 || quantity || (flag >= first_parameter_flag && flag < first_parameter_flag + 100);
}

/// The flags of one header cell, "100" or "100+130"; empty if it is something else.
std::vector<std::uint64_t> flags_of(std::string_view cell) {
    std::vector<std::uint64_t> flags;
    while (true) {
        const auto plus = cell.find('+');
        const auto flag = parse_unsigned(cell.substr(0, plus));
        if (!flag || !is_known_flag(*flag)) return {};
        flags.push_back(*flag);
        if (plus == std::string_view::npos) return flags;
        cell.remove_prefix(plus + 1);
    }
}

std::vector<std::size_t> parameter_columns(const std::map<std::uint64_t, std::size_t>& column_of,
                                           const Location& where) {
    std::vector<std::size_t> columns;
    for (auto it = column_of.lower_bound(first_parameter_flag); it != column_of.end(); ++it) {
        const auto expected = first_parameter_flag + columns.size();
        if (it->first != expected) {
            throw InputError(where, fmt::format("has the parameter flag {} without {}", it->first, expected));
        }
        columns.push_back(it->second);
    }
    return columns;
}

}  // namespace

std::optional<PowprofilerColumns> powprofiler_columns(const CsvTable& table) {
    const auto& header = table.rows.front();
    std::map<std::uint64_t, std::size_t> column_of;
    for (std::size_t column = 0; column < header.cells.size(); ++column) {
        const auto& cell = header.cells[column];
        const auto flags = flags_of(cell.text);
        if (flags.empty()) return std::nullopt;
        for (const auto flag : flags) {
            if (flag != 0 && !column_of.emplace(flag, column).second) {
                throw InputError({table.file, header.line, cell.column},
                                 fmt::format("the flag {} stands over two columns", flag));
            }
        }
    }
    const auto power = column_of.find(total_power_flag);
    if (power == column_of.end()) {
        throw InputError({table.file, header.line}, "has no column of total power, flag 100");
    }
    return PowprofilerColumns{power->second, parameter_columns(column_of, {table.file, header.line})};
}

std::vector<double> layer1_power_w(const CsvTable& table) {
    const auto columns = powprofiler_columns(table);
    if (!columns || !columns->parameters.empty()) {
        throw InputError({table.file, table.rows.front().line},
                         "is no powprofiler layer 1, whose first row is 100,101,102",
                         columns ? "flags from 200 are QoS parameters: this is a layer 2" : "");
    }
    std::vector<double> power_w;
    for (std::size_t i = 1; i < table.rows.size(); ++i) {
        power_w.push_back(cell_number(table, table.rows[i], columns->power));
    }
    if (power_w.empty()) {
        throw InputError({table.file, table.rows.front().line}, "has a header and no samples");
    }
    return power_w;
}

}  // namespace flightwatt::compute

#include "compute/powprofiler/powprofiler.h"

#include "base/atomic_file.h"
#include "base/number.h"

#include <map>
#include <string_view>

#include <boost/algorithm/string/split.hpp>
#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<double> numbers_in(std::string_view text, const Location& where) {
    std::vector<std::string> cells;
    boost::algorithm::split(cells, text, [](char c) { return c == ','; });
    std::vector<double> values;
    for (const auto& cell : cells) {
        const auto value = parse_number(trimmed(cell));
        if (!value) {
            throw InputError(where, fmt::format("'{}' is not a finite number", trimmed(cell)),
                             "write decimals with a point, values apart with a comma");
        }
        values.push_back(*value);
    }
    return values;
}

struct Property {
    std::string_view name;
    std::string_view value;
};

/// Split at the last '=': names of files may contain one, values do not.
Property property_of(std::string_view line, const Location& where) {
    const auto equals = line.rfind('=');
    if (equals == std::string_view::npos) {
        throw InputError(where, fmt::format("'{}' is neither [section] nor name=value", line));
    }
    return {trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1))};
}

void read_combination(const Property& property, const Location& where, const std::filesystem::path& folder,
                      std::vector<PowprofilerCombination>& combinations) {
    if (property.name == "name") return;  // of powprofiler's own layer 2
    auto values = numbers_in(property.value, where);
    if (!combinations.empty() && combinations.front().qos.size() != values.size()) {
        throw InputError(where, fmt::format("{} values, expected {} as in line {}", values.size(),
                                            combinations.front().qos.size(), combinations.front().where.line));
    }
    combinations.push_back({folder / property.name, std::move(values), where});
}

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

std::vector<PowprofilerCombination> read_powprofiler_config(const std::filesystem::path& path) {
    const auto content = read_file(path);
    std::vector<PowprofilerCombination> combinations;
    std::string_view section;
    Location where{path.string()};
    for (std::size_t begin = 0; begin < content.size();) {
        const auto whole = std::string_view(content).substr(begin, content.find('\n', begin) - begin);
        begin += whole.size() + 1;
        const auto line = trimmed(whole.substr(0, whole.find('#')));
        ++where.line;
        if (line.empty()) continue;
        if (line.front() == '[' && line.back() == ']') {
            section = line;
        } else if (section == "[combinations]") {
            read_combination(property_of(line, where), where, path.parent_path(), combinations);
        } else if (section != "[settings]" && !section.starts_with("[component")) {
            throw InputError(where, fmt::format("'{}' is outside of [settings] and [combinations]", line));
        }
    }
    if (combinations.empty()) {
        throw InputError({path.string()}, "has no [combinations], lines of file.csv=value,value",
                         "write what powprofiler runs by [components] as TOML, [components.NAME]");
    }
    for (const auto& combination : combinations) {
        const auto error = open_error(combination.recording);
        if (!error) continue;
        const auto reason =
            error == std::errc::no_such_file_or_directory ? "does not exist" : "cannot be read: " + error.message();
        throw InputError(combination.where, fmt::format("the recording {} {}", combination.recording.string(), reason));
    }
    return combinations;
}

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
                                 fmt::format("the flag {} heads two columns", flag));
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

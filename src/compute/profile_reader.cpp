#include "compute/profile_reader.h"

#include "base/csv.h"
#include "base/input_file.h"
#include "base/number.h"
#include "base/statistics.h"
#include "compute/powprofiler/powprofiler.h"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

constexpr std::string_view power_column = "power_w";
constexpr std::string_view ignored_column = "_";
constexpr std::string_view error_column = "standard_error_w";
constexpr std::string_view total_column = "total_power_w";
constexpr std::string_view above_idle_column = "above_idle_power_w";
/// Columns that may follow power_w in a CSV of `flightwatt profile`.
constexpr std::string_view evidence_columns[] = {error_column, total_column, above_idle_column, "duration_s",
                                                 "energy_j",   "samples",    "repeats",         "source"};

void refuse_bad_names(const std::vector<std::string>& parameters, const Location& where) {
    std::set<std::string_view> seen;
    for (const auto& name : parameters) {
        if (name.empty() || name.find_first_of(" \t") != std::string::npos) {
            throw InputError(where, fmt::format("'{}' is not a parameter's name", name), "use a name without blanks");
        }
        if (!seen.insert(name).second) {
            throw InputError(where, fmt::format("two columns are named '{}'", name));
        }
    }
}

void require_names(const ProfileNaming& naming, std::size_t count, const std::string& file) {
    const auto where = naming.where.file.empty() ? Location{file} : naming.where;
    if (naming.parameters.size() != count) {
        throw InputError(where,
                         fmt::format("{} has {} parameters without names, and {} names are given", file, count,
                                     naming.parameters.size()),
                         count == 0 ? "leave `parameters` out" : "name them in order with `parameters`");
    }
    refuse_bad_names(naming.parameters, where);
}

/// Which columns of a CSV a profile has.
struct ProfileColumns {
    std::vector<std::string> parameters;
    std::vector<std::size_t> parameter_columns;
    std::size_t power = 0;
    std::optional<std::size_t> standard_error = {};
    std::optional<std::size_t> total = {};       ///< of the whole computer
    std::optional<std::size_t> above_idle = {};  ///< of the component alone
};

PowerProfile profile_of(const CsvTable& table, std::size_t first_row, const ProfileColumns& columns) {
    std::vector<ProfileNode> nodes;
    for (std::size_t i = first_row; i < table.rows.size(); ++i) {
        const auto& row = table.rows[i];
        ProfileNode node{{}, cell_number(table, row, columns.power), {table.file, row.line}, {}};
        for (const auto column : columns.parameter_columns) node.qos.push_back(cell_number(table, row, column));
        // A single sample has no error.
        if (columns.standard_error && !row.cells[*columns.standard_error].text.empty())
            node.standard_error_w = cell_number(table, row, *columns.standard_error);
        nodes.push_back(std::move(node));
    }
    auto profile = make_power_profile(table.file, columns.parameters, std::move(nodes));
    const auto& row = table.rows[first_row];
    const double power_w = cell_number(table, row, columns.power);
    if (columns.total) profile.excluded_idle_w = cell_number(table, row, *columns.total) - power_w;
    if (columns.above_idle) profile.included_idle_w = power_w - cell_number(table, row, *columns.above_idle);
    return profile;
}

/// By the names of a header: parameters, power_w and then evidence.
ProfileColumns columns_of_header(const CsvTable& table) {
    const auto& header = table.rows.front();
    const auto power = std::ranges::find(header.cells, power_column, &CsvTable::Cell::text);
    if (power == header.cells.end()) {
        throw InputError({table.file, header.line, header.cells.back().column},
                         fmt::format("the last column is '{}', expected '{}'", header.cells.back().text, power_column),
                         "a profile's columns are its parameters and then power_w");
    }
    ProfileColumns columns;
    columns.power = static_cast<std::size_t>(power - header.cells.begin());
    for (std::size_t i = 0; i < header.cells.size(); ++i) {
        const auto& [name, column] = header.cells[i];
        if (name == total_column) columns.total = i;
        if (name == above_idle_column) columns.above_idle = i;
        if (i < columns.power) {
            columns.parameters.push_back(name);
            columns.parameter_columns.push_back(i);
        } else if (name == error_column) {
            columns.standard_error = i;
        } else if (i > columns.power && std::ranges::find(evidence_columns, name) == std::end(evidence_columns)) {
            throw InputError({table.file, header.line, column},
                             fmt::format("the column '{}' follows {}", name, power_column),
                             "parameters come before it, after it only the columns that `flightwatt profile` writes");
        }
    }
    refuse_bad_names(columns.parameters, {table.file, header.line});
    return columns;
}

/// By the names that the user gives to each column.
ProfileColumns columns_of_names(const CsvTable& table, const ProfileNaming& naming) {
    const auto width = table.rows.front().cells.size();
    if (naming.columns.size() != width) {
        throw InputError(naming.where,
                         fmt::format("{} columns are named, {} has {}", naming.columns.size(), table.file, width),
                         "name each column, one power_w, ignored ones _");
    }
    ProfileColumns columns;
    for (std::size_t i = 0; i < width; ++i) {
        const auto& name = naming.columns[i];
        if (name == power_column) columns.power = i;
        if (name == power_column || name == ignored_column) continue;
        columns.parameters.push_back(name);
        columns.parameter_columns.push_back(i);
    }
    if (const auto count = std::ranges::count(naming.columns, power_column); count != 1)
        throw InputError(naming.where, fmt::format("{} columns are named power_w, expected one", count));
    refuse_bad_names(columns.parameters, naming.where);
    return columns;
}

PowerProfile profile_of_combinations(const std::filesystem::path& path, const ProfileNaming& naming) {
    const auto combinations = read_powprofiler_config(path);
    require_names(naming, combinations.front().qos.size(), path.string());
    std::vector<ProfileNode> nodes;
    for (const auto& combination : combinations) {
        const auto power_w = layer1_power_w(read_csv(combination.recording, CsvHeader::absent));
        nodes.push_back({combination.qos, mean(power_w), combination.where, {}});
    }
    return make_power_profile(path.string(), naming.parameters, std::move(nodes));
}

PowerProfile profile_of_powprofiler(const CsvTable& table, const PowprofilerColumns& columns,
                                    const ProfileNaming& naming) {
    require_names(naming, columns.parameters.size(), table.file);
    if (columns.parameters.empty()) {
        return make_power_profile(table.file, {}, {{{}, mean(layer1_power_w(table)), {table.file}}});
    }
    return profile_of(table, 1, {naming.parameters, columns.parameters, columns.power});
}

}  // namespace

PowerProfile read_power_profile(const std::filesystem::path& path, const ProfileNaming& naming) {
    if (!naming.parameters.empty() && !naming.columns.empty()) {
        throw InputError(naming.where, "both `parameters` and `columns` are given, expected one of them");
    }
    if (path.extension() == ".cfg") {
        if (!naming.columns.empty()) {
            throw InputError(naming.where, fmt::format("{} has no columns", path.string()),
                             "name its values with `parameters`");
        }
        return profile_of_combinations(path, naming);
    }
    // Read without header: the first row determines the format.
    const auto text = read_file(path);
    require_kind(text, FileKind::profile, path.string());
    auto table = parse_csv(text, path.string(), CsvHeader::absent);
    const auto flags = powprofiler_columns(table);
    const auto first_line = table.rows.front().line;
    const auto& cells = table.rows.front().cells;
    const bool numbers =
        std::ranges::any_of(cells, [](const auto& cell) { return parse_number(cell.text).has_value(); });
    if (!naming.columns.empty()) {
        if (flags || !numbers) {
            throw InputError(naming.where, fmt::format("{} has a header", table.file),
                             "`columns` name those of a file without one; leave them out");
        }
        return profile_of(table, 0, columns_of_names(table, naming));
    }
    if (flags) return profile_of_powprofiler(table, *flags, naming);
    if (numbers) {
        throw InputError({table.file, first_line}, "begins with numbers and not with a header",
                         "name the columns with `columns`, for example [\"fps\", \"power_w\"]");
    }
    if (!naming.parameters.empty()) {
        throw InputError(naming.where, fmt::format("{} has names of its parameters", table.file),
                         "leave `parameters` out");
    }
    if (cells.front().text == "time_s") {
        throw InputError({table.file, first_line, cells.front().column},
                         "is a recording of power over time (layer 1), expected a profile of configurations",
                         "use layer 2, which `flightwatt profile` writes as DIR/COMPONENT.csv");
    }
    for (const auto& cell : cells) table.columns.push_back(cell.text);
    return profile_of(table, 1, columns_of_header(table));
}

}  // namespace flightwatt::compute

#include "compute/profile_reader.h"

#include "base/csv.h"
#include "base/number.h"
#include "base/statistics.h"
#include "compute/powprofiler/powprofiler.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

constexpr std::string_view power_column = "power_w";
constexpr std::string_view ignored_column = "_";
constexpr std::string_view error_column = "standard_error_w";
/// What may follow power_w in a profile of ours: on what it rests.
constexpr std::string_view evidence_columns[] = {
    error_column, "total_power_w", "above_idle_power_w", "duration_s", "energy_j", "samples", "repeats", "source"};

void refuse_bad_names(const std::vector<std::string>& parameters, const Location& where) {
    std::set<std::string_view> seen;
    for (const auto& name : parameters) {
        if (name.empty() || name.find_first_of(" \t") != std::string::npos) {
            throw InputError(where, fmt::format("'{}' is no parameter's name", name),
                             "names are not empty and hold no blanks");
        }
        if (!seen.insert(name).second) {
            throw InputError(where, fmt::format("two columns are named '{}'", name));
        }
    }
}

/// The names given must be as many as the file has parameters.
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

/// Rows from `first_row` on as nodes, their parameters in the order of `parameter_columns`.
std::vector<ProfileNode> nodes_of(const CsvTable& table, std::size_t first_row,
                                  const std::vector<std::size_t>& parameter_columns, std::size_t power) {
    std::vector<ProfileNode> nodes;
    for (std::size_t i = first_row; i < table.rows.size(); ++i) {
        const auto& row = table.rows[i];
        ProfileNode node{{}, cell_number(table, row, power), {table.file, row.line}, {}};
        for (const auto column : parameter_columns) node.qos.push_back(cell_number(table, row, column));
        nodes.push_back(std::move(node));
    }
    return nodes;
}

/// How many columns stand before power_w; those after it must be evidence.
std::size_t parameter_count(const CsvTable& table) {
    const auto& header = table.rows.front();
    const auto power = std::ranges::find(header.cells, power_column, &CsvTable::Cell::text);
    if (power == header.cells.end()) {
        throw InputError({table.file, header.line, header.cells.back().column},
                         fmt::format("the last column is '{}', expected '{}'", header.cells.back().text, power_column),
                         "a profile's columns are its parameters and then power_w");
    }
    for (auto cell = power + 1; cell != header.cells.end(); ++cell) {
        if (std::ranges::find(evidence_columns, cell->text) != std::end(evidence_columns)) continue;
        throw InputError({table.file, header.line, cell->column},
                         fmt::format("the column '{}' follows {}", cell->text, power_column),
                         "parameters stand before it, after it only what `flightwatt profile` writes there");
    }
    return static_cast<std::size_t>(power - header.cells.begin());
}

std::optional<std::size_t> place_of(const CsvTable& table, std::string_view column) {
    const auto found = std::ranges::find(table.columns, column);
    if (found == table.columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - table.columns.begin());
}

PowerProfile profile_with_header(CsvTable table, const ProfileNaming& naming) {
    const auto header = table.rows.front();
    if (!naming.parameters.empty()) {
        throw InputError(naming.where, fmt::format("{} names its parameters itself", table.file),
                         "leave `parameters` out");
    }
    if (header.cells.front().text == "time_s") {
        throw InputError({table.file, header.line, header.cells.front().column},
                         "is a recording of power over time (layer 1), expected a profile of configurations",
                         "take layer 2, which `flightwatt profile` writes as DIR/COMPONENT.csv");
    }
    const auto count = parameter_count(table);
    table.rows.erase(table.rows.begin());
    for (const auto& cell : header.cells) table.columns.push_back(cell.text);
    std::vector<std::size_t> columns(count);
    std::iota(columns.begin(), columns.end(), std::size_t{0});
    const std::vector<std::string> parameters(table.columns.begin(),
                                              table.columns.begin() + static_cast<std::ptrdiff_t>(count));
    refuse_bad_names(parameters, {table.file, header.line});
    auto nodes = nodes_of(table, 0, columns, count);
    const auto error = place_of(table, error_column);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto& row = table.rows[i];
        // Of a single sample there is no error.
        if (error && !row.cells[*error].text.empty()) nodes[i].standard_error_w = cell_number(table, row, *error);
    }
    return make_power_profile(table.file, parameters, std::move(nodes));
}

PowerProfile profile_without_header(CsvTable table, const ProfileNaming& naming) {
    const auto& file = table.file;
    const auto width = table.rows.front().cells.size();
    if (naming.columns.size() != width) {
        throw InputError(naming.where,
                         fmt::format("{} columns are named, {} has {}", naming.columns.size(), file, width),
                         "name each column, one power_w, those to pass over _");
    }
    table.columns = naming.columns;
    std::vector<std::string> parameters;
    std::vector<std::size_t> columns;
    std::vector<std::size_t> power;
    for (std::size_t i = 0; i < width; ++i) {
        if (naming.columns[i] == power_column) power.push_back(i);
        if (naming.columns[i] == power_column || naming.columns[i] == ignored_column) continue;
        parameters.push_back(naming.columns[i]);
        columns.push_back(i);
    }
    if (power.size() != 1) {
        throw InputError(naming.where, fmt::format("{} columns are named power_w, expected one", power.size()));
    }
    refuse_bad_names(parameters, naming.where);
    return make_power_profile(file, parameters, nodes_of(table, 0, columns, power.front()));
}

PowerProfile profile_of_combinations(const std::filesystem::path& path, const ProfileNaming& naming) {
    const auto config = read_powprofiler_config(path);
    require_recordings(config, path);
    require_names(naming, config.combinations.front().qos.size(), path.string());
    std::vector<ProfileNode> nodes;
    for (const auto& combination : config.combinations) {
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
    return make_power_profile(table.file, naming.parameters, nodes_of(table, 1, columns.parameters, columns.power));
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
    // Read without header, whatever it has: the first row then tells which format this is.
    auto table = read_csv(path, CsvHeader::absent);
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
        return profile_without_header(std::move(table), naming);
    }
    if (flags) return profile_of_powprofiler(table, *flags, naming);
    if (numbers) {
        throw InputError({table.file, first_line}, "begins with numbers and not with a header",
                         "name the columns with `columns`, for example [\"fps\", \"power_w\"]");
    }
    return profile_with_header(std::move(table), naming);
}

}  // namespace flightwatt::compute

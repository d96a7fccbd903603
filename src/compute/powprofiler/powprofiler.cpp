#include "compute/powprofiler/powprofiler.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "compute/profile_specification.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

double number_in(std::string_view text, const Location& where) {
    if (const auto value = parse_number(trimmed(text))) return *value;
    throw InputError(where, fmt::format("'{}' is not a finite number", trimmed(text)),
                     "write decimals with a point, values apart with a comma");
}

std::vector<double> numbers_in(std::string_view text, const Location& where) {
    std::vector<double> values;
    while (true) {
        const auto comma = text.find(',');
        values.push_back(number_in(text.substr(0, comma), where));
        if (comma == std::string_view::npos) return values;
        text.remove_prefix(comma + 1);
    }
}

struct Property {
    std::string_view name;
    std::string_view value;
};

/// Of a combination at the last '=': values hold none, file names may. Elsewhere it is the other way round.
Property property_of(std::string_view line, bool is_combination, const Location& where) {
    const auto equals = is_combination ? line.rfind('=') : line.find('=');
    if (equals == std::string_view::npos) {
        throw InputError(where, fmt::format("'{}' is neither [section] nor name=value", line));
    }
    return {trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1))};
}

void read_setting(const Property& property, const Location& where, PowprofilerConfig& config) {
    if (property.name == "h" || property.name == "directory") return;
    if (property.name != "frequency") {
        throw InputError(where, fmt::format("unknown setting '{}'", property.name),
                         "known are frequency, h and directory");
    }
    config.sampling_hz = number_in(property.value, where);
    if (config.sampling_hz <= 0.0) {
        throw InputError(where, fmt::format("frequency = {} Hz is not positive", config.sampling_hz));
    }
}

void read_combination(const Property& property, const Location& where, const std::filesystem::path& folder,
                      PowprofilerConfig& config) {
    if (property.name == "name") {
        config.combinations_name = property.value;
        return;
    }
    auto values = numbers_in(property.value, where);
    if (!config.combinations.empty() && config.combinations.front().qos.size() != values.size()) {
        throw InputError(where,
                         fmt::format("{} values, expected {} as in line {}", values.size(),
                                     config.combinations.front().qos.size(), config.combinations.front().where.line));
    }
    config.combinations.push_back({folder / property.name, std::move(values), where});
}

/// "min, max, step" or "min, max, pow(n)".
std::vector<double> range_of(std::string_view text, const Location& where) {
    const auto last = text.rfind(',');
    const auto bounds = numbers_in(text.substr(0, last), where);
    if (last == std::string_view::npos || bounds.size() != 2) {
        throw InputError(where, fmt::format("range = {}, expected min, max, step", text));
    }
    auto step = trimmed(text.substr(last + 1));
    const bool power = step.starts_with("pow(") && step.ends_with(")");
    if (power) step = step.substr(4, step.size() - 5);
    const double by = number_in(step, where);
    if (bounds[0] < 0.0 || bounds[1] < bounds[0] || by <= (power ? 1.0 : 0.0)) {
        throw InputError(where, fmt::format("range = {} is empty or endless", text),
                         "min is 0 or more, max not less, step more than 0, n of pow(n) more than 1");
    }
    const double first = power && bounds[0] <= 0.0 ? 1.0 : bounds[0];
    const double steps = power ? std::log(bounds[1] / first) / std::log(by) : (bounds[1] - first) / by;
    if (!(steps <= static_cast<double>(max_configurations))) {
        throw InputError(where, fmt::format("range = {} makes too many values", text));
    }
    return power ? geometric_range(bounds[0], bounds[1], by) : linear_range(bounds[0], bounds[1], by);
}

void read_component(const Property& property, const Location& where, PowprofilerComponent& component) {
    if (property.name == "src") {
        component.source = property.value;
    } else if (property.name == "fixed") {
        if (property.value.empty()) throw InputError(where, "fixed = nothing, expected an argument");
        component.arguments += " " + std::string(property.value);
    } else if (property.name == "range") {
        component.ranges.push_back(
            {fmt::format("qos_{}", component.ranges.size() + 1), range_of(property.value, where)});
        component.arguments += " {" + component.ranges.back().name + "}";
    } else if (property.name == "runtime") {
        component.runtime_s = units::second_from_millisecond(number_in(property.value, where));
        if (*component.runtime_s <= 0.0) throw InputError(where, "runtime is not positive", "it counts ms");
    } else {
        throw InputError(where, fmt::format("unknown property '{}' of a component", property.name),
                         "known are src, range, fixed and runtime");
    }
}

constexpr std::string_view component_section = "[component.";  // what its name follows

std::string_view begin_section(std::string_view line, const Location& where, PowprofilerConfig& config) {
    if (line == "[settings]" || line == "[components]" || line == "[combinations]") return line;
    const auto name = line.size() > component_section.size() + 1 && line.starts_with(component_section)
                          ? trimmed(line.substr(component_section.size(), line.size() - component_section.size() - 1))
                          : std::string_view();
    if (name.empty()) {
        throw InputError(where, fmt::format("unknown section {}", line),
                         "known are [settings], [components], [component.NAME] and [combinations]");
    }
    config.components.push_back({std::string(name), "", "", {}, {}, where});
    return component_section;
}

}  // namespace

PowprofilerConfig read_powprofiler_config(const std::filesystem::path& path) {
    const auto content = read_file(path);
    PowprofilerConfig config;
    std::string_view section;
    Location where{path.string()};
    for (std::size_t begin = 0; begin < content.size();) {
        const auto whole = std::string_view(content).substr(begin, content.find('\n', begin) - begin);
        begin += whole.size() + 1;
        const auto line = trimmed(whole.substr(0, whole.find('#')));
        ++where.line;
        if (line.empty()) continue;
        if (line.front() == '[' && line.back() == ']') {
            section = begin_section(line, where, config);
        } else if (section == component_section) {
            read_component(property_of(line, false, where), where, config.components.back());
        } else if (section == "[settings]") {
            read_setting(property_of(line, false, where), where, config);
        } else if (section == "[combinations]") {
            read_combination(property_of(line, true, where), where, path.parent_path(), config);
        } else if (section.empty()) {
            throw InputError(where, fmt::format("'{}' stands before any [section]", line));
        } else {
            throw InputError(where, fmt::format("'{}' stands in {}, before any [component.NAME]", line, section));
        }
    }
    for (const auto& component : config.components) {
        if (component.source.empty()) {
            throw InputError(component.where, fmt::format("{} has no src, its program", component.name));
        }
    }
    return config;
}

void require_recordings(const PowprofilerConfig& config, const std::filesystem::path& path) {
    if (config.combinations.empty()) {
        throw InputError({path.string()}, "has no [combinations], lines of file.csv=value,value",
                         "[components] say how to profile, not what came out");
    }
    for (const auto& combination : config.combinations) {
        const auto error = open_error(combination.recording);
        if (!error) continue;
        const auto reason =
            error == std::errc::no_such_file_or_directory ? "does not exist" : "cannot be read: " + error.message();
        throw InputError(combination.where, fmt::format("the recording {} {}", combination.recording.string(), reason));
    }
}

namespace {

/// powprofiler hands the words, joined by blanks, to a shell. Where none of them needs one they are run
/// directly, so that a program that is missing is told from one that fails.
std::vector<std::string> shell_words(const std::string& line) {
    const auto is_plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string_view(" _./,:+@%=-").find(c) != std::string_view::npos;
    };
    if (!std::ranges::all_of(line, is_plain)) return {"/bin/sh", "-c", line};
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
}

ProfiledComponent profiled(const PowprofilerComponent& written) {
    ProfiledComponent component{written.name, {}, {}, {}};
    component.timing.duration_s = written.runtime_s;
    double count = 1.0;
    for (const auto& range : written.ranges) {
        count *= static_cast<double>(range.values.size());
        component.parameters.push_back(range.name);
    }
    if (count > static_cast<double>(max_configurations)) {
        throw InputError(written.where, fmt::format("{} has {} configurations", written.name, count),
                         "profile fewer values");
    }
    for (const auto& qos : cartesian_product(written.ranges)) {
        const auto line = substitute_qos(written.source + written.arguments, component.parameters, qos);
        component.configurations.push_back({qos, {shell_words(line)}, {}});
    }
    return component;
}

ProfiledComponent profiled_combinations(const PowprofilerConfig& config, const std::filesystem::path& path) {
    auto name = std::filesystem::path(config.combinations_name).stem().string();
    if (name.empty()) name = path.stem().string();
    require_recordings(config, path);
    ProfiledComponent component{name, {}, {}, {}};
    for (std::size_t i = 1; i <= config.combinations.front().qos.size(); ++i) {
        component.parameters.push_back(fmt::format("qos_{}", i));
    }
    for (const auto& combination : config.combinations) {
        component.configurations.push_back({combination.qos, {}, combination.recording});
    }
    return component;
}

}  // namespace

ProfileSpecification read_powprofiler_specification(const std::filesystem::path& path) {
    const auto config = read_powprofiler_config(path);
    ProfileSpecification specification;
    specification.file = path.string();
    specification.sampler.folder = path.parent_path();
    specification.sampler.where = {path.string()};
    specification.sampler.interval_s = 1.0 / config.sampling_hz;
    specification.sampler.interval_is_given = true;
    if (!config.combinations.empty()) {
        if (!config.components.empty()) {
            throw InputError(config.components.front().where, "the file has [combinations] and components to run",
                             "keep them in two files");
        }
        specification.sampler.kind = SamplerKind::recorded;
        specification.idle_s = 0.0;
        specification.components.push_back(profiled_combinations(config, path));
        return specification;
    }
    for (const auto& component : config.components) {
        const auto& others = specification.components;
        if (std::ranges::find(others, component.name, &ProfiledComponent::name) != others.end()) {
            throw InputError(component.where, fmt::format("a second component '{}'", component.name));
        }
        specification.components.push_back(profiled(component));
    }
    if (specification.components.empty()) {
        throw InputError({path.string()}, "has neither [component.NAME] nor [combinations]");
    }
    return specification;
}

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

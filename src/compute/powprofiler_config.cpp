#include "compute/powprofiler_config.h"

#include "base/atomic_file.h"
#include "base/number.h"
#include "compute/power_recording.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace flightwatt {
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

/// Splits at the last '=': values hold none, file names may.
Property property_of(std::string_view line, const Location& where) {
    const auto equals = line.rfind('=');
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
    if (property.name == "name") return;
    auto values = numbers_in(property.value, where);
    if (!config.combinations.empty() && config.combinations.front().qos.size() != values.size()) {
        throw InputError(where, fmt::format("{} values, expected {} as in line {}", values.size(),
                                            config.combinations.front().qos.size(),
                                            config.combinations.front().where.line));
    }
    config.combinations.push_back({folder / property.name, std::move(values), where});
}

}  // namespace

PowprofilerConfig read_powprofiler_config(const std::filesystem::path& path) {
    const auto content = read_file(path);
    PowprofilerConfig config{powprofiler_sampling_hz, {}};
    std::string_view rest = content;
    std::string_view section;
    Location where{path.string()};
    while (!rest.empty()) {
        const auto end = std::min(rest.find('\n'), rest.size());
        auto line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        ++where.line;
        line = trimmed(line.substr(0, line.find('#')));
        if (line.empty()) continue;
        if (line.front() == '[' && line.back() == ']') {
            section = line;
        } else if (section == "[settings]") {
            read_setting(property_of(line, where), where, config);
        } else if (section == "[combinations]") {
            read_combination(property_of(line, where), where, path.parent_path(), config);
        } else if (section.empty()) {
            throw InputError(where, fmt::format("'{}' stands before any [section]", line));
        }
    }
    if (config.combinations.empty()) {
        throw InputError({path.string()}, "has no [combinations], lines of file.csv=value,value",
                         "[components] say how to profile, not what came out");
    }
    return config;
}

}  // namespace flightwatt

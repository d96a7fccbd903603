#include "mission/file/utility_toml.h"

#include "base/toml_numbers.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

std::optional<std::size_t> read_parameter(const TomlTable& table, const compute::PowerProfile& profile) {
    const auto& known = profile.parameters;
    const auto name = table.optional_string("parameter");
    if (!name) {
        if (known.empty()) return std::nullopt;
        if (known.size() == 1) return 0;
        throw InputError(
            table.where(),
            fmt::format("the profile has {} parameters: which one has the utility?", known.size()),
            fmt::format("add parameter = ..., one of {}", fmt::join(known, ", ")));
    }
    const auto found = std::find(known.begin(), known.end(), *name);
    if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
    throw InputError(table.where("parameter"), fmt::format("the profile has no parameter '{}'", *name),
                     known.empty() ? "it has none: leave `parameter` out"
                                   : fmt::format("its parameters are {}", fmt::join(known, ", ")));
}

UtilityShape read_shape(const TomlTable& table) {
    const auto name = table.optional_string("shape").value_or("linear");
    if (name == "linear") return UtilityShape::linear;
    if (name == "sqrt") return UtilityShape::square_root;
    if (name == "log") return UtilityShape::logarithm;
    if (name == "points") return UtilityShape::points;
    throw InputError(table.where("shape"), fmt::format("there is no shape '{}'", name),
                     R"(it is "linear", "sqrt", "log" or "points")");
}

void require_defined(const TomlTable& table, UtilityShape shape, double least_qos) {
    const bool defined = shape == UtilityShape::square_root ? least_qos >= 0.0
                         : shape == UtilityShape::logarithm ? least_qos > -1.0
                                                            : true;
    if (defined) return;
    throw InputError(table.where("shape"),
                     fmt::format("this shape has no value at {}, where the profile begins", least_qos),
                     R"(use "linear" or "points")");
}

/// The key of the points' values; files of version 0.1 call it `worth`.
std::string_view value_key(const TomlTable& table) { return table.has("worth") ? "worth" : "value"; }

void read_points(const TomlTable& table, const std::vector<double>& axis, Utility& utility) {
    const auto value = value_key(table);
    utility.points_qos = table.numbers("qos");
    utility.points_value = table.numbers(value);
    const auto& x = utility.points_qos;
    const auto& y = utility.points_value;
    if (x.size() < 2 || x.size() != y.size()) {
        throw InputError(
            table.where(value),
            fmt::format("{} numbers of qos and {} of {} are no points", x.size(), y.size(), value),
            "give as many of each, 2 or more");
    }
    if (std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) != x.end()) {
        throw InputError(table.where("qos"), "the values of qos do not rise");
    }
    if (!std::is_sorted(y.begin(), y.end())) {
        throw InputError(table.where(value),
                         fmt::format("{} falls: better quality cannot have less utility", value),
                         "the numbers must not fall");
    }
    if (x.front() > axis.front() || x.back() < axis.back()) {
        throw InputError(table.where("qos"),
                         fmt::format("the points from {} to {} do not cover the profile's range, {} to {}",
                                     x.front(), x.back(), axis.front(), axis.back()),
                         "add points at its ends");
    }
}

}  // namespace

Utility read_utility(const TomlTable& table, const compute::PowerProfile& profile) {
    table.refuse_keys_except({"parameter", "weight", "shape", "qos", "value", "worth"});
    Utility utility;
    utility.parameter = read_parameter(table, profile);
    utility.weight = number_in_or(at_least(0.0), table, "weight", 1.0);
    if (table.has("value") && table.has("worth")) {
        throw InputError(table.where("worth"), "`worth` is the older name of `value`, and both are there",
                         "remove `worth`");
    }
    utility.shape = read_shape(table);
    const bool has_points = utility.shape == UtilityShape::points;
    for (const std::string_view key : {"shape", "qos", "value", "worth"}) {
        if (!table.has(key) || (utility.parameter && (has_points || key == "shape"))) continue;
        throw InputError(table.where(key), fmt::format("`{}` has no meaning here", key),
                         utility.parameter ? R"(it belongs to shape = "points")"
                                           : "the profile has no parameter: leave it out");
    }
    if (!utility.parameter) return utility;
    const auto& axis = profile.axes[*utility.parameter];
    require_defined(table, utility.shape, axis.front());
    if (has_points) read_points(table, axis, utility);
    return utility;
}

}  // namespace flightwatt::mission

#include "compute/compute_model.h"

#include "base/number.h"
#include "base/piecewise_linear.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

std::vector<double> axis_of(const std::vector<ProfileNode>& nodes, std::size_t parameter) {
    std::set<double> axis;
    for (const auto& node : nodes) axis.insert(node.qos.at(parameter));
    return {axis.begin(), axis.end()};
}

/// `sorted` must be the grid. Iterates over nodes: the grid of a wrong file of n rows may have n^d points.
void require_full_grid(const PowerProfile& profile, const std::vector<ProfileNode>& sorted) {
    std::vector<std::size_t> counts;
    double grid_size = 1.0;
    for (const auto& axis : profile.axes) {
        counts.push_back(axis.size());
        grid_size *= static_cast<double>(axis.size());
    }
    std::size_t k = 0;
    while (k < sorted.size() && static_cast<double>(k) < grid_size && sorted[k].qos == grid_point(profile.axes, k)) ++k;
    const auto text_of = [&](const auto& qos) { return format_qos(profile.parameters, qos, " = ", ", "); };
    if (k > 0 && k < sorted.size() && sorted[k].qos == sorted[k - 1].qos) {
        const auto node = profile.parameters.empty() ? "a profile without parameters" : text_of(sorted[k].qos);
        throw InputError(sorted[k].where,
                         fmt::format("{} has a second node, the first is in line {}", node, sorted[k - 1].where.line),
                         "keep one row for each configuration");
    }
    if (static_cast<double>(k) >= grid_size) return;
    throw InputError(
        {profile.file},
        fmt::format("the grid is incomplete: there is no node at {}", text_of(grid_point(profile.axes, k))),
        fmt::format("profile every combination of the values, here {} nodes", fmt::join(counts, " x ")));
}

constexpr double rounding = 1e-9;  // of a step

double rounded(double value) { return number_or_nan(fmt::format("{:.12g}", value)); }

}  // namespace

PowerProfile make_power_profile(const std::string& file, const std::vector<std::string>& parameters,
                                std::vector<ProfileNode> nodes) {
    if (nodes.empty()) throw InputError({file}, "has no nodes, expected at least one profiled configuration");
    // Lexicographic order of the QoS is the grid's order; stable, so that an error names the second of two equals.
    std::ranges::stable_sort(nodes, {}, &ProfileNode::qos);
    PowerProfile profile{file, parameters, {}, {}};
    for (std::size_t i = 0; i < parameters.size(); ++i) profile.axes.push_back(axis_of(nodes, i));
    require_full_grid(profile, nodes);
    for (const auto& node : nodes) {
        profile.power_w.push_back(node.power_w);
        if (node.standard_error_w) profile.standard_error_w.push_back(*node.standard_error_w);
    }
    if (profile.standard_error_w.size() < nodes.size()) profile.standard_error_w.clear();
    return profile;
}

std::string remove_negative_power(PowerProfile& profile) {
    if (profile.power_w.empty()) return "";
    const auto min_at = std::ranges::min_element(profile.power_w);
    const double lowest_w = *min_at;
    if (lowest_w >= 0.0) return "";
    const auto node = grid_point(profile.axes, static_cast<std::size_t>(min_at - profile.power_w.begin()));
    const auto at = profile.parameters.empty() ? "" : " at " + format_qos(profile.parameters, node, " = ", ", ");
    for (auto& power_w : profile.power_w) power_w = std::max(power_w, 0.0);
    return fmt::format(
        "{}: {:.3g} W{}: software does not return power, and counts as 0; state may_charge = true if a "
        "source aboard charges the battery",
        profile.file, lowest_w, at);
}

void require_in_range(const PowerProfile& profile, std::size_t parameter, double value, const Location& where) {
    const auto& axis = profile.axes.at(parameter);
    if (value >= axis.front() && value <= axis.back()) return;
    throw InputError(where,
                     fmt::format("{} = {} is outside of the profiled range {} .. {} of {}",
                                 profile.parameters[parameter], value, axis.front(), axis.back(), profile.file),
                     "choose a value within it, or profile the component there");
}

double power_w(const PowerProfile& profile, const std::vector<double>& qos) {
    if (qos.size() != profile.axes.size()) {
        throw std::invalid_argument("the number of QoS values is not that of the parameters");
    }
    std::vector<KnotInterval> places;
    for (std::size_t i = 0; i < qos.size(); ++i) {
        require_in_range(profile, i, qos[i], {profile.file});
        const auto& axis = profile.axes[i];
        places.push_back(axis.size() == 1 ? KnotInterval{} : find_knot_interval(axis, qos[i]));
    }
    // The sum over the 2^d corners of the cell, bit i of `corner` choosing the upper node of axis i.
    double power = 0.0;
    for (std::size_t corner = 0; corner < (std::size_t{1} << places.size()); ++corner) {
        double weight = 1.0;
        std::size_t index = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const std::size_t upper = (corner >> i) & 1U;
            weight *= upper == 1 ? places[i].fraction : 1.0 - places[i].fraction;
            index = index * profile.axes[i].size() + places[i].lower + upper;
        }
        if (weight > 0.0) power += weight * profile.power_w[index];
    }
    return power;
}

LeaveOneOutErrors leave_one_out(const PowerProfile& profile) {
    LeaveOneOutErrors errors;
    double squares = 0.0;
    for (std::size_t k = 0; k < profile.power_w.size(); ++k) {
        double sum_w = 0.0;
        int ways = 0;
        std::size_t stride = 1;
        for (std::size_t i = profile.axes.size(); i-- > 0;) {
            const auto& axis = profile.axes[i];
            const auto at = k / stride % axis.size();
            if (at > 0 && at + 1 < axis.size()) {
                const double fraction = (axis[at] - axis[at - 1]) / (axis[at + 1] - axis[at - 1]);
                sum_w += std::lerp(profile.power_w[k - stride], profile.power_w[k + stride], fraction);
                ++ways;
            }
            stride *= axis.size();
        }
        if (ways == 0) continue;
        const double error_w = std::abs(sum_w / ways - profile.power_w[k]);
        ++errors.nodes;
        errors.mean_absolute_w += error_w;
        errors.mean_absolute_percent += units::percentage(error_w, std::abs(profile.power_w[k]));
        errors.largest_w = std::max(errors.largest_w, error_w);
        squares += error_w * error_w;
    }
    const auto count = static_cast<double>(std::max<std::size_t>(errors.nodes, 1));
    errors.mean_absolute_w /= count;
    errors.mean_absolute_percent /= count;
    errors.rms_w = std::sqrt(squares / count);
    return errors;
}

double power_w(const ComputeModel& model, const Configuration& configuration) {
    double power = 0.0;
    for (const auto& running : configuration) {
        power += power_w(model.components.at(running.component).profile, running.qos);
    }
    return power;
}

std::string describe(const ComputeModel& model, const Configuration& configuration, std::string_view equals) {
    std::string text;
    for (const auto& running : configuration) {
        const auto& component = model.components.at(running.component);
        text += (text.empty() ? "" : ", ") + component.name;
        if (!running.qos.empty()) text += " " + format_qos(component.profile.parameters, running.qos, equals);
    }
    return text.empty() ? "nothing" : text;
}

std::vector<double> linear_range(double from, double to, double step) {
    std::vector<double> values;
    const double steps = std::floor((to - from) / step + rounding);
    for (int i = 0; i <= steps; ++i) values.push_back(rounded(from + i * step));
    return values;
}

std::vector<double> grid_point(const std::vector<std::vector<double>>& axes, std::size_t index) {
    std::vector<double> point(axes.size());
    for (std::size_t i = axes.size(); i-- > 0;) {
        point[i] = axes[i][index % axes[i].size()];
        index /= axes[i].size();
    }
    return point;
}

QosPoints cartesian_product(const std::vector<QosRange>& ranges) {
    std::vector<std::vector<double>> axes;
    std::size_t count = 1;
    for (const auto& range : ranges) {
        axes.push_back(range.values);
        count *= range.values.size();
    }
    QosPoints points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(grid_point(axes, i));
    return points;
}

std::string format_qos(const std::vector<std::string>& parameters, const std::vector<double>& qos,
                       std::string_view equals, std::string_view between) {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < qos.size(); ++i) {
        parts.push_back(fmt::format("{}{}{}", parameters[i], equals, qos[i]));
    }
    return fmt::format("{}", fmt::join(parts, between));
}

std::string substitute_qos(const std::string& text, const std::vector<std::string>& parameters,
                           const std::vector<double>& qos) {
    auto result = text;
    for (std::size_t i = 0; i < parameters.size(); ++i)
        boost::algorithm::replace_all(result, "{" + parameters[i] + "}", fmt::format("{}", qos[i]));
    return result;
}

}  // namespace flightwatt::compute

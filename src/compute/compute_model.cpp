#include "compute/compute_model.h"

#include "base/piecewise_linear.h"
#include "compute/qos_range.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::compute {
namespace {

std::vector<double> axis_of(const std::vector<ProfileNode>& nodes, std::size_t parameter) {
    std::set<double> axis;
    for (const auto& node : nodes) axis.insert(node.qos.at(parameter));
    return {axis.begin(), axis.end()};
}

void refuse_duplicates(const std::vector<std::string>& parameters, const std::vector<ProfileNode>& sorted) {
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        if (sorted[i].qos != sorted[i - 1].qos) continue;
        const auto what =
            parameters.empty() ? "a profile without parameters" : format_qos(parameters, sorted[i].qos, " = ", ", ");
        throw InputError(sorted[i].where,
                         fmt::format("{} has a second node, the first is in line {}", what, sorted[i - 1].where.line),
                         "keep one row for each configuration");
    }
}

/// The node that stands at `index` in row-major order.
std::vector<double> grid_point(const std::vector<std::vector<double>>& axes, std::size_t index) {
    std::vector<double> point(axes.size());
    for (std::size_t i = axes.size(); i-- > 0;) {
        point[i] = axes[i][index % axes[i].size()];
        index /= axes[i].size();
    }
    return point;
}

/// `sorted` must be the grid, point for point; the first difference is a node that is missing. Walking the
/// nodes rather than the grid keeps a mistaken file of n rows from asking for n^d points.
void require_full_grid(const PowerProfile& profile, const std::vector<ProfileNode>& sorted) {
    std::vector<std::size_t> counts;
    double grid_size = 1.0;
    for (const auto& axis : profile.axes) {
        counts.push_back(axis.size());
        grid_size *= static_cast<double>(axis.size());
    }
    std::size_t k = 0;
    while (k < sorted.size() && sorted[k].qos == grid_point(profile.axes, k)) ++k;
    if (static_cast<double>(k) >= grid_size) return;
    throw InputError({profile.file},
                     fmt::format("the grid is incomplete: there is no node at {}",
                                 format_qos(profile.parameters, grid_point(profile.axes, k), " = ", ", ")),
                     fmt::format("profile every combination of the values, here {} nodes", fmt::join(counts, " x ")));
}

}  // namespace

PowerProfile make_power_profile(const std::string& file, const std::vector<std::string>& parameters,
                                std::vector<ProfileNode> nodes) {
    if (nodes.empty()) throw InputError({file}, "has no nodes, expected at least one profiled configuration");
    // Lexicographic order of the QoS is the grid's order; stable, so that the second of two equals is blamed.
    std::ranges::stable_sort(nodes, {}, &ProfileNode::qos);
    refuse_duplicates(parameters, nodes);
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

std::string negative_power_warning(const PowerProfile& profile) {
    if (profile.power_w.empty()) return "";
    const auto least = std::ranges::min_element(profile.power_w);
    if (*least >= 0.0) return "";
    const auto node = grid_point(profile.axes, static_cast<std::size_t>(least - profile.power_w.begin()));
    const auto at = profile.parameters.empty() ? "" : " at " + format_qos(profile.parameters, node, " = ", ", ");
    return fmt::format(
        "{}: {:.3g} W{}: software that gives power back does not exist; within the noise of the profile "
        "it is 0",
        profile.file, *least, at);
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

}  // namespace flightwatt::compute

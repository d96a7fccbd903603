#include "path/plans/fence.h"

#include "path/path_entries.h"

#include <cmath>
#include <numbers>

namespace flightwatt::path {
namespace {

using Corners = std::vector<GeodeticPosition>;

GeodeticPosition place_of(const Json& corner) { return {corner.at(0).get<double>(), corner.at(1).get<double>()}; }

Corners circle_of(const Json& circle) {
    constexpr int count = 32;
    const auto centre = place_of(circle.at("center"));
    const double radius_m = circle.at("radius").get<double>() / std::cos(std::numbers::pi / count);
    Corners corners;
    for (int i = 0; i < count; ++i) corners.push_back(to_geodetic(moved({}, radius_m, i * 360.0 / count), centre));
    return corners;
}

PlanFence read_parts(const Json& fence) {
    PlanFence read;
    const auto list_of = [&](const Json& part) -> auto& {
        return part.at("inclusion").get<bool>() ? read.included : read.excluded;
    };
    for (const auto& part : fence.value("polygons", Json::array())) {
        auto& corners = list_of(part).emplace_back();
        for (const auto& corner : part.at("polygon")) corners.push_back(place_of(corner));
    }
    for (const auto& part : fence.value("circles", Json::array()))
        list_of(part).push_back(circle_of(part.at("circle")));
    return read;
}

}  // namespace

PlanFence read_fence(const Json& plan) {
    if (!plan.contains("geoFence")) return {};
    try {
        return read_parts(plan["geoFence"]);
    } catch (const Json::exception&) {
        return {{}, {}, false};
    }
}

}  // namespace flightwatt::path

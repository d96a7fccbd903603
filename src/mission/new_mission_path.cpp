#include "mission/new_mission_path.h"

#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "base/units.h"
#include "path/area.h"
#include "path/plan_blocks.h"
#include "path/turns.h"
#include "path/waypoint_files.h"

#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double bank_deg = 30.0;  // of turns that a plan leaves open

/// In whole metres.
double turn_radius_m(double airspeed_m_per_s) { return std::ceil(path::turn_radius_m(airspeed_m_per_s, bank_deg)); }

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// Whether it is a plan of Paparazzi, and not KML, which is XML, too.
bool has_blocks(std::string_view text) {
    return path::plan_format(text) == path::PlanFormat::flight_plan && !has(text, "<kml");
}

bool is_area_text(std::string_view text) {
    return path::plan_format(text) == path::PlanFormat::flight_plan
               ? !has_blocks(text) && has(text, "<outerBoundaryIs")
               : (has(text, "\"Polygon\"") || has(text, "\"MultiPolygon\"")) && !has(text, "\"fileType\"");
}

/// The course of the lines with the fewest turns, the first of equals.
double best_heading_deg(std::string_view text, const std::string& file, double spacing_m) {
    constexpr double step_deg = 5.0;
    constexpr double half_turn_deg = 180.0;
    std::optional<std::size_t> fewest;
    double best_deg = 0.0;
    for (double heading_deg = 0.0; heading_deg < half_turn_deg; heading_deg += step_deg) {
        const auto count = path::parse_area(text, file, {heading_deg, {{spacing_m}}}).entries.size();
        if (fewest && count >= *fewest) continue;
        fewest = count;
        best_deg = heading_deg;
    }
    return best_deg;
}

/// The distance between the lines over an area, with the reason.
std::pair<double, std::string> choose_spacing(const PlanToFly& plan, double airspeed_m_per_s, bool is_rotorcraft) {
    constexpr double usual_m = 25.0;  // of a camera 50 m above the ground, with images that overlap by half
    if (plan.spacing_m) return {*plan.spacing_m, "as asked"};
    if (plan.overlap_percent)
        return {*plan.swath_m * (units::percent_per_whole - *plan.overlap_percent) / units::percent_per_whole,
                fmt::format("images {:g} m wide overlap by {:g} %", *plan.swath_m, *plan.overlap_percent)};
    if (is_rotorcraft) return {usual_m, "assumed: your camera and height decide it (--swath, --overlap)"};
    return {2.0 * turn_radius_m(airspeed_m_per_s), fmt::format("for turns with a bank of {} degrees", bank_deg)};
}

NewPath path_of_area(std::string_view text, const PlanToFly& plan, double airspeed_m_per_s, bool is_rotorcraft) {
    const auto [spacing_m, spacing_reason] = choose_spacing(plan, airspeed_m_per_s, is_rotorcraft);
    const double heading_deg =
        plan.heading_deg ? *plan.heading_deg : best_heading_deg(text, plan.file.string(), spacing_m);
    return {{fmt::format("area = {}", toml_string(plan.name)), fmt::format("spacing_m = {}", spacing_m),
             fmt::format("heading_deg = {}", heading_deg)},
            {fmt::format("spacing_m = {}, {}", spacing_m, spacing_reason),
             fmt::format("heading_deg = {}, {}", heading_deg, plan.heading_deg ? "as asked" : "for the fewest turns")}};
}

/// The only block that is flown. Throws UsageError for several.
std::vector<std::string> only_block(std::string_view text, const std::string& file, double airspeed_m_per_s) {
    std::vector<std::string> flown;
    for (const auto& block : path::parse_plan(text, file, {turn_radius_m(airspeed_m_per_s), airspeed_m_per_s}))
        if (!block.flown.empty()) flown.push_back(block.name);
    if (flown.size() == 1) return flown;
    throw UsageError(
        fmt::format("{} has several blocks: name those of the mission, in the order of the flight, each "
                    "with --block NAME. Those with a path: {}",
                    file, short_list(flown)));
}

/// "start = { latitude_deg = 43.46, longitude_deg = 1.27 }", or in metres from the origin of a flight plan.
std::string start_key(const path::GeodeticPosition& home, std::string_view flight_plan, const std::string& file) {
    if (flight_plan.empty())
        return fmt::format("start = {{ latitude_deg = {}, longitude_deg = {} }}", home.latitude_deg,
                           home.longitude_deg);
    const auto [east_m, north_m] = path::to_local(home, path::flight_plan_origin(flight_plan, file).first);
    return fmt::format("start = {{ east_m = {:.2f}, north_m = {:.2f} }}", east_m, north_m);
}

/// The waypoint HOME of a flight plan, as a key; empty without one.
std::string home_key(std::string_view flight_plan, const std::string& file) {
    try {
        const auto home = path::parse_flight_plan(flight_plan, file, {"HOME"}).front().place;
        if (home) return fmt::format("start = {{ east_m = {:.2f}, north_m = {:.2f} }}", home->east_m, home->north_m);
    } catch (const InputError&) {  // no such waypoint
    }
    return "";
}

NewPath open_path_of_plan(const PlanToFly& plan, double airspeed_m_per_s, bool is_rotorcraft) {
    const auto& file = plan.file;
    auto blocks = plan.blocks;
    const auto text = read_file(file);
    const bool of_blocks = has_blocks(text);
    const auto start = plan.home   ? start_key(*plan.home, of_blocks ? text : "", file.string())
                       : of_blocks ? home_key(text, file.string())
                                   : "";
    if (plan.terrain && (of_blocks || is_area_text(text)))
        throw UsageError(fmt::format("{} has no altitudes above the terrain: --terrain has no meaning", file.string()));
    if (is_area_text(text)) {
        if (!of_blocks && has(text, "<LineString"))
            throw InputError({file.string()}, "has a path (LineString) and an area (Polygon)",
                             "save the one that is to be flown in a file of its own");
        auto path = path_of_area(text, plan, airspeed_m_per_s, is_rotorcraft);
        if (plan.home) path.keys.push_back(start);
        return path;
    }
    if (plan.spacing_m || plan.overlap_percent || plan.heading_deg)
        throw UsageError(
            fmt::format("{} is no area (GeoJSON, KML): its lines have no spacing and heading to state", file.string()));
    if (of_blocks && blocks.empty()) blocks = only_block(text, file.string(), airspeed_m_per_s);
    const auto read = [&](std::optional<double> radius_m) {
        const path::AutopilotSettings settings{
            radius_m, airspeed_m_per_s, is_rotorcraft, false, plan.terrain.value_or(""), {}, {}, plan.home};
        return of_blocks ? path::parse_plan_blocks(text, file.string(), blocks, settings)
                         : path::read_waypoints(file, settings);
    };
    NewPath path{{fmt::format("{} = {}", of_blocks ? "flight_plan" : "waypoints", toml_string(plan.name))}, {}};
    if (!start.empty()) path.keys.push_back(start);
    if (of_blocks && !plan.home && !start.empty()) path.chosen.push_back(start + ", the plan's HOME");
    if (of_blocks) path.keys.push_back("blocks = " + toml_strings(blocks));
    if (plan.terrain) path.keys.push_back("terrain = " + toml_string(plan.terrain_name));
    path::PlanEntries entries;
    try {
        entries = read(std::nullopt);
    } catch (const InputError&) {  // it may leave a radius to the autopilot
        const double radius_m = turn_radius_m(airspeed_m_per_s);
        entries = read(radius_m);
        path.keys.push_back(fmt::format("radius_m = {}", radius_m));
        path.chosen.push_back(fmt::format("radius_m = {}, for circles with a bank of {} degrees", radius_m, bank_deg));
    }
    for (const auto& entry : entries.entries)
        if (entry.airspeed_m_per_s) path.own_m_per_s.insert(*entry.airspeed_m_per_s);
    path.speed = std::move(entries.speed);
    path.lands = entries.ends_with_landing;
    return path;
}

}  // namespace

bool is_area(const std::filesystem::path& file) { return is_area_text(read_file(file)); }

NewPath path_of_plan(const PlanToFly& plan, double airspeed_m_per_s, bool is_rotorcraft) {
    auto path = open_path_of_plan(plan, airspeed_m_per_s, is_rotorcraft);
    if (path.lands) {
        path.chosen.emplace_back("no return to the start: the plan ends with a landing");
        return path;
    }
    path.keys.emplace_back("return_to_start = true");
    path.chosen.emplace_back("return_to_start = true: from its end straight back; without it, it lands where it ends");
    return path;
}

}  // namespace flightwatt::mission

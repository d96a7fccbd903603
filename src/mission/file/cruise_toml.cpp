#include "mission/file/cruise_toml.h"

#include "base/input_file.h"
#include "base/units.h"
#include "mission/file/airspeed_toml.h"
#include "mission/file/named_file.h"
#include "mission/file/planning_toml.h"
#include "mission/file/takeoff_height.h"
#include "mission/planning/survey_layouts.h"
#include "path/area.h"
#include "path/cruise_path.h"
#include "path/path_entries.h"
#include "path/plan_blocks.h"
#include "path/plan_fence.h"
#include "path/plan_files.h"
#include "path/trajectory.h"
#include "path/waypoint_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr double max_wind_m_per_s = 100.0;

/// Of one or two flights the terms for turns, climbs and gusts are not known. Where level flight straight ahead would take
/// less than three quarters of their power, the rest is added to the power along a path.
void add_unexplained_power(mechanical::PhysicalModel& power, MissionSetup& mission) {
    constexpr std::size_t enough_flights = 3;
    constexpr double max_unexplained_part = 0.25;
    const auto& model = *mission.mechanical;
    const double added_w = power_beyond_straight_flight_w(model);
    const double cruise_w = mean_power_w(model.phases[Phase::cruise]);
    if (model.flights.size() >= enough_flights || added_w <= max_unexplained_part * cruise_w) return;
    add_constant_power(added_w, power);
    mission.notes.push_back(fmt::format(
        "path: {:.0f} W are added to level flight straight ahead, which turns, climbs and gusts of the model's flights "
        "took: fewer than three do not show how much each takes",
        added_w));
}

bool may_be_predicted(double airspeed_m_per_s, const mechanical::PhysicalModel& physical, bool is_rotorcraft) {
    return airspeed_m_per_s >= min_predicted_airspeed_m_per_s(physical, is_rotorcraft) &&
           airspeed_m_per_s <= max_predicted_airspeed_m_per_s(physical);
}

path::Wind read_wind(const TomlTable& root) {
    path::Wind wind;
    const auto table = root.optional_table("wind");
    if (!table) return wind;
    table->refuse_keys_except({"speed_m_per_s", "from_deg", "speed_sd_m_per_s", "direction_sd_deg"});
    wind.speed_m_per_s = number_in(between(0.0, max_wind_m_per_s), *table, "speed_m_per_s");
    wind.speed_sd_m_per_s = number_in_or(between(0.0, max_wind_m_per_s), *table, "speed_sd_m_per_s", 0.0);
    const bool is_calm = wind.speed_m_per_s == 0.0 && wind.speed_sd_m_per_s == 0.0;
    wind.from_deg = is_calm ? number_in_or(between(-360.0, 360.0), *table, "from_deg", 0.0)
                            : number_in(between(-360.0, 360.0), *table, "from_deg");
    wind.direction_sd_deg = number_in_or(between(0.0, 360.0), *table, "direction_sd_deg", 0.0);
    return wind;
}

path::ClimbRates read_rates(const TomlTable& table) {
    const auto rates = more_than_up_to(0.0, path::max_m_per_s);
    return {optional_number_in(rates, table, "climb_m_per_s"), optional_number_in(rates, table, "descent_m_per_s")};
}

constexpr auto place_hint = "give east_m and north_m, or latitude_deg and longitude_deg";

/// The place that a table gives, in either coordinates.
void read_place(const TomlTable& table, std::optional<path::LocalPosition>& local,
                std::optional<path::GeodeticPosition>& geographic) {
    const auto metres = between(-1e7, 1e7);
    if (table.has("east_m") || table.has("north_m"))
        local = path::LocalPosition{number_in(metres, table, "east_m"), number_in(metres, table, "north_m")};
    if (table.has("latitude_deg") || table.has("longitude_deg")) {
        geographic = path::GeodeticPosition{number_in(between(-90.0, 90.0), table, "latitude_deg"),
                                            number_in(between(-180.0, 180.0), table, "longitude_deg")};
    }
    if (local && geographic) throw InputError(table.where(), "a place in metres and in degrees", "give one of them");
}

path::PathEntry read_leg(const TomlTable& leg, std::size_t number) {
    leg.refuse_keys_except({"east_m", "north_m", "latitude_deg", "longitude_deg", "length_m", "course_deg",
                            "duration_s", "altitude_m", "airspeed_m_per_s", "climb_m_per_s", "descent_m_per_s",
                            "circles", "radius_m", "turn", "hold_s"});
    path::PathEntry entry;
    entry.name = fmt::format("leg {}", number);
    entry.where = leg.where();
    read_place(leg, entry.place, entry.geographic);
    entry.length_m = optional_number_in(more_than_up_to(0.0, path::max_leg_m), leg, "length_m");
    entry.course_deg = optional_number_in(between(-360.0, 360.0), leg, "course_deg");
    for (const auto& [name, value, range] : path::entry_values) entry.*value = optional_number_in(range, leg, name);
    entry.rates = read_rates(leg);
    if (const auto turn = leg.optional_string("turn")) {
        if (*turn != "left" && *turn != "right")
            throw InputError(leg.where("turn"), fmt::format("there is no turn '{}'", *turn),
                             "it is \"left\" or \"right\"");
        if (!entry.circles) throw InputError(leg.where("turn"), "turn belongs to circles", "leave it out");
        entry.to_right = *turn == "right";
    }
    return entry;
}

constexpr auto airspeeds = more_than_up_to(0.0, path::max_m_per_s);
constexpr auto spacings = between(path::min_radius_m, path::max_radius_m);
constexpr auto headings = between(-360.0, 360.0);

/// The values of a key: a number, or those that a plan chooses between.
std::vector<double> read_levels(const TomlTable& path, std::string_view key, NumberRange range) {
    if (!path.is_table(key)) return {number_in(range, path, key)};
    const auto table = path.table(key);
    table.refuse_keys_except({"min", "max", "steps", "levels", "blocks"});
    if (key != "spacing_m" && table.has("blocks"))
        throw InputError(table.where("blocks"), "blocks belongs to spacing_m", "leave it out");
    if (table.has("levels")) {
        for (const auto* other : {"min", "max", "steps"})
            if (table.has(other))
                throw InputError(table.where(other), fmt::format("{} and levels are two choices", other), "give one");
        auto levels = table.numbers("levels");
        if (levels.size() < 2)
            throw InputError(table.where("levels"), "fewer than two levels leave no choice", "give a number instead");
        for (const double level : levels) require_in(range, level, key, table.where("levels"));
        return levels;
    }
    constexpr std::uint64_t usual_steps = 5;
    const double min = number_in(range, table, "min");
    const double max = number_in(more_than_up_to(min, range.high), table, "max");
    const auto steps = static_cast<std::size_t>(count_in_or(table, "steps", 2, usual_steps));
    require_in(at_most(max_survey_layouts), static_cast<double>(steps), "steps", table.where("steps"));
    std::vector<double> levels;
    for (std::size_t i = 0; i < steps; ++i)
        levels.push_back(min + (max - min) * static_cast<double>(i) / static_cast<double>(steps - 1));
    return levels;
}

std::vector<path::SurveyStrip> read_strips(const TomlTable& path) {
    std::vector<path::SurveyStrip> strips;
    for (const auto& table : path.tables("strip")) {
        table.refuse_keys_except({"to", "spacing_m", "airspeed_m_per_s"});
        const double from = strips.empty() ? 0.0 : strips.back().to;
        strips.push_back({number_in(spacings, table, "spacing_m"), number_in(more_than_up_to(from, 1.0), table, "to"),
                          optional_number_in(airspeeds, table, "airspeed_m_per_s")});
    }
    if (strips.back().to < 1.0)
        throw InputError(path.where("strip"), "the last strip ends before the area does", "give it to = 1");
    return strips;
}

/// The lines over the area of a path.
path::SurveyLayout read_layout(const TomlTable& path, const MissionReadOptions& reading) {
    if (reading.survey) return *reading.survey;
    if (path.has("spacing_m") == path.has("strip") || !path.has("heading_deg"))
        throw InputError(path.where("area"), "an area needs spacing_m and heading_deg",
                         "give the distance between its lines, spacing_m = 30, or [[path.strip]], and their direction "
                         "clockwise from north, heading_deg = 90");
    path::SurveyLayout layout{read_levels(path, "heading_deg", headings).front(), {}};
    if (path.has("strip"))
        layout.strips = read_strips(path);
    else
        layout.strips = {{std::ranges::max(read_levels(path, "spacing_m", spacings))}};
    if (path.is_table("airspeed_m_per_s"))
        layout.strips.front().airspeed_m_per_s = read_levels(path, "airspeed_m_per_s", airspeeds).front();
    return layout;
}

bool is_chosen(const TomlTable& path) {
    return std::ranges::any_of(std::array{"spacing_m", "heading_deg", "airspeed_m_per_s"},
                               [&](const char* key) { return path.is_table(key); });
}

/// How the lines cover the area, without times.
SurveyCoverage read_coverage(const TomlTable& path, const path::SurveyLayout& layout, const path::SurveyPlan& survey) {
    SurveyCoverage coverage{layout, is_chosen(path), {}, 0.0, {}, survey.has_zones};
    for (const double to : survey.line_to) coverage.lines.push_back({0.0, 0.0, to});
    if (path.has("swath_m") != path.has("utility"))
        throw InputError(path.where(), "swath_m and utility belong together", "add the other, or leave this out");
    if (!path.has("utility")) return coverage;
    const double swath_m = number_in(spacings, path, "swath_m");
    const auto utility = read_utility(path.table("utility"), {path.file(), {"coverage"}, {{0.0}}, {}});
    double area_m2 = 0.0;
    double lines_m = 0.0;
    double sum = 0.0;
    for (const auto& strip : survey.strips) {
        if (!(strip.area_m2 > 0.0)) continue;
        area_m2 += strip.area_m2;
        lines_m += strip.lines_m;
        sum += strip.area_m2 * utility_per_s(utility, {swath_m * strip.lines_m / strip.area_m2});
    }
    coverage.coverage = swath_m * lines_m / area_m2;
    coverage.utility = sum / area_m2;
    return coverage;
}

/// Sets when each line of a survey is flown.
void set_line_times(const path::FlightPath& path, const path::PathTrajectory& flown, SurveyCoverage& survey) {
    double start_s = 0.0;
    std::size_t last = 0;
    for (std::size_t i = 0; i < path.elements.size(); ++i) {
        const double end_s = start_s + flown.element_s[i];
        if (const auto line = path.elements[i].survey_line; line > 0) {
            auto& time = survey.lines[line - 1];
            if (std::exchange(last, line) != line) time.start_s = start_s;
            time.end_s = end_s;
        }
        start_s = end_s;
    }
}

void read_path_airspeed(const TomlTable& path, const MissionSetup& mission, path::PathDefaults& defaults) {
    const bool is_in_layout = mission.survey && path.is_table("airspeed_m_per_s");
    defaults.airspeed_m_per_s = is_in_layout ? *mission.survey->layout.strips.front().airspeed_m_per_s
                                             : number_in(airspeeds, path, "airspeed_m_per_s");
}

path::PathDefaults read_defaults(const TomlTable& path, const MissionSetup& mission) {
    path::PathDefaults defaults;
    defaults.where = path.where();
    if (!path.has("waypoints") || path.has("airspeed_m_per_s")) read_path_airspeed(path, mission, defaults);
    defaults.altitude_m = optional_number_in(between(-1e5, 1e5), path, "altitude_m");
    defaults.rates = read_rates(path);
    defaults.return_to_start = path.optional_boolean("return_to_start").value_or(false);
    if (const auto start = path.optional_table("start")) {
        start->refuse_keys_except({"east_m", "north_m", "latitude_deg", "longitude_deg"});
        read_place(*start, defaults.start, defaults.geographic_start);
        if (!defaults.start && !defaults.geographic_start)
            throw InputError(start->where(), "start is no place", place_hint);
    }
    return defaults;
}

/// Throws InputError where the path names two files, or has a key of a file that it does not name.
void require_one_file(const TomlTable& path) {
    std::string named;
    for (const auto* file : {"waypoints", "flight_plan", "area"}) {
        if (!path.has(file)) continue;
        if (!named.empty())
            throw InputError(path.where(file), fmt::format("{} and {} are two paths", named, file), "give one");
        named = file;
    }
    constexpr std::array<std::pair<const char*, const char*>, 10> keys{{{"blocks", "flight_plan"},
                                                                        {"waypoint_order", "flight_plan"},
                                                                        {"one_airspeed", "waypoints"},
                                                                        {"terrain", "waypoints"},
                                                                        {"radius_m", "flight_plan or waypoints"},
                                                                        {"spacing_m", "area"},
                                                                        {"heading_deg", "area"},
                                                                        {"strip", "area"},
                                                                        {"swath_m", "area"},
                                                                        {"utility", "area"}}};
    for (const auto& [key, file] : keys)
        if (path.has(key) && (named.empty() || std::string_view(file).find(named) == std::string_view::npos))
            throw InputError(path.where(key), fmt::format("{} belongs to {}", key, file), "add it, or leave this out");
}

path::TurnLimits read_turn_limits(const TomlTable& path, bool is_rotorcraft) {
    path::TurnLimits limits{is_rotorcraft};
    limits.max_bank_deg = number_in_or(between(5.0, 80.0), path, "max_bank_deg", limits.max_bank_deg);
    limits.radius_m = optional_number_in(between(path::min_radius_m, path::max_radius_m), path, "turn_radius_m");
    if (limits.radius_m && is_rotorcraft)
        throw InputError(path.where("turn_radius_m"), "a rotorcraft brakes before corners: it has no turn_radius_m",
                         "leave it out");
    return limits;
}

/// Movements of the file that the path names; none without one. A flight plan has an origin and a ground.
path::PlanEntries read_planned(const TomlTable& path, const path::Wind& wind, bool is_rotorcraft,
                               path::PathDefaults& defaults, MissionSetup& mission) {
    const path::AutopilotSettings settings{
        optional_number_in(between(path::min_radius_m, path::max_radius_m), path, "radius_m"),
        defaults.airspeed_m_per_s,
        is_rotorcraft,
        path.optional_boolean("one_airspeed").value_or(false),
        path.has("terrain") ? named_file(path, "terrain") : "",
        wind,
        read_turn_limits(path, is_rotorcraft),
        defaults.geographic_start,
        defaults.return_to_start};
    if (settings.one_airspeed && !path.has("airspeed_m_per_s"))
        throw InputError(path.where("one_airspeed"), "one_airspeed needs airspeed_m_per_s", "add it");
    if (path.has("waypoints")) return path::read_waypoints(named_file(path, "waypoints"), settings);
    if (path.has("area")) {
        const auto file = named_file(path, "area");
        auto survey =
            path::parse_area(read_file(file), file.string(), mission.survey->layout, defaults.geographic_start);
        mission.survey = read_coverage(path, mission.survey->layout, survey);
        if (survey.is_divided && is_chosen(path))
            mission.notes.emplace_back(
                "path: its lines are not chosen again in flight: notches, holes, zones or several "
                "polygons divide the area");
        return survey;
    }
    if (!path.has("flight_plan")) return {};
    if (path.has("blocks") == path.has("waypoint_order")) {
        throw InputError(path.where("flight_plan"), "flight_plan needs blocks, or waypoint_order",
                         "give one: blocks = [\"Survey\"] or waypoint_order = [\"1\", \"2\"], in the order of the "
                         "flight; `flightwatt path PLAN.xml` lists the blocks");
    }
    const auto file = named_file(path, "flight_plan");
    const auto text = read_file(file);
    defaults.is_above_sea = true;
    try {
        const auto [origin, ground_m] = path::flight_plan_origin(text, file.string());
        defaults.local_origin = origin;
        defaults.ground_m = ground_m.value_or(0.0);
        defaults.is_above_ground = ground_m.has_value();
        defaults.is_above_sea = !ground_m;
    } catch (const InputError&) {  // it states none: its places are metres alone
    }
    if (path.has("waypoint_order"))
        return {path::parse_flight_plan(text, file.string(), path.strings("waypoint_order"))};
    return path::parse_plan_blocks(text, file.string(), path.strings("blocks"), settings);
}

/// Those of a file first, then the legs. A file's first altitude is that of the start unless the path states one.
path::PlanEntries read_entries(const TomlTable& path, const path::Wind& wind, path::PathDefaults& defaults,
                               MissionSetup& mission) {
    const bool is_rotorcraft = mission.mechanical && mission.mechanical->is_rotorcraft;
    auto plan = read_planned(path, wind, is_rotorcraft, defaults, mission);
    if (!path.has("airspeed_m_per_s") && plan.speed) {
        defaults.airspeed_m_per_s = plan.speed->m_per_s;
        mission.notes.push_back(
            fmt::format("path: airspeed_m_per_s is not stated: {} m/s, {}", plan.speed->m_per_s, plan.speed->source));
    } else if (defaults.airspeed_m_per_s == 0.0) {
        read_path_airspeed(path, mission, defaults);  // which throws
    }
    for (const auto& text : plan.not_flown)
        if (std::ranges::find(plan.missing, text) == plan.missing.end()) mission.notes.push_back("path: " + text);
    for (const auto& text : plan.missing) mission.uncertain.push_back("the plan is not flown as it is: " + text);
    if (mission.mechanical && plan.is_of_multirotor.value_or(is_rotorcraft) != is_rotorcraft)
        mission.uncertain.emplace_back(is_rotorcraft ? "the plan is for a wing, and the model of a rotorcraft"
                                                     : "the plan is for a multirotor, and the model of a wing");
    auto& entries = plan.entries;
    defaults.starts_at_first_place = plan.starts_at_first_place;
    if (plan.is_above_home) defaults.is_above_ground = true;
    if (plan.is_above_sea) defaults.is_above_sea = true;
    read_ground_altitude(path, defaults);
    if (plan.starts_at_home && (defaults.start || defaults.geographic_start)) entries.erase(entries.begin());
    const auto first = std::ranges::find_if(entries, [](const auto& entry) { return !!entry.altitude_m; });
    if (!defaults.altitude_m && first != entries.end()) defaults.altitude_m = first->altitude_m;
    for (std::size_t number = 0; const auto& leg : path.tables("leg")) entries.push_back(read_leg(leg, ++number));
    if (entries.empty())
        throw InputError(path.where(), "the path has no legs", "add [[path.leg]], waypoints, flight_plan or area");
    return plan;
}

/// Notes the keys that the path replaces.
void apply_precedence_of_path(const TomlTable& root, MissionSetup& mission) {
    if (const auto durations = root.optional_table("duration_s"); durations && durations->has("cruise"))
        mission.notes.emplace_back("duration_s.cruise is not used: the duration of the cruise follows from [path]");
    if (root.has("airspeed_m_per_s"))
        mission.notes.emplace_back("airspeed_m_per_s is not used: the cruise has that of [path]");
    const auto uncertainty = root.optional_table("uncertainty");
    if (!uncertainty) return;
    if (const auto durations = uncertainty->optional_table("duration_sd_s"); durations && durations->has("cruise"))
        throw InputError(durations->where("cruise"), "the duration of the cruise follows from [path] and [wind]",
                         "state how the wind differs: speed_sd_m_per_s and direction_sd_deg in [wind]");
}

/// The physical model of the mission; without one the mean power of its flights, in calm air.
mechanical::PhysicalModel power_model(const TomlTable& root, const TomlTable& path, const path::Wind& wind,
                                      MissionSetup& mission) {
    if (!mission.mechanical)
        throw InputError(path.where(), "a path has no meaning with mechanical = \"none\"", "leave it out");
    if (mission.mechanical->physical) return *mission.mechanical->physical;
    if (wind.speed_m_per_s > 0.0 || wind.speed_sd_m_per_s > 0.0)
        throw InputError(root.table("wind").where("speed_m_per_s"),
                         "the flight in wind is unknown: the mechanical model has no [physical] part, of flights that "
                         "measured their airspeed",
                         "without wind the path is flown at the mean power of the model's flights");
    mission.notes.emplace_back(
        "path: calm air and the mean cruise power of the model's flights are assumed, whatever the airspeed, climbs "
        "and turns, as the model has no [physical] part: state the ground speed that they flew; the flight in wind is "
        "unknown");
    return constant_cruise_power(*mission.mechanical);
}

/// The entry whose circles may be repeated: the last that has some, and is no turn between lines.
path::PathEntry* repeated_circles(std::vector<path::PathEntry>& entries) {
    const auto last = std::find_if(entries.rbegin(), entries.rend(),
                                   [](const auto& entry) { return entry.circles && !entry.is_turn; });
    return last == entries.rend() ? nullptr : &*last;
}

/// Where packs are changed, from the path's start: as if it ended there.
path::LocalPosition read_home(const TomlTable& packs, std::vector<path::PathEntry> entries,
                              path::PathDefaults defaults) {
    const auto home = packs.optional_table("home", "{ east_m = 0, north_m = 0 }");
    if (!home) return {};
    home->refuse_keys_except({"east_m", "north_m", "latitude_deg", "longitude_deg"});
    path::PathEntry last;
    last.name = "home";
    last.where = home->where();
    read_place(*home, last.place, last.geographic);
    if (!last.place && !last.geographic) throw InputError(home->where(), "home is no place", place_hint);
    if (last.geographic && !defaults.geographic_start &&
        std::ranges::none_of(entries, [](const auto& entry) { return !!entry.geographic; }))
        throw InputError(home->where(), "home has a latitude, and the path has none", "give east_m and north_m");
    entries.push_back(last);
    defaults.return_to_start = false;
    const auto path = build_path(entries, defaults);
    return local_position_at(path, {path.elements.size(), 0.0});
}

/// The path as it is drawn, and where it is.
path::PlannedPath read_path(const TomlTable& table, const path::Wind& wind, const MissionReadOptions& reading,
                            const std::optional<TomlTable>& packs, MissionSetup& mission) {
    table.refuse_keys_except({"airspeed_m_per_s", "altitude_m",   "climb_m_per_s",    "descent_m_per_s", "start",
                              "return_to_start",  "waypoints",    "flight_plan",      "waypoint_order",  "blocks",
                              "radius_m",         "area",         "spacing_m",        "heading_deg",     "leg",
                              "max_bank_deg",     "one_airspeed", "turn_radius_m",    "strip",           "swath_m",
                              "utility",          "terrain",      "ground_altitude_m"});
    require_one_file(table);
    if (table.has("area")) mission.survey = SurveyCoverage{read_layout(table, reading)};
    auto defaults = read_defaults(table, mission);
    auto planned = read_entries(table, wind, defaults, mission);
    auto& entries = planned.entries;
    if (reading.counts_written_heights) take_heights_as_written(entries, defaults, mission);
    note_unknown_height(defaults, mission);
    if (mission.mechanical) defaults.rates_on_spot = flown_rates(*mission.mechanical);
    if (auto* repeated = repeated_circles(entries); reading.circles && repeated != nullptr)
        repeated->circles = *reading.circles;
    path::PlannedPath plan{build_path(entries, defaults), wind, {}};
    const auto& [climb, descent] = defaults.rates;
    plan.rates = {climb ? climb : defaults.rates_on_spot.climb_m_per_s,
                  descent ? descent : defaults.rates_on_spot.descent_m_per_s};
    plan.is_of_vtol = planned.is_of_vtol;
    plan.origin = path_origin(entries, defaults);
    plan.start_above_ground_m = start_above_ground_m(entries, defaults);
    if (plan.origin && planned.home_altitude_m) plan.origin->ground_m = *planned.home_altitude_m;
    note_rate_on_spot(plan.path, defaults.rates_on_spot, mission);
    if (plan.origin)
        for (const auto& note : fence_notes(planned.fence, plan.path, *plan.origin))
            mission.notes.push_back("path: " + note);
    if (mission.mechanical && mission.mechanical->is_rotorcraft)
        for (auto& element : plan.path.elements) {
            element.keeps_ground_speed = true;
            if (auto* hold = std::get_if<path::Hold>(&element.shape)) hold->hovers = !hold->over_ground;
        }
    if (packs) mission.packs->home = read_home(*packs, entries, defaults);
    if (reading.return_after_m) plan.path = out_and_back(plan.path, *reading.return_after_m, defaults.rates);
    return plan;
}

/// Names as uncertain the first leg whose stated duration needs a speed that airspeed and wind do not give.
void note_impossible_times(const path::PlannedPath& plan, MissionSetup& mission) {
    constexpr double times_airspeed = 1.5;  // measured times have gusts, and a wind that is not stated
    for (const auto& element : plan.path.elements) {
        const auto* hold = std::get_if<path::Hold>(&element.shape);
        if (hold == nullptr || !hold->over_ground) continue;
        const double speed = hold->over_ground->length_m / hold->time_s;
        if (speed <= times_airspeed * element.airspeed_m_per_s + plan.wind.speed_m_per_s) continue;
        return mission.uncertain.push_back(fmt::format(
            "{}: {:.4g} m in {:.4g} s are {:.3g} m/s over ground, and its power is that of {:.3g} m/s through the air",
            element.name, hold->over_ground->length_m, hold->time_s, speed, element.airspeed_m_per_s));
    }
}

}  // namespace

std::optional<SurveyChoices> read_survey_choices(const TomlTable& mission_table) {
    const auto path = mission_table.optional_table("path");
    if (!path || !path->has("area") || !is_chosen(*path)) return std::nullopt;
    SurveyChoices choices;
    choices.headings_deg = read_levels(*path, "heading_deg", headings);
    if (path->has("strip"))
        throw InputError(path->where("strip"), "strips are fixed, and a value of [path] is yet to be chosen",
                         "give spacing_m instead");
    auto spacings_m = read_levels(*path, "spacing_m", spacings);
    std::ranges::sort(spacings_m, std::greater());
    std::vector<std::optional<double>> speeds{std::nullopt};
    if (path->is_table("airspeed_m_per_s")) {
        speeds.clear();
        for (const double speed : read_levels(*path, "airspeed_m_per_s", airspeeds)) speeds.emplace_back(speed);
    }
    for (const double spacing_m : spacings_m)
        for (const auto& speed : speeds) choices.levels.push_back({spacing_m, 1.0, speed});
    if (path->is_table("spacing_m")) {
        choices.blocks = static_cast<std::size_t>(count_in_or(path->table("spacing_m"), "blocks", 1, 1));
        if (!path->has("utility"))
            throw InputError(path->where("spacing_m"), "the widest lines would be chosen: no coverage has a utility",
                             "add swath_m, the width that the sensor sees, and utility = { weight = 1 }");
    }
    if (mission_table.has("packs"))
        throw InputError(path->where(), "the lines of a mission over several packs cannot be chosen",
                         "state spacing_m, heading_deg and airspeed_m_per_s as numbers, or leave [packs] out");
    const double layouts = static_cast<double>(choices.headings_deg.size()) *
                           std::pow(static_cast<double>(choices.levels.size()), static_cast<double>(choices.blocks));
    if (!(layouts <= max_survey_layouts))
        throw InputError(path->where(),
                         fmt::format("its lines have {:.3g} combinations, more than {:.0f} to choose from", layouts,
                                     max_survey_layouts),
                         "give fewer steps, levels or blocks");
    return choices;
}

void read_cruise_path(const TomlTable& mission_table, const MissionReadOptions& reading, MissionSetup& mission) {
    const auto table = mission_table.optional_table("path");
    if (!table) {
        if (mission_table.has("wind"))
            throw InputError(
                mission_table.where("wind"), "[wind] belongs to a [path]",
                "leave it out; flightwatt new-mission --plan PLAN --wind SPEED@DEG makes a mission with both");
        return;
    }
    if (reading.cruise_s) throw NoResultError("the duration of the cruise follows from its path");
    apply_precedence_of_path(mission_table, mission);
    auto plan = read_path(*table, read_wind(mission_table), reading, mission_table.optional_table("packs"), mission);
    if (reading.path_times) plan.path = repeated(plan.path, plan.wind, *reading.path_times, plan.rates);
    plan.power = power_model(mission_table, *table, plan.wind, mission);
    const bool is_physical = mission.mechanical->physical.has_value();
    add_turns_of_induced_drag(plan.power);
    if (is_physical) add_unexplained_power(plan.power, mission);
    const auto as_drawn = compute_trajectory(plan.path, plan.wind);  // refuses what its turns would hide
    for (const auto& piece : as_drawn.pieces) {
        const auto& element = plan.path.elements[piece.element];
        const double airspeed = std::holds_alternative<path::Hold>(element.shape) ? element.airspeed_m_per_s
                                                                                  : piece.motion.airspeed_m_per_s;
        if (is_physical && !may_be_predicted(airspeed, plan.power, mission.mechanical->is_rotorcraft))
            throw UnknownPowerError(
                table->where(),
                fmt::format("{}: {:.4g} m/s is beyond what the model's flights flew", element.name, airspeed),
                near_flown_hint(plan.power));
    }
    note_impossible_times(plan, mission);
    plan.turns = read_turn_limits(*table, mission.mechanical->is_rotorcraft);
    auto turned = fly_turns(plan.path, plan.wind, *plan.turns);
    for (const auto& note : turned.notes) mission.notes.push_back("path: " + note);
    plan.drawn = std::exchange(plan.path, std::move(turned.path));
    const auto flown = compute_trajectory(plan.path, plan.wind);
    if (mission.survey && !reading.path_times) set_line_times(plan.path, flown, *mission.survey);
    if (has_steep_turn(flown))
        mission.uncertain.emplace_back("a turn takes a bank that the aircraft may not be able to fly");
    constexpr double uncertain_part = 0.05;
    if (const double part = is_physical ? part_far_beyond(plan, flown) : 0.0; part >= uncertain_part)
        mission.uncertain.push_back(
            fmt::format("{:.0f} % of the cruise is flown far beyond the airspeeds and climbs of the model's flights",
                        units::percentage(part, 1.0)));
    if (is_physical)
        for (auto& warning : path_warnings(plan, flown)) mission.notes.push_back(std::move(warning));
    set_cruise_path(mission, std::move(plan));
    set_takeoff_and_landing(mission);
}

}  // namespace flightwatt::mission

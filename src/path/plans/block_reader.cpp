#include "path/plans/block_reader.h"

#include "base/text.h"
#include "base/toml_reader.h"
#include "path/plans/patterns.h"
#include "path/plans/plan_expressions.h"
#include "path/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::path {
namespace {

using Arguments = std::vector<std::string>;

/// Functions that do not move the aircraft, by how they begin, and those that continue a survey set up before.
bool is_without_movement(std::string_view function) {
    constexpr std::array prefixes{"NavKill",     "NavResurrect", "NavSetGround",   "NavSetAltitude", "NavStart",
                                  "NavVertical", "nav_set_",     "nav_line_setup", "DownlinkSend"};
    return std::ranges::any_of(prefixes, [&](const char* prefix) { return function.starts_with(prefix); }) ||
           (function.starts_with("nav_survey_") && function.ends_with("_run"));
}

/// Follows the stages of a block.
class BlockReader {
  public:
    BlockReader(const FlightPlan& plan, const AutopilotSettings& settings, BlockState& state)
        : plan_(plan), settings_(settings), values_(state.values), entries_(state.entries) {
        if (!settings.radius_m) return;
        values_.try_emplace("nav_radius", *settings.radius_m);
        values_.try_emplace("DEFAULT_CIRCLE_RADIUS", *settings.radius_m);
    }

    BlockRemarks read(const pugi::xml_node& block) {
        constexpr std::size_t max_entries = 200'000;
        for (const auto& stage : block.children()) {
            read_stage(stage);
            if (entries_.size() > max_entries)
                throw InputError(where(plan_, stage),
                                 fmt::format("the blocks have more than {} movements", max_entries),
                                 "name fewer blocks");
        }
        const auto add = [](const std::set<std::string>& parts, std::vector<std::string>& to) {
            if (!parts.empty()) to.push_back(fmt::format("not followed: {}", fmt::join(parts, ", ")));
        };
        add(not_followed_, remarks_.all);
        add(missing_, remarks_.missing);
        return std::move(remarks_);
    }

  private:
    void read_stage(const pugi::xml_node& stage) {
        const std::string_view kind = stage.name();
        if (kind == "go") return go(stage);
        if (kind == "path") return path(stage);
        if (kind == "circle") return circle(stage);
        if (kind == "oval") return oval(stage);
        if (kind == "eight") return eight(stage);
        if (kind == "survey_rectangle") return survey_rectangle(stage);
        if (kind == "stay") return stay(stage);
        if (kind == "set") return set(stage);
        if (kind == "call" || kind == "call_once") return call(stage);
        if (kind == "while" || kind == "for")
            leave_out(fmt::format("loops ({})", kind), !stage.children().empty());
        else if (kind == "exception")
            not_followed_.insert(fmt::format("exceptions to '{}'", attribute(stage, "deroute")));
        else if (kind == "deroute")
            not_followed_.insert(fmt::format("deroutes to '{}'", attribute(stage, "block")));
        else
            report(stage, fmt::format("<{}> is not flown: it states no place", kind));
    }

    void report(const pugi::xml_node& stage, const std::string& text, bool is_missing = true) {
        remarks_.all.push_back(fmt::format("line {}: {}", where(plan_, stage).line, text));
        if (is_missing) remarks_.missing.push_back(remarks_.all.back());
    }

    void leave_out(const std::string& part, bool moves) {
        not_followed_.insert(part);
        if (moves) missing_.insert(part);
    }

    std::optional<double> value_of(const std::string& expression) const {
        return evaluate(expression, [&](const std::string& name) -> std::optional<double> {
            const auto own = values_.find(name);
            return own != values_.end() ? std::optional(own->second) : evaluate(plan_, name);
        });
    }

    double number(const pugi::xml_node& stage, const std::string& expression, std::string_view meaning) const {
        if (const auto value = value_of(expression)) return *value;
        throw InputError(
            where(plan_, stage), fmt::format("{} is not known: '{}'", meaning, expression),
            expression.find("nav_radius") != std::string::npos || expression.find("RADIUS") != std::string::npos
                ? "state the autopilot's radius of circles: radius_m in [path], --radius of `flightwatt path`"
                : "replace the name by a number in a copy of the plan");
    }

    double radius(const pugi::xml_node& stage, const std::string& expression) const {
        const double radius_m = number(stage, expression.empty() ? "nav_radius" : expression, "the radius");
        require_in(between(min_radius_m, max_radius_m), std::abs(radius_m), "the radius", where(plan_, stage));
        return radius_m;
    }

    /// An entry of a stage that is flown at the altitude of a waypoint, or at its own.
    PathEntry like(const pugi::xml_node& stage, const PathEntry& waypoint) const {
        PathEntry entry;
        entry.name = fmt::format("<{}> of block '{}'", stage.name(), attribute(stage.parent(), "name"));
        entry.where = where(plan_, stage);
        entry.altitude_m = waypoint.altitude_m;
        if (const auto own = value_of(attribute(stage, "alt"))) entry.altitude_m = own;
        const auto height = value_of(attribute(stage, "height"));
        const auto ground = evaluate(plan_, "ground_alt");
        if (height && ground) entry.altitude_m = *ground + *height;
        const auto mode = attribute(stage, "vmode");
        if (mode == "throttle" || mode == "climb") entry.altitude_m.reset();  // the altitude is what comes of it
        return entry;
    }

    PathEntry waypoint(const pugi::xml_node& stage, const std::string& name) const {
        return waypoint_entry(plan_, waypoint_number(plan_, name, where(plan_, stage)));
    }

    /// The waypoint `wp` of a stage; none, and reported, without one and for a place relative to it.
    std::optional<PathEntry> target(const pugi::xml_node& stage) {
        const auto name = attribute(stage, "wp");
        if (!name.empty() && attribute(stage, "wp_dist").empty() && attribute(stage, "wp_qdr").empty())
            return waypoint(stage, name);
        report(stage, fmt::format("<{}> is not flown: {}", stage.name(),
                                  name.empty() ? "it states no waypoint" : "its place is relative to a waypoint"));
        return std::nullopt;
    }

    /// The last place of the path; none at its start.
    std::optional<LocalPosition> at() const {
        const auto last = std::find_if(entries_.rbegin(), entries_.rend(),
                                       [](const PathEntry& entry) { return entry.place.has_value(); });
        return last == entries_.rend() ? std::nullopt : last->place;
    }

    /// The number of rounds of a pattern, which may end after a count or a time; without counters it is flown once.
    double rounds(const pugi::xml_node& stage, std::initializer_list<std::string_view> counters, double round_s,
                  std::string_view pattern) {
        const auto until = attribute(stage, "until");
        auto count = find_limit(until, counters);
        const auto time_s = find_limit(until, {"stage_time", "NavBlockTime"});
        if (!count && time_s && round_s > 0.0) count = *time_s / round_s;
        if (count) require_in(at_most(largest_circle_count), *count, "the number of rounds", where(plan_, stage));
        constexpr double min_count = 0.1;
        if (count) return std::max(*count, min_count);
        report(stage,
               until.empty() || until == "FALSE"
                   ? fmt::format("{} has no end: it is flown once", pattern)
                   : fmt::format("{} ends by a condition ({}): it is flown once", pattern, until),
               pattern != "the survey");  // once covers the area
        return 1.0;
    }

    /// The time of a round of circles, or of an oval with its lines, in the wind; 0 without an airspeed.
    double time_of_round_s(double radius_m, const LocalPosition& line = {}) const {
        if (!(settings_.airspeed_m_per_s > 0.0)) return 0.0;
        double time_s = circle_time_s(std::abs(radius_m), settings_.airspeed_m_per_s, settings_.wind, settings_.turns);
        for (const auto& way : {line, LocalPosition{} - line}) {
            PathElement leg;
            leg.shape = Leg{distance_between_m({}, way), course_between({}, way)};
            leg.airspeed_m_per_s = settings_.airspeed_m_per_s;
            leg.keeps_ground_speed = settings_.turns.is_rotorcraft;
            if (way != LocalPosition{})
                time_s += compute_trajectory({{leg}}, settings_.wind, InfeasibleLegPolicy::crawl).duration_s;
        }
        return time_s;
    }

    PatternWriter pattern(const pugi::xml_node& stage, const PathEntry& waypoint) {
        return {like(stage, waypoint), entries_};
    }

    /// The whole way from one waypoint to the next: the aircraft follows the line between them.
    void route(const pugi::xml_node& stage, const std::string& from, const std::string& to) {
        if (!from.empty()) {
            const auto start = waypoint(stage, from);
            if (at() != start.place) pattern(stage, start).fly_to(*start.place);
        }
        const auto end = waypoint(stage, to);
        pattern(stage, end).fly_to(*end.place);
    }

    void go(const pugi::xml_node& stage) {
        if (target(stage))
            route(stage, attribute(stage, "hmode") == "route" ? attribute(stage, "from") : "", attribute(stage, "wp"));
    }

    void path(const pugi::xml_node& stage) {
        std::string from;
        for (const auto& to : split(attribute(stage, "wpts"), " ,\n\t")) {
            route(stage, from, to);
            from = to;
        }
    }

    void circle(const pugi::xml_node& stage) {
        const auto centre = target(stage);
        if (!centre) return;
        const double radius_m = radius(stage, attribute(stage, "radius"));
        const double turns = rounds(stage, {"NavCircleCount", "circle_count"}, time_of_round_s(radius_m),
                                    fmt::format("the circle around {}", attribute(stage, "wp")));
        entries_.push_back(with_circles(like(stage, *centre), turns, radius_m));
        entries_.back().place = centre->place;
    }

    void oval(const pugi::xml_node& stage) {
        const auto first = waypoint(stage, attribute(stage, "p1"));
        const auto second = *waypoint(stage, attribute(stage, "p2")).place;
        const double radius_m = radius(stage, attribute(stage, "radius"));
        double count = rounds(stage, {"NavOvalCount", "nav_oval_count"},
                              time_of_round_s(radius_m, second - *first.place), "the oval");
        const auto until = attribute(stage, "until");  // the counter is a whole number: above 3 are 4 rounds
        if (const auto limit = find_limit(until, {"NavOvalCount", "nav_oval_count"}))
            count = until.find(">=") == std::string::npos && until.find("@GEQ") == std::string::npos
                        ? std::floor(*limit) + 1.0
                        : std::max(1.0, std::ceil(*limit));
        pattern(stage, first).oval(*first.place, second, radius_m, count);
    }

    void eight(const pugi::xml_node& stage) {
        const auto centre = waypoint(stage, attribute(stage, "center"));
        const auto turn = *waypoint(stage, attribute(stage, "turn_around")).place;
        rounds(stage, {}, 0.0, "the eight");
        pattern(stage, centre).eight(*centre.place, turn, radius(stage, attribute(stage, "radius")));
    }

    /// Lines from north to south unless the orientation is WE.
    void survey_rectangle(const pugi::xml_node& stage) {
        rounds(stage, {}, 0.0, "the survey");
        const auto corner = waypoint(stage, attribute(stage, "wp1"));
        const LocalPosition p = *corner.place;
        const LocalPosition q = *waypoint(stage, attribute(stage, "wp2")).place;
        survey(stage, {p, {p.east_m, q.north_m}, q, {q.east_m, p.north_m}},
               number(stage, attribute(stage, "grid"), "the grid"),
               attribute(stage, "orientation") == "WE" ? 90.0 : 0.0, corner);
    }

    void stay(const pugi::xml_node& stage) {
        const auto place = target(stage);
        if (!place) return;
        pattern(stage, *place).fly_to(*place->place);
        const auto until = attribute(stage, "until");
        const auto time_s = find_limit(until, {"stage_time", "NavBlockTime"});
        if (time_s && *time_s > 0.0)
            entries_.back().hold_s = time_s;
        else
            report(stage, fmt::format("the hold at {} has no time{}", attribute(stage, "wp"),
                                      until.empty() ? "" : fmt::format(" ({})", until)));
    }

    void set(const pugi::xml_node& stage) {
        const auto name = attribute(stage, "var");
        if (const auto value = value_of(attribute(stage, "value")))
            values_[name] = *value;
        else if (name != "nav_radius" || !settings_.radius_m)
            values_.erase(name);
    }

    void call(const pugi::xml_node& stage) {
        const auto called = function_call(attribute(stage, "fun"));
        const auto& name = called.first;
        const auto& arguments = called.second;
        const auto is = [&](std::initializer_list<std::string_view> names, std::size_t count) {
            return std::ranges::find(names, name) != names.end() && arguments.size() == count;
        };
        if (is({"nav_line_run", "nav_line"}, 3)) return line(stage, arguments);
        if (is({"nav_survey_zamboni_setup", "nav_survey_zamboni_start"}, 6)) return zamboni(stage, arguments);
        if (is({"nav_survey_polygon_setup", "nav_survey_polygon_start", "gvf_nav_survey_polygon_setup"}, 7))
            return polygon(stage, arguments);
        if (is({"nav_survey_poly_osam_setup", "nav_survey_poly_osam_start", "InitializePolygonSurvey"}, 4))
            return osam_polygon(stage, arguments, false);
        if (is({"nav_survey_poly_osam_setup_towards"}, 4)) return osam_polygon(stage, arguments, true);
        const std::string_view function = name;
        if (function.starts_with("NavSetWaypoint") || function.starts_with("NavCopyWaypoint") ||
            function.starts_with("nav_compute_"))
            leave_out("moves of waypoints by " + attribute(stage, "fun"), true);
        else if (!is_without_movement(function))
            leave_out("the unknown function " + name, true);
    }

    void line(const pugi::xml_node& stage, const Arguments& arguments) {
        const auto first = waypoint(stage, arguments[0]);
        const auto second = *waypoint(stage, arguments[1]).place;
        rounds(stage, {}, 0.0, "the line");
        pattern(stage, first).line(*first.place, second, std::abs(radius(stage, arguments[2])));
    }

    void zamboni(const pugi::xml_node& stage, const Arguments& arguments) {
        const auto centre = waypoint(stage, arguments[0]);
        Zamboni survey;
        survey.centre = *centre.place;
        survey.course_deg = course_between(survey.centre, *waypoint(stage, arguments[1]).place);
        survey.length_m = number(stage, arguments[2], "the length of lines");
        survey.spacing_m = number(stage, arguments[3], "the spacing");
        survey.rounds = std::floor((number(stage, arguments[4], "the number of lines") + 1.0) / 2.0);
        if (!(survey.rounds >= 1.0 && survey.rounds < max_survey_lines) || !(survey.length_m > 0.0))
            throw InputError(where(plan_, stage), "the survey has no lines, or more than 5000");
        auto writer = pattern(stage, centre);
        writer.like.altitude_m = number(stage, arguments[5], "the altitude");
        writer.zamboni(survey);
    }

    /// The waypoints from the first argument on, as many as the second states.
    std::vector<LocalPosition> corners(const pugi::xml_node& stage, const Arguments& arguments) const {
        const auto begin = waypoint_number(plan_, arguments[0], where(plan_, stage));
        const double count = number(stage, arguments[1], "the number of corners");
        if (!(count >= 3.0) || static_cast<double>(begin) + count > static_cast<double>(plan_.waypoints.size()))
            throw InputError(where(plan_, stage),
                             fmt::format("a polygon of {} corners from {} on", count, arguments[0]),
                             "expected three and more, all of them waypoints of the plan");
        std::vector<LocalPosition> places;
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            places.push_back(*waypoint_entry(plan_, begin + i).place);
        return places;
    }

    void polygon(const pugi::xml_node& stage, const Arguments& arguments) {
        const double spacing_m = number(stage, arguments[3], "the spacing");
        auto writer = pattern(stage, waypoint(stage, arguments[0]));
        writer.like.altitude_m = number(stage, arguments[6], "the altitude");
        const auto lines =
            lines_over(stage, corners(stage, arguments), spacing_m, number(stage, arguments[2], "the angle"));
        writer.one_way_survey(lines, spacing_m, radius(stage, arguments[5]));
    }

    /// Lines there and back; the orientation is the lines' angle from east to north, or towards a waypoint.
    void osam_polygon(const pugi::xml_node& stage, const Arguments& arguments, bool is_towards) {
        const auto first = waypoint(stage, arguments[0]);
        const double course_deg = is_towards ? course_between(*first.place, *waypoint(stage, arguments[3]).place)
                                             : 90.0 - number(stage, arguments[3], "the orientation");
        survey(stage, corners(stage, arguments), number(stage, arguments[2], "the spacing"), course_deg, first);
    }

    void survey(const pugi::xml_node& stage, const std::vector<LocalPosition>& polygon, double spacing_m,
                double course_deg, const PathEntry& corner) {
        pattern(stage, corner)
            .survey(lines_over(stage, polygon, spacing_m, course_deg), spacing_m, at().value_or(polygon.front()));
    }

    std::vector<SurveyLine> lines_over(const pugi::xml_node& stage, const std::vector<LocalPosition>& polygon,
                                       double spacing_m, double course_deg) const {
        require_in(at_least(min_radius_m), spacing_m, "the spacing of lines", where(plan_, stage));
        return survey_lines(polygon, spacing_m, course_deg, where(plan_, stage));
    }

    const FlightPlan& plan_;
    const AutopilotSettings& settings_;
    std::map<std::string, double>& values_;
    std::vector<PathEntry>& entries_;
    BlockRemarks remarks_;
    std::set<std::string> not_followed_;
    std::set<std::string> missing_;  ///< those of them that may move the aircraft
};

}  // namespace

BlockRemarks read_block(const FlightPlan& plan, const pugi::xml_node& block, const AutopilotSettings& settings,
                        BlockState& state) {
    return BlockReader(plan, settings, state).read(block);
}

}  // namespace flightwatt::path

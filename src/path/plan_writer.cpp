#include "path/plan_writer.h"

#include "path/path_entries.h"
#include "path/plans/json_text.h"
#include "path/plans/mission_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

namespace flightwatt::path {
namespace {

constexpr double written_place_m = 1e-3;  // to which places are the same
constexpr double same_time_s = 1e-6;
constexpr double default_hover_m_per_s = 5.0, default_cruise_m_per_s = 15.0;

/// Where the aircraft flies to, and what it does there.
struct Stop {
    LocalPosition place;      ///< from the start of the path; of circles their centre
    double altitude_m = 0.0;  ///< above the ground
    double airspeed_m_per_s = 0.0;
    double hold_s = 0.0;
    std::optional<Circles> circles = std::nullopt;
};

/// Follows the elements of a path.
class StopList {
  public:
    explicit StopList(const PlanToWrite& plan)
        : plan_(plan), elements_(plan.path.elements), altitude_m_(plan.origin.altitude_m.value_or(default_altitude_m)) {
        start_altitude_m_ = altitude_m_;
        if (!plan.origin.altitude_m)
            notes.push_back(fmt::format("no altitude is stated: {} m above the ground", default_altitude_m));
        for (std::size_t i = 0; i < elements_.size(); ++i) add(i);
    }

    std::vector<Stop> stops;
    std::vector<std::string> notes;
    LocalPosition end() const { return at_; }
    double start_altitude_m() const { return start_altitude_m_; }

  private:
    /// Notes an arc that begins at a corner: of circles the reader and the autopilot choose where they are entered.
    void note_corner(const Circles& arc) {
        constexpr auto text =
            "arcs of a pattern that begin at corners are written as parts of circles, which are entered where the way is "
            "shortest: simulate the written missions";
        if (course_deg_ && is_bent(*course_deg_, arc.start_course_deg)) note_once(text);
    }

    double least_radius_m(const PathElement& element) const {
        const double bank_m =
            turn_radius_m(element.airspeed_m_per_s, plan_.turns.max_bank_deg, plan_.wind.speed_m_per_s);
        return std::max(bank_m, plan_.turns.radius_m.value_or(0.0));
    }

    /// Whether another turn takes the place of a part of a circle between lines (fly_turns).
    bool is_narrow_turn(const PathElement& element, const Circles& circles) const {
        return element.is_turn && !plan_.is_rotorcraft && circles.radius_m < least_radius_m(element) * (1.0 - 1e-9);
    }

    /// Notes a way from a corner to a narrow turn that is too short to be flown straight: its end is written as a
    /// corner, which is passed otherwise.
    void note_short_way(std::size_t turn) {
        if (turn < 2) return;
        const auto* before = std::get_if<Leg>(&elements_[turn - 2].shape);
        const auto* way = std::get_if<Leg>(&elements_[turn - 1].shape);
        const bool is_short = way != nullptr && way->length_m < 2.0 * least_radius_m(elements_[turn]);
        if (before != nullptr && is_short && is_bent(before->course_deg, way->course_deg))
            note_once(
                "narrow turns after short ways are written as corners, which are passed in another time: simulate the "
                "written missions");
    }

    static bool is_bent(double from_deg, double to_deg) {
        constexpr double least_deg = 0.1;
        return std::abs(std::remainder(to_deg - from_deg, 360.0)) > least_deg;
    }

    void note_once(const std::string& text) {
        if (std::ranges::find(notes, text) == notes.end()) notes.push_back(text);
    }

    void add(std::size_t i) {
        const auto& element = elements_[i];
        const auto before = at_;
        at_ = at_ + local_position_at({{element}}, {1, 0.0});
        altitude_m_ += element.altitude_change_m;
        const double airspeed = element.airspeed_m_per_s;
        if (const auto* circles = std::get_if<Circles>(&element.shape)) {
            if (is_narrow_turn(element, *circles)) {
                note_short_way(i);
                return stops.push_back({at_, altitude_m_, airspeed});
            }
            if (element.is_turn) note_corner(*circles);
            course_deg_ = circles->start_course_deg + (circles->to_right ? 360.0 : -360.0) * circles->turns;
            return stops.push_back({centre(*circles, before), altitude_m_, airspeed, 0.0, *circles});
        }
        if (const auto* leg = std::get_if<Leg>(&element.shape)) course_deg_ = leg->course_deg;
        const auto* hold = std::get_if<Hold>(&element.shape);
        if (hold != nullptr && !hold->over_ground) return add_hold(element, hold->time_s);
        if (hold != nullptr) note_once("measured times of ways are not written");
        if (!leads_to_circles(i, before)) stops.push_back({at_, altitude_m_, airspeed});
    }

    void add_hold(const PathElement& element, double time_s) {
        const bool is_there = !stops.empty() && !stops.back().circles && element.altitude_change_m == 0.0;
        if (!is_there) stops.push_back({at_, altitude_m_, element.airspeed_m_per_s});
        // The way to another altitude takes its time without a hold.
        const auto own = element.altitude_change_m > 0.0 ? plan_.rates.climb_m_per_s : plan_.rates.descent_m_per_s;
        const auto rate = element.climb_rate_m_per_s ? element.climb_rate_m_per_s : own;
        const double change_s = rate ? std::abs(element.altitude_change_m) / *rate : 0.0;
        if (change_s == 0.0 || time_s > change_s + same_time_s) stops.back().hold_s += time_s;
    }

    static LocalPosition centre(const Circles& circles, const LocalPosition& start) {
        constexpr double quarter_deg = 90.0;
        return moved(start, circles.radius_m,
                     circles.start_course_deg + (circles.to_right ? quarter_deg : -quarter_deg));
    }

    /// Whether a leg is the way to the edge of the next circles, which those include.
    bool leads_to_circles(std::size_t i, const LocalPosition& before) const {
        if (i + 1 == elements_.size() || elements_[i + 1].altitude_change_m != 0.0) return false;
        const auto* circles = std::get_if<Circles>(&elements_[i + 1].shape);
        if (circles == nullptr || elements_[i + 1].airspeed_m_per_s != elements_[i].airspeed_m_per_s) return false;
        const auto middle = centre(*circles, at_);
        const auto out = before - middle;
        const double distance_m = distance_between_m(before, middle);
        if (distance_m < written_place_m) return false;
        const double scale = circles->radius_m / distance_m;
        const auto edge = middle + LocalPosition{scale * out.east_m, scale * out.north_m};
        return distance_between_m(edge, at_) < written_place_m;
    }

    const PlanToWrite& plan_;
    const std::vector<PathElement>& elements_;
    double altitude_m_;
    double start_altitude_m_;
    LocalPosition at_;
    std::optional<double> course_deg_;  ///< at the end of the last leg or circles
};

double signed_radius_m(const Circles& circles) { return circles.to_right ? circles.radius_m : -circles.radius_m; }

// MAV_FRAME
constexpr int above_sea = 0, above_home = 3, of_no_place = 2;

/// A command of MAVLink; a parameter that is not given is null in JSON, and 0 in lines.
struct Item {
    int command = 0;
    std::array<std::optional<double>, 7> parameters = {};
    int frame = of_no_place;
    bool has_place() const { return frame != of_no_place; }
};

/// Whether a stop is a hold of a wing, which does not wait at waypoints.
bool loiters_to_hold(const PlanToWrite& plan, const Stop& stop) {
    return !plan.is_rotorcraft && !stop.circles && stop.hold_s > 0.0;
}

std::vector<Item> items_of(const PlanToWrite& plan, const StopList& list) {
    const auto item = [&](int command, const LocalPosition& at, double altitude_m) {
        const auto place = to_geodetic(plan.origin.start + at, plan.origin.place);
        return Item{command,
                    {0.0, 0.0, 0.0, std::nullopt, place.latitude_deg, place.longitude_deg, altitude_m},
                    plan.origin.is_above_sea ? above_sea : above_home};
    };
    std::vector<Item> items{item(plan.is_of_vtol ? nav_vtol_takeoff : nav_takeoff, {}, list.start_altitude_m())};
    constexpr double pitch_deg = 15.0;
    items.front().parameters[0] = plan.is_rotorcraft || plan.is_of_vtol ? 0.0 : pitch_deg;
    double airspeed = 0.0;
    for (const auto& stop : list.stops) {
        const double kind = plan.is_rotorcraft ? 1.0 : 0.0;  // multirotors have the ground speed alone
        if (stop.airspeed_m_per_s != std::exchange(airspeed, stop.airspeed_m_per_s))
            items.push_back({change_speed, {kind, stop.airspeed_m_per_s, -1.0, 0.0, 0.0, 0.0, 0.0}});
        const bool loiters = loiters_to_hold(plan, stop);
        const int command = stop.circles ? nav_loiter_turns : loiters ? nav_loiter_time : nav_waypoint;
        items.push_back(item(command, stop.place, stop.altitude_m));
        auto& parameters = items.back().parameters;
        parameters[0] = stop.circles ? stop.circles->turns : stop.hold_s;
        if (stop.circles) parameters[2] = signed_radius_m(*stop.circles);
        if (loiters) parameters[2] = plan.turns.radius_m.value_or(0.0);  // 0: the autopilot's
    }
    items.push_back(item(plan.is_of_vtol ? nav_vtol_land : nav_land, list.end(), 0.0));
    items.back().frame = above_home;
    return items;
}

std::string qgc_text(const PlanToWrite& plan, const StopList& list) {
    using Ordered = nlohmann::ordered_json;
    constexpr int mixed_mode = 0, relative_mode = 1, absolute_mode = 2;  // of QGroundControl
    auto items = Ordered::array();
    for (const auto& item : items_of(plan, list)) {
        auto parameters = Ordered::array();
        for (const auto& value : item.parameters) parameters.push_back(value ? Ordered(*value) : Ordered());
        Ordered json;
        if (item.has_place())
            json = {{"AMSLAltAboveTerrain", nullptr},
                    {"Altitude", *item.parameters.back()},
                    {"AltitudeMode", item.frame == above_sea ? absolute_mode : relative_mode}};
        json.update({{"autoContinue", true},
                     {"command", item.command},
                     {"doJumpId", items.size() + 1},
                     {"frame", item.frame},
                     {"params", parameters},
                     {"type", "SimpleItem"}});
        items.push_back(std::move(json));
    }
    const auto home = to_geodetic(plan.origin.start, plan.origin.place);
    const double airspeed = plan.path.elements.front().airspeed_m_per_s;
    constexpr int fixed_wing = 1, quadrotor = 2, vtol = 20;  // MAV_TYPE, as QGroundControl has them
    const Ordered mission{{"cruiseSpeed", plan.is_rotorcraft && !plan.is_of_vtol ? default_cruise_m_per_s : airspeed},
                          {"firmwareType", 0},  // any
                          {"globalPlanAltitudeMode", plan.origin.is_above_sea ? mixed_mode : relative_mode},
                          {"hoverSpeed", plan.is_rotorcraft ? airspeed : default_hover_m_per_s},
                          {"items", items},
                          {"plannedHomePosition", {home.latitude_deg, home.longitude_deg, plan.origin.ground_m}},
                          {"vehicleType", plan.is_of_vtol      ? vtol
                                          : plan.is_rotorcraft ? quadrotor
                                                               : fixed_wing},
                          {"version", 2}};
    const auto none = Ordered::array();
    const Ordered file{{"fileType", "Plan"},
                       {"geoFence", {{"circles", none}, {"polygons", none}, {"version", 2}}},
                       {"groundStation", "QGroundControl"},
                       {"mission", mission},
                       {"rallyPoints", {{"points", none}, {"version", 2}}},
                       {"version", 1}};
    return file.dump(4) + "\n";
}

std::string wpl_text(const PlanToWrite& plan, const StopList& list) {
    const auto home = to_geodetic(plan.origin.start, plan.origin.place);
    auto text = fmt::format("QGC WPL 110\n0\t1\t0\t{}\t0\t0\t0\t0\t{:.12f}\t{:.12f}\t{:.6f}\t1\n", nav_waypoint,
                            home.latitude_deg, home.longitude_deg, plan.origin.ground_m);
    int number = 0;
    for (const auto& item : items_of(plan, list)) {
        text += fmt::format("{}\t0\t{}\t{}", ++number, item.has_place() ? item.frame : above_home, item.command);
        for (const auto& value : item.parameters) text += fmt::format("\t{:.12f}", value.value_or(0.0));
        text += "\t1\n";
    }
    return text;
}

using Attributes = std::vector<std::pair<const char*, std::string>>;

void add(pugi::xml_node parent, const char* name, const Attributes& attributes) {
    auto node = parent.append_child(name);
    for (const auto& [key, value] : attributes) node.append_attribute(key) = value.c_str();
}

/// Writes a flight plan of Paparazzi.
class FlightPlanWriter {
  public:
    FlightPlanWriter(const PlanToWrite& plan, const StopList& list) : plan_(plan), list_(list) {}

    std::string write() {
        document_.append_child(pugi::node_doctype).set_value("flight_plan SYSTEM \"flight_plan.dtd\"");
        auto root = document_.append_child("flight_plan");
        waypoints_ = root.append_child("waypoints");
        blocks_ = root.append_child("blocks");
        add_waypoint("HOME", {}, list_.start_altitude_m());
        add_start();
        add_path();
        add_landing();
        constexpr double margin_m = 200.0;  // for turns
        const auto metres = [](double value) { return fmt::format("{}", std::ceil(value)); };
        for (const auto& [key, value] : Attributes{{"name", plan_.name},
                                                   {"lat0", fmt::format("{}", plan_.origin.place.latitude_deg)},
                                                   {"lon0", fmt::format("{}", plan_.origin.place.longitude_deg)},
                                                   {"max_dist_from_home", metres(farthest_m_ + margin_m)},
                                                   {"ground_alt", altitude(0.0)},
                                                   {"security_height", "25"},
                                                   {"alt", altitude(list_.start_altitude_m())}})
            root.append_attribute(key) = value.c_str();
        std::ostringstream text;
        document_.save(text, "  ", pugi::format_default | pugi::format_no_declaration);
        return text.str();
    }

  private:
    std::string altitude(double above_ground_m) const {
        return fmt::format("{:.10g}", plan_.origin.ground_m + above_ground_m);
    }

    void add_waypoint(const std::string& name, const LocalPosition& at, double altitude_m) {
        const auto place = plan_.origin.start + at;
        const auto metres = [](double value) {
            constexpr double scale = 1e7;
            return fmt::format("{}", std::round(value * scale) / scale + 0.0);  // no -0
        };
        add(waypoints_, "waypoint",
            {{"name", name}, {"x", metres(place.east_m)}, {"y", metres(place.north_m)}, {"alt", altitude(altitude_m)}});
        farthest_m_ = std::max(farthest_m_, std::hypot(at.east_m, at.north_m));
    }

    pugi::xml_node add_block(const std::string& name) {
        auto block = blocks_.append_child("block");
        block.append_attribute("name") = name.c_str();
        return block;
    }

    void add_start() {
        add(add_block("Wait GPS"), "while", {{"cond", "!GpsFixValid()"}});
        auto init = add_block("Geo init");
        add(init, "while", {{"cond", "LessThan(NavBlockTime(), 10)"}});
        add(init, "call_once", {{"fun", "NavSetGroundReferenceHere()"}});
        auto holding = add_block("Holding point");
        add(holding, "call_once", {{"fun", "NavKillThrottle()"}});
        add(holding, "attitude", {{"roll", "0"}, {"throttle", "0"}, {"vmode", "throttle"}, {"until", "FALSE"}});
        auto takeoff = add_block("Takeoff");
        add(takeoff, "exception", {{"cond", "GetPosAlt() @GT GetAltRef()+25"}, {"deroute", written_block}});
        add(takeoff, "call_once", {{"fun", "NavResurrect()"}});
        if (plan_.is_rotorcraft)
            add(takeoff, "stay", {{"wp", "HOME"}, {"vmode", "climb"}, {"climb", "nav_climb_vspeed"}});
        else
            add(takeoff, "go", {{"wp", first_name()}, {"vmode", "throttle"}, {"throttle", "1.0"}, {"pitch", "15"}});
    }

    static std::string name_of(std::size_t stop) { return fmt::format("P{}", stop + 1); }
    std::string first_name() const { return list_.stops.empty() ? "HOME" : name_of(0); }

    void add_path() {
        auto block = add_block(written_block);
        add(block, "go", {{"wp", "HOME"}});
        std::string from = "HOME";
        for (std::size_t i = 0; i < list_.stops.size(); ++i) {
            const auto& stop = list_.stops[i];
            const auto name = name_of(i);
            add_waypoint(name, stop.place, stop.altitude_m);
            if (stop.circles) {
                add(block, "circle",
                    {{"wp", name},
                     {"radius", fmt::format("{}", signed_radius_m(*stop.circles))},
                     {"until", fmt::format("NavCircleCount() @GT {}", stop.circles->turns)}});
                from.clear();  // the way on begins at its edge
                continue;
            }
            if (from.empty())
                add(block, "go", {{"wp", name}});
            else
                add(block, "go", {{"from", from}, {"hmode", "route"}, {"wp", name}});
            if (stop.hold_s > 0.0)
                add(block, "stay", {{"wp", name}, {"until", fmt::format("stage_time @GT {}", stop.hold_s)}});
            from = name;
        }
        add(block, "deroute", {{"block", "Land"}});
    }

    void add_landing() {
        add_waypoint("TD", list_.end(), 0.0);
        auto land = add_block("Land");
        constexpr auto is_low = "GetAltRef()+10 @GT GetPosAlt()";
        if (plan_.is_rotorcraft)
            add(land, "stay", {{"wp", "TD"}, {"vmode", "climb"}, {"climb", "nav_descend_vspeed"}});
        else
            add(land, "circle",
                {{"wp", "TD"},
                 {"radius", "nav_radius"},
                 {"vmode", "throttle"},
                 {"throttle", "0.0"},
                 {"until", is_low}});
        add(land, "attitude", {{"roll", "0.0"}, {"throttle", "0.0"}, {"vmode", "throttle"}, {"until", "FALSE"}});
    }

    const PlanToWrite& plan_;
    const StopList& list_;
    pugi::xml_document document_;
    pugi::xml_node waypoints_;
    pugi::xml_node blocks_;
    double farthest_m_ = 0.0;
};

}  // namespace

std::string plan_ending(PlanFormat format) {
    constexpr std::array endings{"", ".xml", ".plan", ".waypoints"};
    return endings.at(static_cast<std::size_t>(format));
}

WrittenPlan write_plan(const PlanToWrite& plan, PlanFormat format) {
    const StopList list(plan);
    WrittenPlan written{{}, list.notes};
    const auto is_hold = [&](const Stop& stop) { return loiters_to_hold(plan, stop); };
    if (format != PlanFormat::flight_plan && std::ranges::any_of(list.stops, is_hold))
        written.notes.emplace_back(
            "holds are written as circles for their time, as wings do not wait at waypoints; circles take more power "
            "than the straight flight that was planned: simulate the written missions");
    const auto has_circles = [](const Stop& stop) { return stop.circles.has_value(); };
    if (format == PlanFormat::qgroundcontrol && std::ranges::any_of(list.stops, has_circles))
        written.notes.emplace_back(
            "circles are written as turns (NAV_LOITER_TURNS), with which PX4 refuses the plan: fly it with ArduPilot");
    if (format == PlanFormat::qgroundcontrol) {
        written.text = qgc_text(plan, list);
    } else if (format == PlanFormat::ardupilot) {
        written.text = wpl_text(plan, list);
    } else {
        written.text = FlightPlanWriter(plan, list).write();
        written.notes.emplace_back("airspeeds are those of the airframe, and the landing is a spiral down: adapt it");
    }
    return written;
}

}  // namespace flightwatt::path

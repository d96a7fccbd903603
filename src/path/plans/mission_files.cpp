#include "path/plans/mission_files.h"

#include "base/number.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "path/plans/fence.h"
#include "path/plans/json_text.h"
#include "path/plans/patterns.h"
#include "path/plans/qgc_items.h"
#include "path/plans/terrain.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

/// None for latitude and longitude 0 or none: where the aircraft is.
std::optional<GeodeticPosition> place_at(double latitude_deg, double longitude_deg, const std::string& name,
                                         const Location& where) {
    if (std::isnan(latitude_deg) || std::isnan(longitude_deg) || (latitude_deg == 0.0 && longitude_deg == 0.0))
        return std::nullopt;
    if (std::abs(latitude_deg) <= 90.0 && std::abs(longitude_deg) <= 180.0)
        return GeodeticPosition{latitude_deg, longitude_deg};
    throw InputError(where, fmt::format("{} is at latitude {}, longitude {}", name, latitude_deg, longitude_deg),
                     "expected degrees");
}

/// Follows the items of a mission.
class ItemReader {
  public:
    ItemReader(const MissionItems& mission, const AutopilotSettings& settings)
        : mission_(mission),
          settings_(settings),
          home_(place_at(mission.home[0], mission.home[1], "home", mission.where)),
          speed_(mission.speed) {
        if (home_ && std::isfinite(mission.home[2])) home_altitude_m_ = mission.home[2];
        const auto planned = std::exchange(home_, settings.home ? settings.home : home_);
        if (home_ && !settings.terrain.empty()) terrain_.emplace(settings.terrain);
        if (terrain_ && planned && home_altitude_m_)
            *home_altitude_m_ += terrain_->ground_m(*home_) - terrain_->ground_m(*planned);
    }

    /// Reads an item, flown for the `round`th time.
    void read(const MissionItem& item, std::size_t round) {
        round_ = round;
        const auto before = entries_.size();
        fly(item);
        if (hovers_ && entries_.size() > before && !lands_here())
            report_missing(item, "it is flown in hover after a transition: its power is taken as that on the wing");
    }

    /// Adds a text to what is not flown; the same text of several items is added once, with their number.
    void report(const MissionItem& item, const std::string& text, bool is_missing = false) {
        auto& items = reports_.try_emplace(text, ReportedItems{item.name, {}, is_missing}).first->second;
        items.names.insert(item.name);
    }

    /// Adds a movement that is not flown.
    void report_missing(const MissionItem& item, const std::string& text) { report(item, text, true); }

    PlanEntries finish(const Location& where) {
        const bool lands = landed_after_ == entries_.size();
        const bool starts_at_home = home_ && !entries_.empty() && !is_at_home(entries_.front());
        if (starts_at_home) {
            entries_.insert(entries_.begin(), PathEntry{});
            entries_.front().name = "home";
            entries_.front().where = where;
            entries_.front().geographic = home_;
        }
        const bool returns = settings_.returns_to_start;
        auto path =
            terrain_ ? along_terrain(entries_, *terrain_, *home_, returns) : TerrainPath{std::move(entries_), {}};
        PlanEntries plan{
            std::move(path.entries),  path.below_ground, path.below_ground, true, starts_at_home, true, lands, speed_,
            mission_.is_of_multirotor};
        plan.home_altitude_m = home_altitude_m_;
        plan.is_of_vtol = mission_.is_of_vtol || std::ranges::any_of(mission_.items, is_of_vtol, &MissionItem::command);
        for (const auto& [text, items] : reports_) {
            const auto more = items.names.size() - 1;
            plan.not_flown.push_back(
                fmt::format("{}{}: {}", items.first, more == 0 ? "" : fmt::format(" and {} more", more), text));
            if (items.is_missing) plan.missing.push_back(plan.not_flown.back());
        }
        if (mission_.is_of_another_vehicle)
            add_missing("it is for a vehicle that is neither a wing, a multirotor nor a VTOL", plan);
        if (mission_.is_of_vtol && settings_.is_rotorcraft)
            add_missing("it is for a VTOL, and the model of a rotorcraft", plan);
        if (!plan.entries.empty()) return plan;
        throw InputError(where, "no item of the mission can be flown",
                         plan.not_flown.empty() ? "it has no items" : plan.not_flown.front());
    }

  private:
    static void add_missing(const char* text, PlanEntries& plan) {
        plan.not_flown.emplace_back(text);
        plan.missing.emplace_back(text);
    }

    void fly(const MissionItem& item) {
        constexpr double to_hover = 3.0;  // MAV_VTOL_STATE
        const auto& parameters = item.parameters;
        switch (item.command) {
            case nav_spline:
                report(item, "a spline is flown as a straight line");
                [[fallthrough]];
            case nav_waypoint:
                return fly_to(item, waypoint_hold_s(item));
            case condition_gate:
                report(item, "the gate is flown through as a waypoint; PX4 flies past one that is off its way");
                return fly_to(item, 0.0);
            case nav_delay:
                return hold(item, parameters[0]);
            case nav_takeoff:
            case nav_vtol_takeoff:
                return take_off(item);
            case nav_loiter_unlimited:
                report_missing(item, "the circle has no end: it is flown once");
                return circle(item, 1.0, false);
            case nav_loiter_turns:
                return circle(item, parameters[0], false);
            case nav_loiter_time:
                return circle(item, parameters[0], true);
            case nav_loiter_to_altitude:
                report(item,
                       "circles until an altitude is reached take the height that the way there is too short for, and "
                       "are flown straight on");
                return fly_to(item, 0.0);
            case nav_return:
                return go_home(item);
            case nav_land:
            case nav_vtol_land:
                report(item, "the way to the landing is flown level; the descent is the mission's landing");
                fly_level_to(item);
                landed_after_ = entries_.size();
                return;
            case change_speed:
                return set_speed(item);
            case vtol_transition:
                hovers_ = parameters[0] == to_hover && !settings_.is_rotorcraft;
                return;
            default: {
                const auto text = unflown_text(item.command);
                is_movement(item.command) ? report_missing(item, text) : report(item, text);
            }
        }
    }

    /// Whether the last entry is a landing at the place before it, which is the model's.
    bool lands_here() const {
        if (landed_after_ != entries_.size() || entries_.size() < 2) return false;
        const auto& from = entries_[entries_.size() - 2].geographic;
        return from && is_near(*entries_.back().geographic, *from);
    }

    static bool is_near(const GeodeticPosition& place, const GeodeticPosition& other) {
        constexpr double near_m = 10.0;  // as far as ground stations place it
        const auto away = to_local(place, other);
        return std::hypot(away.east_m, away.north_m) <= near_m;
    }

    /// Whether it is a take-off at home.
    bool is_at_home(const PathEntry& entry) const {
        return takes_off_ && entry.geographic && is_near(*entry.geographic, *home_);
    }

    PathEntry entry_of(const MissionItem& item) const {
        PathEntry entry;
        entry.name = round_ == 1 ? item.name : fmt::format("{}, round {}", item.name, round_);
        entry.where = item.where;
        entry.airspeed_m_per_s = airspeed_m_per_s_;
        entry.geographic = place_at(item.parameters[4], item.parameters[5], item.name, item.where);
        return entry;
    }

    PathEntry entry_at_altitude(const MissionItem& item) {
        auto entry = entry_of(item);
        entry.altitude_m = altitude_of(item);
        entry.is_above_terrain = terrain_ && entry.altitude_m && is_above_terrain(item);
        if (!entry.is_above_terrain) return entry;
        const auto last = std::ranges::find_if(entries_.rbegin(), entries_.rend(), has_place);
        const auto place = entry.geographic ? entry.geographic : last != entries_.rend() ? last->geographic : home_;
        *entry.altitude_m += terrain_->ground_m(*place) - terrain_->ground_m(*home_);
        return entry;
    }

    static bool has_place(const PathEntry& entry) { return entry.geographic.has_value(); }

    static bool is_above_terrain(const MissionItem& item) { return item.frame == 10 || item.frame == 11; }

    /// Above home, but for one above the terrain; frames are MAV_FRAME.
    std::optional<double> altitude_of(const MissionItem& item) {
        const double altitude_m = item.parameters[6];
        if (item.frame == 2) return std::nullopt;  // a command without a place
        if (std::isnan(altitude_m) && entry_of(item).geographic)
            report_missing(item, "its altitude is not stated: it is flown as high as the item before");
        if (std::isnan(altitude_m)) return std::nullopt;
        if (item.parameters[4] == 0.0 && item.parameters[5] == 0.0 && altitude_m == 0.0)
            return std::nullopt;  // as it is
        if (item.frame == 0 || item.frame == 5) {
            if (home_altitude_m_) return altitude_m - *home_altitude_m_;
            report_missing(item, "the altitude above the sea is not flown, as the plan does not state that of home");
            return std::nullopt;
        }
        if (is_above_terrain(item)) {
            if (!terrain_)
                report_missing(item, settings_.terrain.empty()
                                         ? "the altitude above the terrain is flown as one above home: terrain "
                                           "(--terrain) names a folder of its heights"
                                         : "the altitude above the terrain is flown as one above home, which the plan "
                                           "does not state: start (--home) does");
        } else if (item.frame != 3 && item.frame != 6) {
            throw InputError(item.where, fmt::format("{} has its altitude in frame {}", item.name, item.frame),
                             "expected 0 (above the sea), 3 (above home) or 10 (above the terrain)");
        }
        return altitude_m;
    }

    void fly_to(const MissionItem& item, double hold_s) {
        auto entry = entry_at_altitude(item);
        if (hold_s > 0.0) entry.hold_s = hold_s;
        entry.waits_for_altitude = settings_.is_rotorcraft || item.command == nav_loiter_to_altitude;
        if (!entry.geographic && !entry.hold_s) return report_missing(item, "there is no place: not flown");
        entries_.push_back(entry);
    }

    /// How long the aircraft waits at a waypoint: wings do not.
    double waypoint_hold_s(const MissionItem& item) {
        const double hold_s = item.parameters[0];
        if (!(hold_s > 0.0) || hovers_ || settings_.is_rotorcraft || mission_.is_of_multirotor.value_or(false))
            return hold_s;
        report(item,
               "the hold is not flown, as wings do not wait at waypoints: circles for a time are NAV_LOITER_TIME");
        return 0.0;
    }

    void fly_level_to(const MissionItem& item) {
        if (const auto entry = entry_of(item); entry.geographic) entries_.push_back(entry);
    }

    void hold(const MissionItem& item, double time_s) {
        if (!(time_s > 0.0)) return report_missing(item, "the delay has no time: not flown");
        entries_.push_back(entry_of(item));
        entries_.back().geographic.reset();
        entries_.back().hold_s = time_s;
    }

    /// Where the path starts.
    void take_off(const MissionItem& item) {
        auto entry = entry_at_altitude(item);
        if (!entry.geographic) entry.geographic = home_;
        if (!entries_.empty()) return report_missing(item, "the take-off is not flown");
        if (!entry.geographic) return report(item, "the take-off is not flown");
        entries_.push_back(entry);
        takes_off_ = true;
    }

    void go_home(const MissionItem& item) {
        auto entry = entry_of(item);
        entry.geographic = home_;
        if (!home_) return report(item, "the return is not flown: the plan states no home");
        if (mission_.has_rally_points)
            report_missing(item, "the return is flown to home, not to one of the plan's rally points");
        entries_.push_back(entry);
    }

    void circle(const MissionItem& item, double amount, bool is_time) {
        const double stated_m = item.parameters[2];
        const bool is_stated = std::isfinite(stated_m) && std::abs(stated_m) >= min_radius_m;
        if (is_time && settings_.is_rotorcraft) return fly_to(item, amount);
        const double radius_m = is_stated ? stated_m : settings_.radius_m.value_or(assumed_radius_m(item));
        const double planned =
            settings_.airspeed_m_per_s > 0.0 || !speed_ ? settings_.airspeed_m_per_s : speed_->m_per_s;
        const double airspeed = airspeed_m_per_s_.value_or(planned);
        require_in(between(-max_radius_m, max_radius_m), radius_m, "the radius", item.where);
        double turns = is_time && !(airspeed > 0.0) ? 1.0 : amount;
        if (is_time && airspeed > 0.0)
            turns /= circle_time_s(std::abs(radius_m), airspeed, settings_.wind, settings_.turns);
        if (!(turns > 0.0)) return fly_to(item, 0.0);
        require_in(between(0.0, largest_circle_count), turns, "the number of circles", item.where);
        entries_.push_back(with_circles(entry_at_altitude(item), turns, radius_m));
    }

    /// What the autopilots have where nothing was set: NAV_LOITER_RAD of PX4, WP_LOITER_RAD of ArduPlane and
    /// CIRCLE_RADIUS of ArduCopter.
    double assumed_radius_m(const MissionItem& item) {
        const auto [radius_m, autopilot] = settings_.is_rotorcraft    ? std::pair{10.0, "ArduCopter"}
                                           : mission_.is_of_ardupilot ? std::pair{60.0, "ArduPlane"}
                                                                      : std::pair{80.0, "PX4"};
        if (!settings_.radius_m)
            report(item, fmt::format("the circle has no radius: {:.0f} m are assumed, of {}; radius_m in [path] states "
                                     "another",
                                     radius_m, autopilot));
        return radius_m;
    }

    void set_speed(const MissionItem& item) {
        if (settings_.one_airspeed) return;
        const double kind = item.parameters[0];  // SPEED_TYPE: 0 airspeed, 1 ground speed, as multirotors have it
        const double speed = item.parameters[1];
        constexpr double of_settings = -2.0;
        if (speed == of_settings) return airspeed_m_per_s_.reset();
        if (!(kind == 0.0 || kind == 1.0) || !(speed > 0.0 && speed <= max_m_per_s))
            return report(item, "the change of speed is not flown: it states no airspeed");
        if (kind == 1.0 && !settings_.is_rotorcraft)
            report(item, "the ground speed is flown as an airspeed, which it is in calm air");
        airspeed_m_per_s_ = speed;
    }

    struct ReportedItems {
        std::string first;
        std::set<std::string> names;
        bool is_missing = false;
    };

    const MissionItems& mission_;
    const AutopilotSettings& settings_;
    std::optional<GeodeticPosition> home_;
    std::optional<PlannedSpeed> speed_;
    std::optional<double> home_altitude_m_;
    std::optional<Terrain> terrain_;           ///< where its heights and home are known
    bool takes_off_ = false;                   ///< an item states where
    bool hovers_ = false;                      ///< a VTOL, after a transition to hover
    std::optional<std::size_t> landed_after_;  ///< so many entries
    std::size_t round_ = 1;                    ///< of the item
    std::optional<double> airspeed_m_per_s_;
    std::vector<PathEntry> entries_;
    std::map<std::string, ReportedItems> reports_;
};

/// The items in the order of the flight: as often as jumps repeat them.
class MissionFlight {
  public:
    explicit MissionFlight(const MissionItems& mission)
        : mission_(mission), rounds_(mission.items.size()), taken_(mission.items.size()) {}

    PlanEntries fly(const AutopilotSettings& settings) {
        ItemReader reader(mission_, settings);
        std::size_t repeated = 0;
        for (std::size_t i = 0; i < mission_.items.size();) {
            const auto& item = mission_.items[i];
            if (++rounds_[i] > 1 && ++repeated > max_repeated_items)
                throw InputError(item.where,
                                 fmt::format("{}: its jumps repeat more than {} items", item.name, max_repeated_items),
                                 "state fewer repetitions: no battery lasts as long");
            if (item.command == jump) {
                i = next_of_jump(i, reader);
            } else {
                reader.read(item, rounds_[i]);
                ++i;
                if (item.command != nav_return) continue;
                if (i < mission_.items.size())
                    reader.report(mission_.items[i], "it follows the return, with which the mission ends: not flown");
                break;
            }
        }
        return reader.finish(mission_.where);
    }

  private:
    static constexpr std::size_t max_repeated_items = 2'000;

    std::size_t next_of_jump(std::size_t i, ItemReader& reader) {
        const auto& item = mission_.items[i];
        const double to = item.parameters[0];
        const double times = item.parameters[1];
        const auto target = std::ranges::find(mission_.items, to, &MissionItem::number);
        if (target == mission_.items.end() || !(to >= 0.0) || !(times >= 0.0)) {
            reader.report_missing(item, fmt::format("the jump to item {:.0f} is not flown: {}", to,
                                                    times < 0.0 ? "it has no end" : "there is no such item"));
            return i + 1;
        }
        if (taken_[i] < std::floor(times)) {
            taken_[i] += 1.0;
            return static_cast<std::size_t>(target - mission_.items.begin());
        }
        // PX4 does not count a jump again that is reached after its last repetition.
        if (!mission_.is_of_px4 && std::exchange(taken_[i], 0.0) > 0.0 && rounds_[i] > times + 1.0)
            reader.report(item,
                          "the jump is repeated in each round of another, as ArduPilot does from 4.7 on; earlier "
                          "versions and PX4 repeat it once");
        return i + 1;
    }

    const MissionItems& mission_;
    std::vector<std::size_t> rounds_;  ///< of each item so far
    std::vector<double> taken_;        ///< how often each jump was followed
};

/// The numbers of a line, 12 or none.
std::vector<double> item_numbers(const std::string& line, const Location& where) {
    constexpr std::size_t columns = 12;
    std::istringstream words(line);
    std::vector<double> values;
    for (std::string word; words >> word;) {
        const auto value = parse_number(word);
        if (!value)
            throw InputError(where, fmt::format("'{}' is no number", truncated(word)),
                             fmt::format("expected {} numbers", columns));
        values.push_back(*value);
    }
    if (values.empty() || values.size() == columns) return values;
    throw InputError(where, fmt::format("has {} numbers", values.size()),
                     fmt::format("expected {}: is the file cut off?", columns));
}

}  // namespace

PlanEntries parse_qgc_plan(std::string_view text, const std::string& file, const AutopilotSettings& settings) {
    const auto json = parse_json(text, file, "expected a plan of QGroundControl");
    const auto mission = read_qgc_items(json, file, settings.is_rotorcraft);
    auto plan = MissionFlight(mission).fly(settings);
    plan.fence = read_fence(json);
    return plan;
}

PlanEntries parse_wpl(std::string_view text, const std::string& file, const AutopilotSettings& settings) {
    std::istringstream lines{std::string(without_byte_order_mark(text))};
    std::string line;
    std::getline(lines, line);
    constexpr std::string_view version = "QGC WPL 110";
    const bool is_without_home = line.starts_with("QGC WPL 120");
    if (!line.starts_with(version) && !is_without_home)
        throw InputError({file, 1}, fmt::format("begins with '{}'", truncated(line)),
                         fmt::format("expected \"{}\"", version));
    MissionItems mission;
    mission.is_of_ardupilot = !is_without_home;  // PX4's files have no home
    if (is_without_home) mission.where = {file, 1};
    for (std::size_t number = 2; std::getline(lines, line); ++number) {
        const auto values = item_numbers(line, {file, number});
        if (values.empty()) continue;
        if (mission.where.line == 0) {  // the first item is home, except in files of PX4
            mission.where = {file, number};
            if (values[3] == nav_waypoint) {
                std::copy_n(values.begin() + 8, mission.home.size(), mission.home.begin());
                continue;
            }
        }
        MissionItem item{static_cast<int>(std::clamp(values[3], -1.0, 1e6)),
                         static_cast<int>(std::clamp(values[2], -1.0, 1e6)),
                         {},
                         fmt::format("item {} (line {})", values[0], number),
                         {file, number},
                         values[0]};
        std::copy_n(values.begin() + 4, item.parameters.size(), item.parameters.begin());
        mission.items.push_back(std::move(item));
    }
    if (mission.where.line == 0) throw InputError({file}, "has no items", "expected home and waypoints");
    return MissionFlight(mission).fly(settings);
}

}  // namespace flightwatt::path

#include "live/link_mission.h"

#include "base/number.h"
#include "base/units.h"
#include "telemetry/mavlink_decoder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::live {
namespace {

constexpr std::size_t max_items = 10'000;
constexpr double units_per_degree = 1e7;
constexpr double metre_per_unit = 1e-3;
constexpr double waypoint_command = 16.0;
constexpr double frame_above_sea = 0.0;
constexpr double no_place = std::numeric_limits<std::int32_t>::max();

}  // namespace

bool LinkMission::receive(const IncomingMessage& message) {
    const auto packet = telemetry::read_mavlink_packet(message.packet);
    if (!packet) return false;
    const auto& name = packet->name;
    const auto of = [&](const char* field) { return packet->of.at(field); };
    if (name == "HEARTBEAT") {
        constexpr double ardupilot = 3.0;
        constexpr unsigned armed_flag = 128;
        system_ = packet->system;
        is_ardupilot_ = of("autopilot") == ardupilot;
        is_disarmed_ = (static_cast<unsigned>(of("base_mode")) & armed_flag) == 0;
    } else if (name == "HOME_POSITION" && (of("latitude") != 0.0 || of("longitude") != 0.0)) {
        stated_home_ = {of("latitude") / units_per_degree, of("longitude") / units_per_degree,
                        of("altitude") * metre_per_unit};
    } else if (name == "GLOBAL_POSITION_INT" && is_disarmed_ && (of("lat") != 0.0 || of("lon") != 0.0)) {
        parked_ = {of("lat") / units_per_degree, of("lon") / units_per_degree, of("alt") * metre_per_unit};
    } else if (name == "MISSION_COUNT" && of("count") <= max_items && !(of("mission_type") > 0.0)) {
        forget_items();  // those of another mission
        count_ = static_cast<std::size_t>(of("count"));
        is_answer_ = is_to_us(packet->of);
    } else if (name == "MISSION_ACK" && of("type") == 0.0 && !(of("mission_type") > 0.0)) {
        is_outdated_ = !whole_.empty();
        forget_items();
    } else if (name == "MISSION_ACK" && is_answer_ && is_to_us(packet->of)) {
        forget_items();  // the aircraft has given up
    } else if ((name == "MISSION_ITEM_INT" || name == "MISSION_ITEM") && of("seq") < max_items &&
               !(of("mission_type") > 0.0)) {
        const bool has_place = of("x") != no_place && of("y") != no_place;
        const double per_degree = name == "MISSION_ITEM" ? 1.0 : units_per_degree;
        Item item{of("frame"),
                  of("command"),
                  {of("param1"), of("param2"), of("param3"), of("param4"), has_place ? of("x") / per_degree : 0.0,
                   has_place ? of("y") / per_degree : 0.0, of("z")}};
        for (auto& value : item.parameters)
            if (!std::isfinite(value)) value = 0.0;
        if (is_ardupilot_ && of("seq") == 0.0 && item.has_place()) stated_home_ = item.place();
        items_[static_cast<std::size_t>(of("seq"))] = item;
    }
    if (!is_whole()) return false;
    is_outdated_ = false;
    if (items_ == whole_ && !has_other_home()) return false;
    whole_ = items_;
    whole_home_ = home();
    return true;
}

bool LinkMission::is_to_us(const std::map<std::string, double, std::less<>>& packet) const {
    return packet.at("target_system") == own_system_ && packet.at("target_component") == own_component_;
}

void LinkMission::forget_items() {
    count_.reset();
    items_.clear();
    is_answer_ = false;
    asked_.reset();
    seen_items_.reset();
}

/// Whether items that a ground station asks for have come in the last seconds.
bool LinkMission::is_reading_of_others(double now_s) {
    constexpr double pause_s = 3.0;
    if (!count_ || *count_ == 0) return false;
    if (seen_items_ != items_.size()) asked_s_ = now_s;
    seen_items_ = items_.size();
    return now_s < asked_s_ + pause_s;
}

std::vector<std::string> LinkMission::requests(double now_s) {
    constexpr double autopilot = 1.0;
    constexpr double again_s = 1.0;
    constexpr double again_if_none_s = 10.0;
    constexpr int max_times = 5;
    if (system_ == 0.0) return {};
    telemetry::MavlinkSender::Values target{{"target_system", system_}, {"target_component", autopilot}};
    const bool has_all = count_ && items_.size() == *count_;
    if (has_all && std::exchange(is_answer_, false)) return {sender_.packet("MISSION_ACK", target)};
    if (is_whole() || (!is_answer_ && is_reading_of_others(now_s))) return {};
    if (is_answer_) {
        std::size_t next = 0;
        while (items_.contains(next)) ++next;
        if (asked_ != next)
            asked_times_ = 0;
        else if (now_s < asked_s_ + again_s)
            return {};
        if (asked_times_++ < max_times) {
            asked_ = next;
            asked_s_ = now_s;
            target["seq"] = static_cast<double>(next);
            return {sender_.packet("MISSION_REQUEST_INT", target)};
        }
        forget_items();
    }
    if (now_s < asked_s_ + (count_ && *count_ == 0 ? again_if_none_s : again_s)) return {};
    asked_s_ = now_s;
    return {sender_.packet("MISSION_REQUEST_LIST", target)};
}

/// Nearer is the same home: it is stated again with each position of a receiver.
bool LinkMission::is_elsewhere(const Place& home, const Place& than) {
    constexpr double near_m = 30.0;
    constexpr double metre_per_degree = 111'320.0;
    constexpr double turn_deg = 360.0;
    const double east_deg = std::remainder(home[1] - than[1], turn_deg) * std::cos(than[0] / units::degree_per_rad);
    return metre_per_degree * std::hypot(home[0] - than[0], east_deg) > near_m;
}

bool LinkMission::has_other_home() const {
    return has_home() != whole_home_.has_value() || (has_home() && is_elsewhere(*home(), *whole_home_));
}

/// ArduPilot's first item is its home as it was when it was read, without a place until it is set; others keep it apart
/// from the items.
std::string LinkMission::waypoints() const {
    std::string text = "QGC WPL 110\n";
    const auto add = [&](std::size_t number, const Item& item) {
        text +=
            fmt::format("{}\t0\t{}\t{}\t{}\t1\n", number, item.frame, item.command, fmt::join(item.parameters, "\t"));
    };
    auto items = whole_;
    const auto home_at = [](const Place& at) {
        return Item{frame_above_sea, waypoint_command, {0.0, 0.0, 0.0, 0.0, at[0], at[1], at[2]}};
    };
    auto& first_item = items.begin()->second;
    if (is_ardupilot_ && home() && (!first_item.has_place() || is_elsewhere(*home(), first_item.place())))
        first_item = home_at(*home());
    if (!is_ardupilot_) {
        const auto placed = std::ranges::find_if(items, [](const auto& of) { return of.second.has_place(); });
        const auto& first = placed == items.end() ? first_item : placed->second;
        add(0, home_at(home().value_or(Place{first.parameters[4], first.parameters[5], 0.0})));
    }
    for (const auto& [number, item] : items) add(number + (is_ardupilot_ ? 0 : 1), item);
    return text;
}

}  // namespace flightwatt::live

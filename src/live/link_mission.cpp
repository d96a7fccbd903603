#include "live/link_mission.h"

#include "base/number.h"
#include "telemetry/mavlink_decoder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::live {
namespace {

constexpr std::size_t max_items = 10'000;
constexpr double units_per_degree = 1e7;
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
        system_ = packet->system;
        is_ardupilot_ = of("autopilot") == ardupilot;
    } else if (name == "HOME_POSITION") {
        constexpr double metre_per_unit = 1e-3;
        home_ = {of("latitude") / units_per_degree, of("longitude") / units_per_degree,
                 of("altitude") * metre_per_unit};
    } else if (name == "MISSION_COUNT" && of("count") <= max_items && !(of("mission_type") > 0.0)) {
        count_ = static_cast<std::size_t>(of("count"));
        items_.clear();  // those of another mission
    } else if (name == "MISSION_ACK" && of("type") == 0.0 && !(of("mission_type") > 0.0)) {
        is_outdated_ = !whole_.empty();
        count_.reset();
        items_.clear();
    } else if (name == "MISSION_ITEM_INT" && of("seq") < max_items && !(of("mission_type") > 0.0)) {
        const bool has_place = of("x") != no_place && of("y") != no_place;
        Item item{of("frame"),
                  of("command"),
                  {of("param1"), of("param2"), of("param3"), of("param4"), has_place ? of("x") / units_per_degree : 0.0,
                   has_place ? of("y") / units_per_degree : 0.0, of("z")}};
        for (auto& value : item.parameters)
            if (!std::isfinite(value)) value = 0.0;
        items_[static_cast<std::size_t>(of("seq"))] = item;
    }
    if (!is_whole()) return false;
    is_outdated_ = false;
    if (items_ == whole_ && whole_has_home_ == home_.has_value()) return false;
    whole_ = items_;
    whole_has_home_ = home_.has_value();
    return true;
}

std::vector<std::string> LinkMission::requests(double now_s) {
    constexpr double autopilot = 1.0;
    constexpr std::size_t at_once = 20;
    if (system_ == 0.0 || is_whole() || now_s < asked_s_ + 1.0) return {};
    asked_s_ = now_s;
    const telemetry::MavlinkSender::Values target{{"target_system", system_}, {"target_component", autopilot}};
    if (!count_ || *count_ == 0) return {sender_.packet("MISSION_REQUEST_LIST", target)};
    std::vector<std::string> packets;
    for (std::size_t item = 0; item < *count_ && packets.size() < at_once; ++item) {
        if (items_.contains(item)) continue;
        auto values = target;
        values["seq"] = static_cast<double>(item);
        packets.push_back(sender_.packet("MISSION_REQUEST_INT", values));
    }
    return packets;
}

/// ArduPilot's first item is its home; other autopilots keep it apart from the items.
std::string LinkMission::waypoints() const {
    std::string text = "QGC WPL 110\n";
    const auto add = [&](std::size_t number, const Item& item) {
        text +=
            fmt::format("{}\t0\t{}\t{}\t{}\t1\n", number, item.frame, item.command, fmt::join(item.parameters, "\t"));
    };
    if (!is_ardupilot_) {
        const auto has_place = [](const auto& item) {
            return item.second.parameters[4] != 0.0 || item.second.parameters[5] != 0.0;
        };
        const auto placed = std::ranges::find_if(whole_, has_place);
        const auto& first = (placed == whole_.end() ? whole_.begin() : placed)->second.parameters;
        const auto home = home_.value_or(std::array{first[4], first[5], 0.0});
        add(0, {frame_above_sea, waypoint_command, {0.0, 0.0, 0.0, 0.0, home[0], home[1], home[2]}});
    }
    for (const auto& [number, item] : whole_) add(number + (is_ardupilot_ ? 0 : 1), item);
    return text;
}

}  // namespace flightwatt::live

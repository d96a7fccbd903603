#include "telemetry/mavlink/vehicles.h"

#include <set>

namespace flightwatt::telemetry {
namespace {

constexpr int first_battery = 180;
constexpr int second_battery = 181;

}  // namespace

bool is_autopilot(const MavlinkFrame& heartbeat) {
    constexpr double no_autopilot = 8.0;
    const std::set<double> others{6.0, 18.0, 26.0, 27.0, 30.0};  // ground station, computer, gimbal, ADS-B, camera
    return heartbeat.number("autopilot") != no_autopilot && !others.contains(heartbeat.number("type"));
}

void add_autopilot(const MavlinkFrame& heartbeat, std::map<int, Autopilot>& autopilots) {
    constexpr double generic = 0.0;  // also what cameras and computers state that leave their type out
    constexpr int usual_component = 1;
    const int rank =
        (heartbeat.number("autopilot") != generic ? 2 : 0) + (heartbeat.component == usual_component ? 1 : 0);
    const Autopilot claims{heartbeat.component, rank};
    auto& known = autopilots.try_emplace(heartbeat.system, claims).first->second;
    if (rank > known.rank) known = claims;
}

bool is_of_vehicle(const MavlinkFrame& frame, int component) {
    const bool is_battery = frame.component == first_battery || frame.component == second_battery;
    return frame.component == component || (is_battery && frame.id == mavlink_message("BATTERY_STATUS").id);
}

double value_of(const MavlinkFrame& frame, std::size_t field) {
    const auto& layout = frame.message->layout;
    const double value = layout.fields[field].number(frame.payload);
    const bool is_second = frame.component == second_battery && layout.name == "BATTERY_STATUS";
    return is_second && value == 0.0 && layout.fields[field].name == "id" ? 1.0 : value;
}

}  // namespace flightwatt::telemetry

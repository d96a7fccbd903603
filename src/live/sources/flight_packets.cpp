#include "live/sources/flight_packets.h"

#include "base/error.h"
#include "base/units.h"
#include "flight/segment.h"
#include "flight/select.h"
#include "telemetry/mavlink_sender.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

namespace flightwatt::live {
namespace {

double state_or(const flight::Track& track, double time_s, double otherwise) {
    return track.empty() ? otherwise : state_at(track, time_s);
}

/// The altitude of the ground by the first flight; std::nullopt without one. The lowest altitude is less where those of
/// the log drift or jump.
std::optional<double> ground_of_first_flight_m(const flight::FlightData& data) {
    try {
        const auto phases = flight::segment(data);
        if (!phases.sorties.empty()) return phases.sorties.front().ground_altitude_m;
    } catch (const std::exception&) {  // what the log has shows no flight
    }
    return std::nullopt;
}

/// Packets of an aircraft by its tracks, with the state of the others at each time.
class AircraftSender {
  public:
    explicit AircraftSender(const flight::FlightData& data) : data_(data) {
        const auto ground_m = stated_ground_altitude_m(data);
        if (const auto& of_log = data.altitude_m.value; ground_m || !of_log.empty())
            ground_m_ = ground_m ? *ground_m : ground_of_first_flight_m(data).value_or(std::ranges::min(of_log));
    }

    void send_heartbeat(double time_s) {
        constexpr double fixed_wing = 1.0;
        constexpr double quadrotor = 2.0;
        constexpr double vtol = 22.0;
        constexpr double no_autopilot_of_its_own = 0.0;  // generic
        constexpr double armed = 128.0;
        add(time_s, "HEARTBEAT",
            {{"type", !data_.vtol_state.empty() ? vtol
                      : data_.is_rotorcraft()   ? quadrotor
                                                : fixed_wing},
             {"autopilot", no_autopilot_of_its_own},
             {"base_mode", state_or(data_.armed, time_s, 1.0) * armed},
             {"custom_mode", state_or(data_.mode, time_s, 0.0)},
             {"mavlink_version", 3.0}});
        send_landed_state(time_s);
        constexpr double airspeed_sensor = 16.0;
        const double sensors = data_.airspeed_is_measured() ? airspeed_sensor : 0.0;
        add(time_s, "SYS_STATUS",
            {{"onboard_control_sensors_present", sensors},
             {"onboard_control_sensors_enabled", sensors},
             {"onboard_control_sensors_health", sensors},
             {"voltage_battery", 65'535.0},
             {"current_battery", -1.0},
             {"battery_remaining", -1.0}});
    }

    /// Only where the log knows whether it flies, or what carries it.
    void send_landed_state(double time_s) {
        if (data_.landed.empty() && data_.vtol_state.empty()) return;
        constexpr double on_ground = 1.0;
        constexpr double in_air = 2.0;
        const auto& landed = data_.landed;
        const bool is_known = !landed.empty() && time_s >= landed.time_s.front();  // some logs have the changes alone
        const double state = !is_known ? 0.0 : state_at(landed, time_s) == 1.0 ? on_ground : in_air;
        add(time_s, "EXTENDED_SYS_STATE",
            {{"vtol_state", state_or(data_.vtol_state, time_s, 0.0)}, {"landed_state", state}});
    }

    /// A voltage of more than 65.534 V continues in the second cell, as autopilots do.
    void send_battery(double time_s, double power_w) {
        constexpr double cell_limit_mv = 65'534.0;
        constexpr double no_temperature = 32'767.0;
        const double voltage_v = value_at(data_.voltage_v, time_s);
        const double voltage_mv = voltage_v / units::milli;
        const bool has_current = voltage_v > 0.0 && power_w / voltage_v <= max_mavlink_current_a;
        telemetry::MavlinkSender::Values values{
            {"current_consumed", state_or(data_.charge_ah, time_s, -units::milli) / units::milli},
            {"energy_consumed", -1.0},
            {"temperature", no_temperature},
            {"current_battery", has_current ? 100.0 * power_w / voltage_v : -1.0},
            {"battery_remaining", -1.0},
            {"voltages[0]", std::min(voltage_mv, cell_limit_mv)},
            {"voltages[1]", voltage_mv > cell_limit_mv ? voltage_mv - cell_limit_mv : cell_limit_mv + 1.0}};
        for (const auto* cell : {"voltages[2]", "voltages[3]", "voltages[4]", "voltages[5]", "voltages[6]",
                                 "voltages[7]", "voltages[8]", "voltages[9]"})
            values[cell] = cell_limit_mv + 1.0;
        add(time_s, "BATTERY_STATUS", values);
    }

    void send_position(double time_s, double altitude_m) {
        const double speed = state_or(data_.ground_speed_m_per_s, time_s, 0.0);
        const double course = state_or(data_.course_deg, time_s, 0.0) / units::degree_per_rad;
        const double climb = state_or(data_.climb_m_per_s, time_s, 0.0);
        const double heading = state_or(data_.heading_deg, time_s, 655.35);
        add(time_s, "GLOBAL_POSITION_INT",
            {{"time_boot_ms", time_s / units::milli},
             {"lat", state_or(data_.latitude_deg, time_s, 0.0) * 1e7},
             {"lon", state_or(data_.longitude_deg, time_s, 0.0) * 1e7},
             {"alt", altitude_m / units::milli},
             {"relative_alt", (altitude_m - ground_m_) / units::milli},
             {"vx", 100.0 * speed * std::cos(course)},
             {"vy", 100.0 * speed * std::sin(course)},
             {"vz", -100.0 * climb},
             {"hdg", 100.0 * heading}});
        add(time_s, "VFR_HUD",
            {{"airspeed", state_or(data_.airspeed_m_per_s, time_s, 0.0)},
             {"groundspeed", speed},
             {"alt", altitude_m},
             {"climb", climb},
             {"throttle", state_or(data_.throttle_percent, time_s, 0.0)}});
    }

    std::vector<IncomingMessage> take() { return std::move(messages_); }

  private:
    void add(double time_s, std::string_view name, const telemetry::MavlinkSender::Values& values) {
        auto& message = messages_.emplace_back();
        message.time_s = time_s;
        message.packet = sender_.packet(name, values);
    }

    const flight::FlightData& data_;
    double ground_m_ =
        0.0;  ///< altitude of the ground, as the log states it, else of the first flight, else the lowest
    telemetry::MavlinkSender sender_{1, 1};
    std::vector<IncomingMessage> messages_;
};

}  // namespace

std::vector<IncomingMessage> flight_packets(const flight::FlightData& data) {
    if (data.power_w.empty() || data.voltage_v.empty())
        throw InputError({data.file}, "has no measured power with its voltage", "MAVLink states voltage and current");
    AircraftSender sender(data);
    const auto& power = data.power_w;
    const auto& altitude = data.altitude_m;
    double heartbeat_s = -std::numeric_limits<double>::infinity();
    std::size_t p = 0;
    std::size_t a = 0;
    while (p < power.time_s.size() || a < altitude.time_s.size()) {
        const bool is_power =
            a == altitude.time_s.size() || (p < power.time_s.size() && power.time_s[p] <= altitude.time_s[a]);
        const double time_s = is_power ? power.time_s[p] : altitude.time_s[a];
        if (time_s >= heartbeat_s + 1.0) sender.send_heartbeat(heartbeat_s = time_s);
        if (is_power)
            sender.send_battery(time_s, power.value[p++]);
        else
            sender.send_position(time_s, altitude.value[a++]);
    }
    return sender.take();
}

}  // namespace flightwatt::live

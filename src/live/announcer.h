#pragma once

#include "live/live_state.h"
#include "telemetry/mavlink_sender.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace flightwatt::live {

/// Puts a prediction into packets of MAVLink for a ground station: a heartbeat of an onboard computer, once a second
/// `fw_land` (charge at landing, %), `fw_home` (minutes until the turn for home, 0: now) and `fw_resv` (minutes to the
/// reserve), those that are known and not of a silent link, and a text at each change of an alarm's grade, or of what it
/// asks for. It never makes a command.
class Announcer {
  public:
    /// Announces as a component of a system.
    Announcer(std::uint8_t system, std::uint8_t component) : sender_(system, component) {}

    /// Returns the packets that are due at `now_s`, on a clock that does not go back.
    std::vector<std::string> packets(const LiveState& state, double now_s);

  private:
    struct Announced {
        std::string grade = {};    ///< of the last text: "caution", "alarm", or empty: none
        std::string request = {};  ///< what it asked for, see request_of()
        double at_s = 0.0;         ///< its time
    };

    void add_values(const LiveState& state, double now_s, std::vector<std::string>& packets);
    void add_texts(const LiveState& state, double now_s, std::vector<std::string>& packets);

    telemetry::MavlinkSender sender_;
    std::map<std::string, Announced> announced_;  ///< by kind of alarm
    double values_due_s_ = 0.0;
};

}  // namespace flightwatt::live

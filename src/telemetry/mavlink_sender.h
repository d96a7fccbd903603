#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace flightwatt::telemetry {

/// Makes packets of MAVLink 2 as a component of a system, with rising sequence numbers.
class MavlinkSender {
  public:
    using Values = std::map<std::string_view, double>;

    /// By default an onboard computer of the system of ground stations' programs, which no vehicle has.
    explicit MavlinkSender(std::uint8_t system = 245, std::uint8_t component = 191)
        : system_(system), component_(component) {}

    /// Returns a packet with fields of a message of FlightWatt's table; those that are not given are zero. Values are
    /// rounded and limited to the range of their type, NaN to 0 of whole numbers. `text` fills the message's field of
    /// characters.
    std::string packet(std::string_view message, const Values& values, std::string_view text = "");
    /// Returns the heartbeat of an onboard computer that flies nothing.
    std::string heartbeat();

  private:
    std::uint8_t system_;
    std::uint8_t component_;
    std::uint8_t sequence_ = 0;
};

}  // namespace flightwatt::telemetry

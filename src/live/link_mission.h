#pragma once

#include "live/sources.h"
#include "telemetry/mavlink_sender.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::live {

/// Collects the mission of one aircraft from its messages on a link of MAVLink, which pass by while a ground station
/// reads it, and asks for it (MAVLink's mission protocol). A mission of more than 10,000 items is not collected.
class LinkMission {
  public:
    /// Asks as this component of this system.
    LinkMission(std::uint8_t system, std::uint8_t component)
        : own_system_(system), own_component_(component), sender_(system, component) {}

    /// Takes a message of the aircraft; returns whether its mission is whole, and new or flown from another home.
    bool receive(const IncomingMessage& message);
    /// Returns the packet that is due on a clock that does not go back: it asks for the mission, then for one item after
    /// the other, as PX4 wants them, each again after a second, and states that all were received. None before the
    /// aircraft was heard, while a ground station reads the mission, and once it is whole.
    std::vector<std::string> requests(double now_s);
    /// Returns whether another mission was uploaded since, which is not whole yet, or it was cleared.
    bool is_outdated() const { return is_outdated_; }
    /// Returns whether its home is known: by the mission, by the aircraft, or as the place where this was disarmed.
    bool has_home() const { return home().has_value(); }
    /// Returns the whole mission as a file of waypoints ("QGC WPL 110"), with its home.
    std::string waypoints() const;

  private:
    using Place = std::array<double, 3>;  ///< latitude, longitude, altitude above the sea
    struct Item {
        double frame = 0.0;
        double command = 0.0;
        std::array<double, 7> parameters = {};  ///< the last three: latitude, longitude, altitude
        bool has_place() const { return parameters[4] != 0.0 || parameters[5] != 0.0; }
        Place place() const { return {parameters[4], parameters[5], parameters[6]}; }
        bool operator==(const Item&) const = default;
    };

    static bool is_elsewhere(const Place& home, const Place& than);
    bool is_to_us(const std::map<std::string, double, std::less<>>& packet) const;
    void forget_items();
    bool is_reading_of_others(double now_s);
    const std::optional<Place>& home() const { return stated_home_ ? stated_home_ : parked_; }
    bool has_other_home() const;
    bool is_whole() const { return count_ && items_.size() == *count_ && *count_ > 0; }

    double own_system_;
    double own_component_;
    telemetry::MavlinkSender sender_;
    double system_ = 0.0;  ///< of the aircraft; 0: not heard yet
    bool is_ardupilot_ = false;
    bool is_disarmed_ = false;
    std::optional<Place> stated_home_;  ///< by the aircraft or its mission, whichever came last
    std::optional<Place> parked_;       ///< where it last was disarmed
    std::optional<std::size_t> count_;
    std::map<std::size_t, Item> items_;
    std::map<std::size_t, Item> whole_;  ///< the last whole mission
    std::optional<Place> whole_home_;    ///< its home
    bool is_outdated_ = false;
    bool is_answer_ = false;                 ///< the count, to a request of ours
    std::optional<std::size_t> asked_;       ///< the item
    int asked_times_ = 0;                    ///< in a row
    std::optional<std::size_t> seen_items_;  ///< of those that others read
    double asked_s_ = -1.0;
};

}  // namespace flightwatt::live

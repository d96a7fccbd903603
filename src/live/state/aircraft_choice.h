#pragma once

#include "flight/flight_series.h"
#include "live/state/telemetry_store.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace flightwatt::live {

/// Which of the aircraft on a bus is watched: the one that is named, else the first that is seen to fly; before one
/// does, the one that sends most. Once it flew it stays, and of the others only the messages are counted.
class AircraftSelector {
  public:
    static constexpr std::size_t max_named = 32;  ///< senders that are counted one by one

    explicit AircraftSelector(std::optional<std::string> named) : named_(std::move(named)) {}

    /// Counts a message by its sender.
    void count(std::string_view text);
    /// The series of the aircraft that is watched; an empty one while none sends telemetry. Of several the first that
    /// flies is chosen for good.
    flight::FlightSeries choose(TelemetryStore& store);
    /// The aircraft that is watched has flown: it is chosen for good.
    void keep(TelemetryStore& store);
    /// How many messages the other senders have sent.
    std::map<std::string, std::size_t> others() const;

  private:
    std::optional<std::string> named_;
    std::string chosen_;
    bool is_locked_ = false;
    std::map<std::string, std::size_t, std::less<>> messages_;
};

}  // namespace flightwatt::live

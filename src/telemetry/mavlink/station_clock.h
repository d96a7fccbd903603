#pragma once

#include <cstddef>
#include <vector>

namespace flightwatt::telemetry {

/// A message that states the autopilot's time since its boot, in the order of the recording.
struct BootTime {
    std::size_t place = 0;    ///< in the recording
    double received_s = 0.0;  ///< by the clock of the computer that recorded
    double boot_s = 0.0;      ///< by the autopilot's
};

/// A step of the clock of the computer that recorded, as where it is set by a network or a receiver.
struct ClockStep {
    BootTime before;      ///< the last message before it
    BootTime behind;      ///< the first one behind it
    double step_s = 0.0;  ///< by how much it is set forward

    /// Returns whether a message is behind the step: between the two that show it, if its time is nearer to the
    /// latter's.
    bool has_passed(std::size_t place, double received_s) const;
};

/// Finds the steps of two seconds and more, in their order: from one message to the next, of one boot and at most a
/// minute later by the autopilot's clock, all later messages come by so much later or earlier. Messages that a link
/// kept back, late ones, and those of two vehicles or links in turn are no steps.
std::vector<ClockStep> find_clock_steps(const std::vector<BootTime>& times);

/// Two messages of one number of a system that state different vehicles: other kinds, or other boards.
struct VehicleChange {
    std::size_t before = 0;  ///< the place of the former
    std::size_t behind = 0;
};

/// Finds the places at which a recording continues with another vehicle, rising: of the changes those in which the
/// autopilot's clock changes too, as that of a VTOL that states its flight as a kind does not. None if there are so
/// many that two vehicles are recorded at once.
std::vector<std::size_t> find_other_vehicles(const std::vector<VehicleChange>& changes,
                                             const std::vector<BootTime>& times);

}  // namespace flightwatt::telemetry

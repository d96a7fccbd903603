#pragma once

#include "base/statistics.h"
#include "battery/battery.h"
#include "mechanical/mechanical_model.h"
#include "mission/mission.h"
#include "path/path.h"

#include <optional>
#include <string>
#include <vector>

/// Answers of a model and a pack to what a pilot asks.
///
/// Failsafe card. Problem: an autopilot acts when its count of charge, or the voltage, is below a value. Which values
/// bring the aircraft home in time, and how likely are they too late?
/// State: flights of mission::draw_flights, with a fixed seed. Each has its powers, durations, wind and pack, hence the
/// charge that it needs to fly home, land and keep the reserve. A threshold is the quantile of these at the wanted
/// probability, rounded up, counted from the capacity that the autopilot has: the count of a weak pack is wrong in a
/// draw, as it is in the air. The voltages under cruise current at these charges make the voltages that suffice alone.
/// Low action: fly home from the farthest place, land, keep the reserve. Critical action: land at once and keep half of
/// the reserve, so that a return which takes more than expected is landed before the other half is used.
/// Limits: a pack full at power-on, a calibrated current sensor, a level and straight way home (no climb to a return
/// height), the stated wind all the way, packs and aircraft as in the flights; gusts, cold and age are not added.
namespace flightwatt::answer {

/// Reserve [%] of a request that states none.
inline constexpr double assumed_reserve_percent = 20.0;

/// Standard deviation of power between flights [%] that the values assume where the model has none (a single flight). Also
/// the duration of the landing then differs by itself (1 sd): less knowledge must not give a lower threshold.
inline constexpr double assumed_level_sd_percent = 25.0;

/// Airspeed of the way home of a rotorcraft whose flights were slower [m/s]: the low end of what autopilots return with.
inline constexpr double least_return_m_per_s = 5.0;

/// The part of the reserve that the critical action keeps.
inline constexpr double critical_reserve_part = 0.5;

/// A voltage threshold is too early if it acts this much [points of charge] before the count would.
inline constexpr double early_points = 10.0;

/// An aircraft, its pack and the way home.
struct FailsafeRequest {
    mechanical::MechanicalModel model;  ///< as of mechanical::read_predicting_model()
    battery::Battery battery;
    std::optional<mission::PayloadBasis> payload = {};  ///< of the model's powers
    double compute_w = 0.0;                             ///< mean power of the computer, in addition to the model's
    std::optional<double> reserve_percent = {};
    std::optional<double> home_distance_m = {};   ///< farthest place from which it is to return
    std::optional<double> flown_distance_m = {};  ///< without it: the largest from the start in the flights' tracks
    path::Wind wind = {};                         ///< with its standard deviations, if known
    bool wind_is_of_mission = false;              ///< and not stated for the way home
    std::optional<double> home_course_deg = {};   ///< absent: the wind blows from home, the worst
    std::optional<double> airspeed_m_per_s = {};  ///< default: the mean cruise of a physical model
    double probability = 0.95;                    ///< with which an action is early enough
};

/// What a part of the card rests on.
enum class Ground { measured, physics, assumption };

std::string to_string(Ground ground);

/// A part of the card, such as "wind: 6 m/s from ahead, as stated".
struct GroundedPart {
    Ground ground = Ground::assumption;
    std::string text;
};

/// A voltage of the pack under cruise current, rounded up to 0.01 V. Chances are unknown where they are absent.
struct VoltageThreshold {
    double voltage_v = 0.0;
    std::optional<double> too_late;   ///< chance that the charge needed is already used
    std::optional<double> too_early;  ///< chance that it acts early_points or more before the count
};

/// One action of an autopilot.
struct FailsafeAction {
    int soc_percent = 0;                      ///< of the capacity, by the count of charge; rounded up
    int used_mah = 0;                         ///< since the full pack
    int remaining_mah = 0;                    ///< capacity less used_mah; rounded up
    double current_a = 0.0;                   ///< in cruise, at this charge
    std::optional<double> too_late;           ///< chance of this count; absent: unknown
    std::optional<Interval> too_late_95;      ///< of that chance in new flights
    std::optional<VoltageThreshold> voltage;  ///< at this charge; absent for a battery of constant voltage
    std::optional<VoltageThreshold>
        voltage_alone;  ///< that is early enough with the wanted probability, without a count
};

/// Values for an autopilot.
struct FailsafeCard {
    double capacity_mah = 0.0;
    double reserve_percent = 0.0;
    double probability = 0.0;
    bool chances_known = true;              ///< false: nothing shows how the power of flights differs
    std::optional<double> home_distance_m;  ///< the farthest place; absent: unknown
    std::optional<double> home_duration_s;  ///< as planned
    std::optional<FailsafeAction> low;      ///< return
    std::string low_missing;                ///< the reason why it is absent
    FailsafeAction critical;                ///< land at once
    std::optional<double> lands_short;      ///< chance that the critical action ends the return; absent: unknown
    std::optional<double> empty_voltage_v;  ///< of the empty pack under cruise current; absent for a constant voltage
    std::vector<GroundedPart> grounds;
    std::string monitors = {};  ///< see battery::describe_monitors
};

/// Computes the card. Without a distance, an airspeed or a wind in which the way home can be flown, `low` is absent and
/// `low_missing` has the reason. Throws UsageError for a probability outside 0.5 to below 1 or a reserve outside 0 to
/// below 100 %, NoResultError if the full pack does not suffice to land.
FailsafeCard make_failsafe_card(const FailsafeRequest& request);

/// Lines for a pilot: both actions with charge, voltage and chance; what they rest on.
std::string describe(const FailsafeCard& card);

}  // namespace flightwatt::answer

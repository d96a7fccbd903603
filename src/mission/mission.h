#pragma once

#include "battery/battery.h"
#include "compute/compute_model.h"
#include "mechanical/mechanical_model.h"
#include "mission/adaptive_policy.h"
#include "mission/plan_settings.h"
#include "mission/schedule.h"
#include "mission/uncertainty.h"
#include "mission/utility.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::mission {

/// A flight, the software that runs in it, and the battery that feeds both.
struct Mission {
    std::string file;
    std::string name;
    std::optional<mechanical::MechanicalModel> mechanical;  ///< none: computing alone
    mechanical::PhaseClock phase_clock = mechanical::PhaseClock::stretched;
    /// The cruise's mean power under the stated conditions; `mechanical` has this level then.
    std::optional<mechanical::ConstantPower> cruise_level = {};
    flight::PerPhase<double> duration_s;  ///< as flown; 0 leaves a phase out
    battery::Battery battery;
    compute::ComputeModel compute;
    std::vector<std::optional<Utility>> utilities;  ///< one a component (or none at all)
    /// In order, covers each instant of each phase exactly once; of a mission that is yet to be planned, only
    /// what is fixed beforehand.
    std::vector<Stretch> schedule;
    double initial_soc_percent = 100.0;
    double cutoff_voltage_v = 0.0;           ///< the battery is cut off below it; 0: never
    double reserve_soc_percent = 0.0;        ///< what should be left at the end
    std::optional<PlanSettings> plan;        ///< the schedule is yet to be planned
    std::optional<AdaptivePolicy> adaptive;  ///< and that in flight, again and again
    Uncertainty uncertainty;
};

/// What else than the file decides how a mission is read.
struct MissionReading {
    bool may_lack_schedule = false;  ///< accept a mission that is yet to be planned
    std::optional<double> cruise_s;  ///< fly the cruise this long, whatever the file says
};

/// Reads a mission file:
///
///     name = "phased"                         # default: the file's name
///     mechanical = "../opterra.toml"          # or "none": then every phase needs its duration
///     duration_s = { cruise = 900 }           # default: the mechanical model's
///     phase_clock = "stretch"                 # a phase flown longer or shorter stretches its curve;
///                                             # or "absolute": it runs on in its own seconds
///     conditions = { airspeed_m_per_s = 14 }  # what the model's cruise level follows (its level_law),
///     within
///                                             # what its flights showed; default: their average
///     battery = "../pack.toml"                # or { voltage_v = 11.1, resistance_ohm = 0.05, ... }
///     initial_soc_percent = 100
///     capacity_ah = 3.0                       # default: the battery's
///     cutoff_voltage_v = 9.9                  # default: none
///     reserve_soc_percent = 20                # default: 0
///     [components.detection]
///     profile = "../detection.csv"            # any format of compute/profile_reader.h
///     parameters = ["fps"]                    # names for a profile that has none; or `columns`
///     utility = { parameter = "fps" }         # of a component: what its quality is worth, see
///                                             # mission/utility_toml.h
///     [plan]                                  # see mission/plan_settings_toml.h
///     [policy]                                # see mission/adaptive_policy_toml.h
///     [uncertainty]                           # see mission/uncertainty_toml.h
///     [[schedule]]                            # see mission/schedule_toml.h
///
/// A mission with [plan], or with components and no [[schedule]], is yet to be planned: its [[schedule]] is
/// what is fixed. It is refused unless `reading` accepts it, or its policy plans in flight. Paths are
/// relative to the mission file. Throws InputError, placed in the file that is wrong, for a missing file, a
/// key missing, unknown or out of range, and whatever schedules and models refuse.
Mission read_mission(const std::filesystem::path& path, const MissionReading& reading = {});

/// The same from text; `path` names it and is where relative paths start.
Mission parse_mission(std::string_view text, const std::filesystem::path& path,
                      const MissionReading& reading = {});

}  // namespace flightwatt::mission

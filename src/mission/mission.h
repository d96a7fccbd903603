#pragma once

#include "battery/battery.h"
#include "compute/compute_model.h"
#include "mechanical/mechanical_model.h"
#include "mission/schedule.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt {

/// A flight, the software that runs in it, and the battery that feeds both.
struct Mission {
    std::string file;
    std::string name;
    std::optional<MechanicalModel> mechanical;  ///< none: computing alone
    PhaseClock phase_clock = PhaseClock::stretched;
    PerPhase<double> duration_s;  ///< as flown; 0 leaves a phase out
    Battery battery;
    ComputeModel compute;
    std::vector<Stretch> schedule;  ///< in order, covers each instant of each phase exactly once
    double initial_soc_percent = 100.0;
    double cutoff_voltage_v = 0.0;     ///< the battery is cut off below it; 0: never
    double reserve_soc_percent = 0.0;  ///< what should be left at the end
};

/// Reads a mission file:
///
///     name = "phased"                         # default: the file's name
///     mechanical = "../opterra.toml"          # or "none": then every phase needs its duration
///     duration_s = { cruise = 900 }           # default: the mechanical model's
///     phase_clock = "stretch"                 # a phase flown longer or shorter stretches its curve;
///                                             # or "absolute": it runs on in its own seconds
///     battery = "../pack.toml"                # or { voltage_v = 11.1, resistance_ohm = 0.05, ... }
///     initial_soc_percent = 100
///     capacity_ah = 3.0                       # default: the battery's
///     cutoff_voltage_v = 9.9                  # default: none
///     reserve_soc_percent = 20                # default: 0
///     [components.detection]
///     profile = "../detection.csv"            # any format of compute/profile_reader.h
///     parameters = ["fps"]                    # names for a profile that has none; or `columns`
///     [[schedule]]                            # see mission/schedule_toml.h
///
/// Paths are relative to the mission file. Throws InputError, placed in the file that is wrong, for a missing
/// file, a key missing, unknown or out of range, and whatever schedules and models refuse.
Mission read_mission(const std::filesystem::path& path);

/// The same from text; `path` names it and is where relative paths start.
Mission parse_mission(std::string_view text, const std::filesystem::path& path);

}  // namespace flightwatt

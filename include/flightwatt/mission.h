#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Missions: the state of charge of a battery over a flight with its software on board.
///
/// A mission is a file (docs/missions.md), which names a model, a battery and the schedule of the software;
/// `flightwatt new-mission` writes one.
///
///     const auto result = flightwatt::simulate_mission("mission.toml", {.drawn_flights = 2000});
///     std::printf("%.1f %% left; below the reserve in %.1f %% of flights\n", result.final_soc_percent.value_or(0.0),
///                 100.0 * result.probability_below_reserve.value_or(0.0));
namespace flightwatt {

/// A moment of a simulated mission.
struct SocPoint {
    double time_s = 0.0;  ///< since the mission began
    double soc_percent = 0.0;
    double power_w = 0.0;    ///< demanded by aircraft and software
    double voltage_v = 0.0;  ///< at the load
};

struct MissionResult {
    std::string name;
    std::vector<SocPoint> curve;              ///< to the end, or to where the battery cannot deliver the power
    std::optional<double> final_soc_percent;  ///< none: the battery cannot deliver the power
    double energy_wh = 0.0;                   ///< demanded over the whole mission
    double duration_s = 0.0;
    bool keeps_reserve = false;  ///< it lands with the reserve that the mission states
    /// Share of drawn flights that land below the reserve, 0 to 1; none where none were drawn, or where nothing shows
    /// how flights differ.
    std::optional<double> probability_below_reserve;
    /// Why the result may be wrong whatever its probability: a movement of the plan that is not flown, a climb beyond
    /// what the model's flights flew.
    std::vector<std::string> uncertain;
};

struct MissionOptions {
    double step_s = 1.0;            ///< between points of the curve; jumps of the power have points of their own
    std::size_t drawn_flights = 0;  ///< flights to draw with the variability of model and battery; 0: none
};

/// Simulates a mission file; one with an adaptive policy is planned again in flight. Throws for a file that cannot be
/// read or has errors, a mission that is yet to be planned, or one with several packs.
MissionResult simulate_mission(const std::filesystem::path& file, const MissionOptions& options = {});

}  // namespace flightwatt

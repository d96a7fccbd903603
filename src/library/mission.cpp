#include "base/error.h"
#include "mission/mission_file.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"

#include <flightwatt/mission.h>

namespace flightwatt {

MissionResult simulate_mission(const std::filesystem::path& file, const MissionOptions& options) {
    const auto mission = mission::read_mission(file);
    if (setup_of(mission).packs) throw UsageError(file.string() + " has several packs: flightwatt simulate flies them");
    const auto prepared = mission::prepare_mission(mission);
    const auto flown = mission::simulate_prepared(prepared, {.output_s = options.step_s});
    const auto& summary = flown.simulation.summary;
    MissionResult result{summary.mission,       {}, summary.final_soc_percent, summary.energy_wh, summary.duration_s,
                         summary.keeps_reserve, {}, summary.uncertain};
    for (const auto& row : flown.simulation.curve.rows)
        result.curve.push_back({row.time_s, row.soc_percent, row.power_w, row.terminal_voltage_v});
    if (options.drawn_flights == 0) return result;
    const auto drawn = mission::sample_flights(prepared, {}, {.samples = options.drawn_flights});
    if (drawn.variability_is_known) result.probability_below_reserve = drawn.probability_below_reserve;
    return result;
}

}  // namespace flightwatt

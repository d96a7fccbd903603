#include "mission/simulation/segment_discharge.h"

#include "helpers/paper_missions.h"
#include "mission/simulation.h"

#include <gtest/gtest.h>

namespace flightwatt::mission {
namespace {

TEST(SegmentDischarge, AgreesWithTheSimulation) {
    for (const double resistance_ohm : {0.0, 0.01}) {
        auto mission = test::paper_mission("phased");
        mission.battery.resistance_ohm = resistance_ohm;
        mission.battery.capacity_ah = 4.0;
        battery::Discharge charge;
        charge.soc_percent = 100.0;
        for (const auto& segment : load_segments(mission, mission.schedule))
            charge = after_segment(mission.battery, mission.cutoff_voltage_v, segment, charge);
        EXPECT_NEAR(charge.soc_percent, *simulate(mission).summary.final_soc_percent, 1e-6);
    }
}

}  // namespace
}  // namespace flightwatt::mission

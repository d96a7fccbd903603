// A flight plan of Paparazzi: each of its blocks, all of them, and waypoints, flown in a wind.

#include "base/error.h"
#include "fuzz/flown_plan.h"
#include "fuzz/fuzz_target.h"
#include "path/plan_blocks.h"

#include <string>
#include <vector>

void flightwatt::fuzz::run(std::string_view bytes) {
    const path::AutopilotSettings settings{80.0, 13.0};
    std::vector<std::string> names;
    for (const auto& block : path::parse_plan(bytes, "fuzz.xml", settings)) names.push_back(block.name);
    const auto attempt = [](const auto& entries) {
        try {
            fly(entries());
        } catch (const InputError&) {
            // The others may be flown.
        }
    };
    for (const auto& name : names)
        attempt([&] { return path::parse_plan_blocks(bytes, "fuzz.xml", {name}, settings); });
    attempt([&] { return path::parse_plan_blocks(bytes, "fuzz.xml", names, settings); });
    attempt([&] { return path::PlanEntries{path::parse_flight_plan(bytes, "fuzz.xml", {"1", "2"})}; });
}

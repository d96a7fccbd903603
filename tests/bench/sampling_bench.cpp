// Flights sampled by a single thread: of both battery kinds, beside the same flights one at a time.

#include "log_passes.h"
#include "mission/mission_file.h"
#include "mission/sampling/flight_lanes.h"

#include <cstddef>
#include <filesystem>
#include <variant>

#include <benchmark/benchmark.h>

namespace {

using namespace flightwatt;
using namespace flightwatt::mission;

struct Sampled {
    explicit Sampled(const char* path)
        : mission(std::get<Mission>(read_mission(std::filesystem::path(FLIGHTWATT_SOURCE_DIR) / path))),
          spreads(find_spreads(mission)),
          setup(without_evidence(mission)),
          lanes(setup, spreads, mission.schedule) {}

    Mission mission;
    FlightSpreads spreads;
    MissionSetup setup;
    FlightLanes lanes;
};

void side_by_side(benchmark::State& state, const char* path) {
    constexpr std::size_t at_once = 256;
    const Sampled sampled(path);
    std::vector<std::vector<double>> normals(at_once);
    std::vector<Landing> landings(at_once);
    std::size_t flights = 0;
    for (auto _ : state) {
        for (auto& numbers : normals) numbers = draw_normals(count_normals(sampled.setup), 1, flights++);
        sampled.lanes.fly(normals, landings);
        benchmark::DoNotOptimize(landings.data());
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(flights));
}

void one_at_a_time(benchmark::State& state, const char* path) {
    const Sampled sampled(path);
    std::size_t flights = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(
            sampled.lanes.fly_alone(draw_normals(count_normals(sampled.setup), 1, flights++)).left_percent);
    state.SetItemsProcessed(static_cast<std::int64_t>(flights));
}

BENCHMARK_CAPTURE(side_by_side, thevenin, "missions/synthetic/thevenin-pack.toml");
BENCHMARK_CAPTURE(one_at_a_time, thevenin, "missions/synthetic/thevenin-pack.toml");
BENCHMARK_CAPTURE(side_by_side, paper, "missions/paper/phased.toml");
BENCHMARK_CAPTURE(one_at_a_time, paper, "missions/paper/phased.toml");

}  // namespace

BENCHMARK_MAIN();

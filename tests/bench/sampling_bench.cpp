// Flights sampled by a single thread: of both battery kinds, beside the same flights one at a time, and how far they
// are off Runge-Kutta.

#include "log_passes.h"
#include "mission/mission_file.h"
#include "mission/sampling/flight_lanes.h"
#include "mission/simulation.h"

#include <algorithm>
#include <cmath>
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
          spreads(collect_uncertainty(mission.setup)),
          lanes(mission.setup, spreads, mission.schedule) {}

    Mission mission;
    FlightUncertainty spreads;
    SimdFlightSimulator lanes;
};

void side_by_side(benchmark::State& state, const char* path) {
    constexpr std::size_t at_once = 256;
    const Sampled sampled(path);
    std::vector<std::vector<double>> normals(at_once);
    std::vector<FlightOutcome> landings(at_once);
    std::size_t flights = 0;
    for (auto _ : state) {
        for (auto& numbers : normals) numbers = draw_normals(count_normals(sampled.mission.setup), 1, flights++);
        sampled.lanes.simulate(normals, landings);
        benchmark::DoNotOptimize(landings.data());
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(flights));
}

void one_at_a_time(benchmark::State& state, const char* path) {
    const Sampled sampled(path);
    std::size_t flights = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(
            sampled.lanes.simulate_scalar(draw_normals(count_normals(sampled.mission.setup), 1, flights++))
                .remaining_percent);
    state.SetItemsProcessed(static_cast<std::int64_t>(flights));
}

/// Over flights that are not empty before they land: the reference stops there.
void off_runge_kutta(benchmark::State& state, const char* path) {
    const Sampled sampled(path);
    std::vector<std::vector<double>> normals;
    for (std::size_t i = 0; i < 100; ++i) normals.push_back(draw_normals(count_normals(sampled.mission.setup), 1, i));
    std::vector<FlightOutcome> landings(normals.size());
    for (auto _ : state) sampled.lanes.simulate(normals, landings);
    double worst_percent = 0.0;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (landings[i].battery_failure) continue;
        const auto flight = apply_draw(sampled.mission.setup, sampled.spreads, normals[i]);
        const auto schedule =
            rescale_to_flown_durations(sampled.mission.schedule, sampled.mission.setup.duration_s, flight.duration_s);
        const auto reference = simulate(flight, schedule, {60.0, 0.25}).summary.final_soc_percent;
        worst_percent = std::max(worst_percent, std::abs(landings[i].final_soc_percent - reference.value()));
        ++compared;
    }
    if (compared == 0) state.SkipWithError("no flight lands");
    state.counters["compared"] = static_cast<double>(compared);
    state.counters["worst_difference_percent"] = worst_percent;
}

BENCHMARK_CAPTURE(side_by_side, thevenin, "missions/synthetic/thevenin-pack.toml");
BENCHMARK_CAPTURE(one_at_a_time, thevenin, "missions/synthetic/thevenin-pack.toml");
BENCHMARK_CAPTURE(side_by_side, paper, "missions/paper/phased.toml");
BENCHMARK_CAPTURE(one_at_a_time, paper, "missions/paper/phased.toml");
BENCHMARK_CAPTURE(off_runge_kutta, thevenin, "missions/synthetic/thevenin-pack.toml")->Iterations(1);
BENCHMARK_CAPTURE(off_runge_kutta, paper, "missions/paper/phased.toml")->Iterations(1);

}  // namespace

BENCHMARK_MAIN();

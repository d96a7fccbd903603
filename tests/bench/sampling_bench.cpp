// Flights sampled by a single thread: of both battery kinds, beside the same flights one at a time, and how far they
// are off Runge-Kutta.

#include "log_passes.h"
#include "mission/mission_file.h"
#include "mission/sampling/flight_draws.h"
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
          spreads(collect_uncertainty(mission.setup)) {}

    void draw(std::size_t number, DrawnFlight& flight) const {
        apply_draw_to(mission.setup, spreads, draw_normals(count_normals(mission.setup), 1, number), flight.setup);
        flight.segments = load_segments(
            flight.setup,
            rescale_to_flown_durations(mission.schedule, mission.setup.duration_s, flight.setup.duration_s));
    }

    Mission mission;
    FlightUncertainty spreads;
};

void side_by_side(benchmark::State& state, const char* path) {
    const Sampled sampled(path);
    const FlightDraw draw = [&](std::size_t number, DrawnFlight& flight) { sampled.draw(number, flight); };
    std::vector<FlightOutcome> landings(256);
    std::size_t flights = 0;
    for (auto _ : state) {
        fly_side_by_side(sampled.mission.setup, draw, flights, landings);
        flights += landings.size();
        benchmark::DoNotOptimize(landings.data());
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(flights));
}

void one_at_a_time(benchmark::State& state, const char* path) {
    const Sampled sampled(path);
    DrawnFlight flight{sampled.mission.setup, {}};
    std::size_t flights = 0;
    for (auto _ : state) {
        sampled.draw(flights++, flight);
        battery::Discharge charge{{flight.setup.initial_soc_percent}};
        for (const auto& segment : flight.segments)
            charge = advance_segment(flight.setup.battery, flight.setup.cutoff_voltage_v, segment, charge);
        benchmark::DoNotOptimize(charge.soc_percent);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(flights));
}

/// Over flights that are not empty before they land: the reference stops there.
void off_runge_kutta(benchmark::State& state, const char* path) {
    const Sampled sampled(path);
    const FlightDraw draw = [&](std::size_t number, DrawnFlight& flight) { sampled.draw(number, flight); };
    std::vector<FlightOutcome> landings(100);
    for (auto _ : state) fly_side_by_side(sampled.mission.setup, draw, 0, landings);
    double worst_percent = 0.0;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < landings.size(); ++i) {
        if (landings[i].battery_failure) continue;
        const auto flight = draw_flight(sampled.mission.setup, sampled.spreads, 1, i);
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

// Flights sampled by a single thread: of both battery kinds, and how far they are off Runge-Kutta.

#include "helpers/drawn_mission.h"
#include "log_passes.h"
#include "mission/mission_file.h"
#include "mission/sampling/flight_draws.h"
#include "mission/sampling/landing_distribution.h"
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
        apply_draw(mission.setup, spreads, draw_normals(count_normals(mission.setup), 1, number), flight.setup);
        flight.segments = load_segments(
            flight.setup,
            rescale_to_flown_durations(mission.schedule, mission.setup.duration_s, flight.setup.duration_s));
    }

    Mission mission;
    FlightUncertainty spreads;
};

void drawn_flights(benchmark::State& state, const char* path) {
    const Sampled sampled(path);
    DrawnFlight flight{sampled.mission.setup, {}};
    std::size_t flights = 0;
    for (auto _ : state) {
        sampled.draw(flights++, flight);
        benchmark::DoNotOptimize(simulate_flight(flight).final_soc_percent);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(flights));
}

/// Over flights that are not empty before they land: the reference stops there.
void off_runge_kutta(benchmark::State& state, const char* path) {
    const Sampled sampled(path);
    const FlightDraw draw = [&](std::size_t number, DrawnFlight& flight) { sampled.draw(number, flight); };
    std::vector<FlightOutcome> landings;
    for (auto _ : state) landings = fly_drawn(sampled.mission.setup, draw, 0, 100);
    double worst_percent = 0.0;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < landings.size(); ++i) {
        if (landings[i].battery_failure) continue;
        const auto flight = apply_draw(sampled.mission.setup, sampled.spreads,
                                       draw_normals(count_normals(sampled.mission.setup), 1, i));
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

BENCHMARK_CAPTURE(drawn_flights, thevenin, "missions/synthetic/thevenin-pack.toml");
BENCHMARK_CAPTURE(drawn_flights, paper, "missions/paper/phased.toml");
BENCHMARK_CAPTURE(off_runge_kutta, thevenin, "missions/synthetic/thevenin-pack.toml")->Iterations(1);
BENCHMARK_CAPTURE(off_runge_kutta, paper, "missions/paper/phased.toml")->Iterations(1);

}  // namespace

BENCHMARK_MAIN();

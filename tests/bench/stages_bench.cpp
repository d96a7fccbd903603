#include "flight/load_flight.h"
#include "flight/segment.h"
#include "helpers/selected_tracks.h"
#include "log_passes.h"
#include "mechanical/fit/phase_fit.h"
#include "mechanical/mechanical_model.h"
#include "mission/mission_file.h"
#include "mission/simulation.h"

#include <filesystem>
#include <random>

#include <benchmark/benchmark.h>

/// What happens to a flight after it is read: segmentation, fit of a phase, simulation of a mission.
namespace flightwatt::bench {
namespace {

std::filesystem::path source_dir() { return FLIGHTWATT_SOURCE_DIR; }

void segmentation_of_a_flight(benchmark::State& state) {
    const auto series = flight::read_flight(source_dir() / "logs" / "opterra_synthetic_01.data");
    for (auto _ : state) benchmark::DoNotOptimize(flight::segment(select_tracks(series)));
    state.counters["samples"] = static_cast<double>(flight::power_track(series).time_s.size());
}
BENCHMARK(segmentation_of_a_flight)->Unit(benchmark::kMicrosecond);

/// Samples of the published cruise with noise, evenly over the phase.
mechanical::PhaseSamples cruise_samples(std::size_t count) {
    const auto model = mechanical::read_mechanical_model(source_dir() / "fits" / "mechanical" / "opterra-table1.toml");
    const auto& cruise = model.phases[flight::Phase::cruise];
    std::mt19937 random(1);
    std::normal_distribution<double> noise_w(0.0, 1.0);
    mechanical::PhaseSamples samples{"made up", cruise.duration_s, {}, {}};
    for (std::size_t i = 0; i < count; ++i) {
        samples.tau.push_back((static_cast<double>(i) + 0.5) / static_cast<double>(count));
        samples.power_w.push_back(
            flightwatt::mechanical::power_w(cruise.fourier, samples.tau.back() * cruise.duration_s) + noise_w(random));
    }
    return samples;
}

void fit_of_a_phase(benchmark::State& state) {
    const std::vector<mechanical::PhaseSamples> flights{cruise_samples(static_cast<std::size_t>(state.range(0)))};
    for (auto _ : state) benchmark::DoNotOptimize(fit_phase(flight::Phase::cruise, flights));
}
BENCHMARK(fit_of_a_phase)->ArgName("samples")->Arg(6000)->Unit(benchmark::kMillisecond);

/// The paper's phased mission, 688 s, with the default Runge-Kutta step.
void simulation_of_a_mission(benchmark::State& state) {
    const auto mission =
        std::get<mission::Mission>(mission::read_mission(source_dir() / "missions" / "paper" / "phased.toml"));
    for (auto _ : state) benchmark::DoNotOptimize(mission::simulate(mission));
}
BENCHMARK(simulation_of_a_mission)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace flightwatt::bench

BENCHMARK_MAIN();

// How many flights to come keep a cut-off that the longest cruise promises, with packs that are known by flights that did
// not empty them. usage: cutoff_promises_bench [MODELS [SEED]]: of each row, 100 if not stated, from seed 70001 on

#include "base/number.h"
#include "base/statistics.h"
#include "helpers/battery_coverage.h"
#include "mission/feasibility_limits.h"
#include "mission/sampling/landing_distribution.h"
#include "mission/simulation/load_segments.h"

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

constexpr double level_sd_percent = 2.0;
constexpr double reserve_percent = 5.0;
constexpr std::size_t new_flights = 50;
constexpr flight::PerPhase<double> level_w{{80.0, 27.0, 5.0}};

/// Charts in proportion to what identification expects beforehand.
test::PackCurve curve_of(std::uint64_t seed) {
    const auto place = seed % 20;
    if (place < 8) return test::PackCurve::known;
    if (place < 15) return test::PackCurve::polymer;
    return place < 18 ? test::PackCurve::nmc : test::PackCurve::high;
}

mission::Mission mission_of(const battery::Battery& pack, double cell_cutoff_v, double cruise_s) {
    mission::Mission mission;
    auto& setup = mission.setup;
    setup.name = "cut-off";
    setup.battery = pack;
    setup.cutoff_voltage_v = 3.0 * cell_cutoff_v;
    setup.reserve_soc_percent = reserve_percent;
    setup.duration_s = {{25.0, cruise_s, 60.0}};
    setup.duration_is_stated = {{true, true, true}};
    auto& model = setup.mechanical.emplace();
    for (const auto phase : flight::all_phases) {
        model.phases[phase].fourier = {1.0, level_w[phase], {}, {}};
        model.phases[phase].duration_s = setup.duration_s[phase];
        setup.uncertainty.level_sd_percent[phase] = level_sd_percent;
        mission.schedule.push_back({phase, 0.0, setup.duration_s[phase], {}});
    }
    return mission;
}

struct Row {
    test::PackCurve curve = test::PackCurve::known;
    std::vector<double> kept;
    std::vector<double> left_percent;
    std::vector<double> cruise_part;  ///< of what a known pack would allow
};

void try_model(std::size_t flights, double cell_cutoff_v, std::uint64_t seed, Row& row) {
    const auto drawn = test::drawn_flights({curve_of(seed), flights, true, true, 0.1, 0.0}, seed);
    battery::IdentificationOptions options;
    options.cells = 3;
    options.capacity_ah = drawn.pack.capacity_ah;
    const auto found = identify_battery(drawn.records, options);
    const auto promised = [&](const battery::Battery& pack, std::optional<double> probability) {
        return mission::longest_cruise([&](double cruise_s) { return mission_of(pack, cell_cutoff_v, cruise_s); },
                                       probability)
            .value;
    };
    const double cruise_s = promised(found.battery, 0.95);
    row.cruise_part.push_back(cruise_s / promised(drawn.pack, std::nullopt));
    std::mt19937_64 random(seed + 999);
    std::normal_distribution<double> normal;
    double kept = 0.0;
    double left_percent = 0.0;
    for (std::size_t i = 0; i < new_flights; ++i) {
        auto flown = mission_of(drawn.pack, cell_cutoff_v, cruise_s);
        flown.setup.battery.resistance_ohm *= std::max(0.3, 1.0 + 0.1 * normal(random));
        for (const auto phase : flight::all_phases)
            flown.setup.mechanical->phases[phase].fourier.a0_w *= 1.0 + 0.01 * level_sd_percent * normal(random);
        const auto landing = mission::simulate_flight({flown.setup, load_segments(flown.setup, flown.schedule)});
        kept += landing.remaining_percent >= reserve_percent ? 1.0 : 0.0;
        left_percent += landing.final_soc_percent;
    }
    row.kept.push_back(kept / static_cast<double>(new_flights));
    row.left_percent.push_back(left_percent / static_cast<double>(new_flights));
}

void run(std::size_t models, std::uint64_t seed) {
    fmt::print("flights  cut-off [V/cell]  models  kept %  left %  of the cruise of a known pack %  failed\n");
    for (const std::size_t flights : {2U, 4U, 8U}) {
        for (const double cutoff_v : {3.2, 3.5}) {
            Row row;
            std::size_t failed = 0;
            for (std::size_t i = 0; i < models; ++i) {
                try {
                    try_model(flights, cutoff_v, seed + i, row);
                } catch (const std::runtime_error& error) {
                    ++failed;
                    fmt::print(stderr, "{}\n", error.what());
                }
            }
            const auto n = static_cast<double>(row.kept.size());
            fmt::print("{:>7}  {:>16.2f}  {:>6}  {:>5.1f} +- {:.1f}  {:>6.1f}  {:>6.1f}  {}\n", flights, cutoff_v,
                       row.kept.size(), 100.0 * mean(row.kept), 100.0 * sample_sd(row.kept) / std::sqrt(n),
                       mean(row.left_percent), 100.0 * mean(row.cruise_part), failed);
            std::fflush(stdout);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto models = argc > 1 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(100);
    const auto seed = argc > 2 ? parse_unsigned(argv[2]) : std::optional<std::uint64_t>(70001);
    if (argc > 3 || !models || !seed || *models < 2) return 2;
    try {
        run(*models, *seed);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "cutoff_promises_bench: {}\n", error.what());
        return 1;
    }
}

// How often the intervals of capacities and initial charges hold the truth, over synthetic packs.
// usage: battery_coverage_bench [PACKS [SEED]]: of each row, 100 if not said, from seed 1001 on

#include "base/number.h"
#include "base/statistics.h"
#include "base/units.h"
#include "helpers/battery_coverage.h"

#include <cstdio>
#include <exception>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

double median_or_zero(const std::vector<double>& values) { return values.empty() ? 0.0 : median(values); }

void print_row(const test::BatteryCase& made, std::uint64_t seed, std::size_t packs) {
    const auto coverage = test::battery_coverage(made, seed, packs);
    const auto of = [](std::size_t part, std::size_t whole) {
        return units::percent_of(static_cast<double>(part), static_cast<double>(std::max<std::size_t>(1, whole)));
    };
    const auto capacities = coverage.capacity_width_percent.size();
    const auto capacity = capacities == 0 ? "-" : fmt::format("{:.0f}", of(coverage.capacities_held, capacities));
    const auto width = capacities == 0 ? "-" : fmt::format("{:.0f}", median(coverage.capacity_width_percent));
    fmt::print("{:<8}  {:>7}  {:<5}  {:<5}  {:>6.2f}  {:>5.2f}  {:>10}  {:>8}  {:>9.0f}  {:>8.1f}  {:>8}\n",
               to_string(made.curve), made.flights, made.begins_full ? "yes" : "no", made.capacity_given ? "yes" : "no",
               made.resistance_spread, made.slow_resistance_ohm, capacity, width,
               of(coverage.initial_charges_held, coverage.flights), median_or_zero(coverage.initial_width_percent),
               coverage.without_answer);
    std::fflush(stdout);
}

void run(std::size_t packs, std::uint64_t seed) {
    fmt::print(
        "{} packs a row, seeds from {}. Flights begin at 40 to 100 %; of a pack that begins full, the first one does.\n"
        "Widths: medians of 95 % intervals, in percent of the capacity.\n\n"
        "curve     flights  full   given  spread   slow  capacity %  width %  initial %   width %  no answer\n",
        packs, seed);
    for (const auto curve : {test::PackCurve::known, test::PackCurve::polymer, test::PackCurve::straight}) {
        for (const std::size_t flights : {1U, 2U, 4U}) {
            for (const bool full : {true, false}) {
                print_row({curve, flights, full, false, 0.0, 0.0}, seed, packs);
                print_row({curve, flights, full, true, 0.0, 0.0}, seed, packs);
            }
        }
        print_row({curve, 3, false, false, 0.15, 0.0}, seed, packs);
        print_row({curve, 3, false, false, 0.0, 0.03}, seed, packs);
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const auto packs = argc > 1 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(100);
        const auto seed = argc > 2 ? parse_unsigned(argv[2]) : std::optional<std::uint64_t>(1001);
        if (argc > 3 || !packs || *packs == 0 || !seed) {
            fmt::print(stderr, "usage: battery_coverage_bench [PACKS [SEED]]\n");
            return 2;
        }
        run(*packs, *seed);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "battery_coverage_bench: {}\n", error.what());
        return 1;
    }
}

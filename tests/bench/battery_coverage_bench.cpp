// How often the intervals of capacities and initial charges cover the truth, over synthetic packs. Exit code 1 where a
// row covers less than the limits below, beyond three standard errors. usage: battery_coverage_bench [PACKS [SEED]]: of
// each row, 100 if not said, from seed 1001 on

#include "base/number.h"
#include "base/statistics.h"
#include "base/units.h"
#include "helpers/battery_coverage.h"
#include "helpers/binomial.h"

#include <cstdio>
#include <exception>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

double median_or_zero(const std::vector<double>& values) { return values.empty() ? 0.0 : median(values); }

/// 70 % of capacities is what is known of packs with a straight curve, many of whose flights begin full; other rows
/// have 90 % and more (docs/validation.md).
constexpr double least_share_of_capacities = 0.70;
constexpr double least_share_of_initial_charges = 0.90;

bool print_row(const test::BatteryCase& made, std::uint64_t seed, std::size_t packs) {
    const auto coverage = test::battery_coverage(made, seed, packs);
    const auto of = [](std::size_t part, std::size_t whole) {
        return units::percentage(static_cast<double>(part), static_cast<double>(std::max<std::size_t>(1, whole)));
    };
    const auto capacities = coverage.capacity_width_percent.size();
    const auto capacity = capacities == 0 ? "-" : fmt::format("{:.0f}", of(coverage.capacities_held, capacities));
    const auto width = capacities == 0 ? "-" : fmt::format("{:.0f}", median(coverage.capacity_width_percent));
    const auto error = capacities == 0 ? "-" : fmt::format("{:+.1f}", median(coverage.capacity_error_percent));
    fmt::print("{:<8}  {:>7}  {:<5}  {:<5}  {:>6.2f}  {:>5.2f}  {:>10}  {:>8}  {:>8}  {:>9.0f}  {:>8.1f}  {:>8}\n",
               to_string(made.curve), made.flights, made.begins_full ? "yes" : "no", made.capacity_given ? "yes" : "no",
               made.resistance_spread, made.slow_resistance_ohm, capacity, width, error,
               of(coverage.initial_charges_held, coverage.flights), median_or_zero(coverage.initial_width_percent),
               coverage.without_answer);
    std::fflush(stdout);
    const auto share = [](std::size_t part, std::size_t whole) {
        return whole == 0 ? 1.0 : static_cast<double>(part) / static_cast<double>(whole);
    };
    return test::is_at_least(share(coverage.capacities_held, capacities), least_share_of_capacities, packs) &&
           test::is_at_least(share(coverage.initial_charges_held, coverage.flights), least_share_of_initial_charges,
                             packs);
}

/// Whether all rows cover enough.
bool run(std::size_t packs, std::uint64_t seed) {
    fmt::print(
        "{} packs a row, seeds from {}. Flights begin at 40 to 100 %; of a pack that begins full, the first one does.\n"
        "Widths of 95 % intervals and errors: medians, in percent of the capacity.\n\n"
        "curve     flights  full   given  spread   slow  capacity %   width %   error %  initial %   width %  no answer\n",
        packs, seed);
    bool all_cover = true;
    for (const auto curve : {test::PackCurve::known, test::PackCurve::polymer, test::PackCurve::nmc,
                             test::PackCurve::high, test::PackCurve::straight}) {
        for (const std::size_t flights : {1U, 2U, 4U}) {
            for (const bool full : {true, false}) {
                all_cover = print_row({curve, flights, full, false, 0.0, 0.0}, seed, packs) && all_cover;
                all_cover = print_row({curve, flights, full, true, 0.0, 0.0}, seed, packs) && all_cover;
            }
        }
        all_cover = print_row({curve, 3, false, false, 0.15, 0.0}, seed, packs) && all_cover;
        all_cover = print_row({curve, 3, false, false, 0.0, 0.03}, seed, packs) && all_cover;
    }
    return all_cover;
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
        return run(*packs, *seed) ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "battery_coverage_bench: {}\n", error.what());
        return 1;
    }
}

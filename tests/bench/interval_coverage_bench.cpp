// How often 95 % intervals of a phase's curve and of its constant hold the truth, over many synthetic flights, and how
// far the curves of regularly sampled flights are off. These intervals are approximate: exit code 1 where noise that does
// not last (r = 0) leaves less than 90 % of a curve covered, beyond three standard errors.
// usage: interval_coverage_bench [FITS [PHASE]]: of each kind, 1000 if not said; of one phase alone

#include "base/number.h"
#include "base/units.h"
#include "helpers/binomial.h"
#include "helpers/interval_coverage.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <span>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

using test::binomial_error;

constexpr double min_share = 0.90;

/// Whether the curve's share is at least that where it must be. The points of one fit's curve are not independent: their part has the error
/// of so many fits at most.
bool print_row(flight::Phase phase, const test::CoverageCase& made, const test::Coverage& coverage) {
    const auto percent = [](double part) { return units::percentage(part, 1.0); };
    fmt::print(
        "| {} | {} | {:.2f} | {:.1f} | {:.1f} ± {:.1f} | {:.1f} ± {:.1f} "
        "| {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} |\n",
        to_string(phase), made.together, made.noise_w, made.autocorrelation, percent(coverage.covered),
        percent(binomial_error(coverage.covered, coverage.fits)), percent(coverage.a0_covered),
        percent(binomial_error(coverage.a0_covered, coverage.fits)), coverage.half_width_w, coverage.a0_half_width_w,
        coverage.curve_error_w, coverage.worst_curve_error_w, coverage.without_answer);
    std::fflush(stdout);
    return made.autocorrelation > 0.0 || test::is_at_least(coverage.covered, min_share, coverage.fits);
}

/// Seeds are fixed; those of the tests are others.
constexpr unsigned seed = 7;

/// Whether all rows cover enough.
bool run_coverage(std::size_t fits, std::span<const flight::Phase> phases) {
    bool all_cover = true;
    fmt::print("{} fits a row, seed {}; half widths and errors in W, medians of the fits.\n\n", fits, seed);
    fmt::print(
        "| phase | flights | noise W | r | curve, % | a0, % | half width | of a0 | error | worst | no answer |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (const auto phase : phases) {
        for (const std::size_t together : {1U, 4U}) {
            for (const double noise_w : {0.24, 1.0}) {
                for (const double autocorrelation : {0.0, 0.4, 0.7}) {
                    const test::CoverageCase made{.noise_w = noise_w,
                                                  .autocorrelation = autocorrelation,
                                                  .flights = fits * together,
                                                  .together = together};
                    all_cover = print_row(phase, made, test::coverage_of(phase, made, seed)) && all_cover;
                }
            }
        }
    }
    return all_cover;
}

/// Regularly sampled flights of 1 W noise: what their curves are off, at worst.
void run_regular(std::size_t fits, std::span<const flight::Phase> phases) {
    fmt::print("\n{} regular series a phase (1.1 s, 15 % lost, 1 W), seed 20000:\n\n", fits);
    fmt::print("| phase | worst curve, W RMS | no answer |\n|---|---:|---:|\n");
    for (const auto phase : phases) {
        const auto found = test::coverage_of_regular(phase, fits, 20000);
        fmt::print("| {} | {:.2f} | {} |\n", to_string(phase), found.worst_curve_error_w, found.without_answer);
        std::fflush(stdout);
    }
}

bool run(std::size_t fits, std::span<const flight::Phase> phases) {
    const bool all_cover = run_coverage(fits, phases);
    run_regular(fits, phases);
    return all_cover;
}

}  // namespace

int main(int argc, char** argv) {
    const auto fits = argc > 1 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(1000);
    const auto phase = argc > 2 ? flight::phase_from(argv[2]) : std::nullopt;
    if (argc > 3 || !fits || *fits == 0 || (argc > 2 && !phase)) {
        fmt::print(stderr, "usage: interval_coverage_bench [FITS [takeoff|cruise|landing]]\n");
        return 2;
    }
    try {
        const auto phases = phase ? std::span(&*phase, 1) : std::span<const flight::Phase>(flight::all_phases);
        return run(*fits, phases) ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "interval_coverage_bench: error: {}\n", error.what());
        return 1;
    }
}

// How often 95 % intervals of a phase's curve hold the truth, over many synthetic flights.
// usage: interval_coverage_bench [FITS]: of each kind, 1000 if not said

#include "base/number.h"
#include "base/units.h"
#include "helpers/interval_coverage.h"

#include <cmath>
#include <cstdio>
#include <exception>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

/// Standard error of a part of `count` independent trials.
double binomial_error(double part, std::size_t count) {
    return std::sqrt(part * (1.0 - part) / static_cast<double>(count));
}

/// The points of one fit's curve are not independent: their part has the error of so many fits at most.
void print_row(flight::Phase phase, const test::CoverageCase& made, const test::Coverage& coverage) {
    const auto percent = [](double part) { return units::percent_of(part, 1.0); };
    fmt::print(
        "{:<8} {:>7.2f}  {:>15.1f}  {:>14}  {:>5.1f} +- {:.1f}  {:>5.1f} +- {:.1f}  {:>11.2f}  {:>8}  "
        "{:>14}\n",
        to_string(phase), made.noise_w, made.autocorrelation, made.together, percent(coverage.covered),
        percent(binomial_error(coverage.covered, coverage.fits)), percent(coverage.a0_covered),
        percent(binomial_error(coverage.a0_covered, coverage.fits)), coverage.mean_error_ratio, coverage.at_bound,
        coverage.without_answer);
    std::fflush(stdout);
}

void run(std::size_t fits) {
    fmt::print(
        "{} fits a row, seed 7. Coverage of the curve: of 41 points of each; its error is that of "
        "independent\n"
        "fits, the most that it can be. Ratio: square error over square standard error, mean.\n\n",
        fits);
    fmt::print(
        "phase    noise W  autocorrelation  flights a fit  curve, %      a0, %         error ratio  at bound "
        " without answer\n");
    for (const auto phase : flight::all_phases) {
        for (const double noise_w : {0.05, 0.24, 1.0}) {
            for (const double autocorrelation : {0.0, 0.4, 0.7}) {
                for (const std::size_t together : {1U, 4U}) {
                    const test::CoverageCase made{.noise_w = noise_w,
                                                  .autocorrelation = autocorrelation,
                                                  .flights = fits * together,
                                                  .together = together};
                    print_row(phase, made, test::coverage_of(phase, made, 7));
                }
            }
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto fits = argc == 2 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(1000);
    if (argc > 2 || !fits || *fits == 0) {
        fmt::print(stderr, "usage: interval_coverage_bench [FITS]\n");
        return 2;
    }
    try {
        run(*fits);
    } catch (const std::exception& error) {
        fmt::print(stderr, "interval_coverage_bench: error: {}\n", error.what());
        return 1;
    }
    return 0;
}

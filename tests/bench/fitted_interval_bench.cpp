// How often 95 % intervals of models that are fitted to a few flights hold flights to come: mean power and energy of each
// phase, energy of a flight and state of charge at its end, of aircraft that nobody knows. Exit code 1 where a cell
// holds less than 90 %, or all cells together less than 93 or more than 98 %, beyond three standard errors.
// usage: fitted_interval_bench [MODELS [SEED]]: 250 models a row and seed 600001 if not said

#include "base/number.h"
#include "base/units.h"
#include "helpers/new_flights.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

constexpr std::size_t new_flights = 20;  // of each model
constexpr double min_share = 0.90;
constexpr double min_overall = 0.93;
constexpr double max_overall = 0.98;

using Shares = std::vector<double>;  // of a cell: one a model

double standard_error(const Shares& shares) {
    return sample_sd(shares) / std::sqrt(static_cast<double>(shares.size()));
}

/// Prints a row; whether each of its cells holds enough. Adds its models' means over the cells to `overall`.
bool print_row(std::size_t flights, double noise_w, std::size_t models, unsigned seed, Shares& overall) {
    std::vector<Shares> cells(test::interval_quantities.size());
    for (std::size_t model = 0; model < models; ++model) {
        const auto shares =
            test::UnknownAircraft(seed + static_cast<unsigned>(model)).interval_shares(flights, noise_w, new_flights);
        for (std::size_t q = 0; q < shares.size(); ++q) cells[q].push_back(shares[q]);
        overall.push_back(mean(Shares(shares.begin(), shares.end())));
    }
    bool enough = true;
    fmt::print("| {} | {:.2f} |", flights, noise_w);
    for (const auto& cell : cells) {
        const double share = mean(cell);
        const double error = standard_error(cell);
        fmt::print(" {:.1f} ± {:.1f} |", units::percentage(share, 1.0), units::percentage(error, 1.0));
        enough = enough && share + 3.0 * error >= min_share;
    }
    fmt::print("\n");
    std::fflush(stdout);
    return enough;
}

bool run(std::size_t models, unsigned seed) {
    fmt::print("{} models a row, seeds from {}, {} new flights each; percent that 95 % intervals hold\n\n", models,
               seed, new_flights);
    fmt::print("| flights | noise W |");
    for (const auto* quantity : test::interval_quantities) fmt::print(" {} |", quantity);
    fmt::print("\n|---:|---:|");
    for (std::size_t q = 0; q < test::interval_quantities.size(); ++q) fmt::print("---:|");
    fmt::print("\n");
    bool good = true;
    Shares overall;
    for (const std::size_t flights : {2U, 3U, 4U, 6U, 11U}) {
        for (const double noise_w : {0.24, 1.0}) {
            good = print_row(flights, noise_w, models, seed, overall) && good;
            seed += static_cast<unsigned>(models);
        }
    }
    const double share = mean(overall);
    const double error = standard_error(overall);
    fmt::print("\nall cells: {:.1f} ± {:.1f} %\n", units::percentage(share, 1.0), units::percentage(error, 1.0));
    return good && share + 3.0 * error >= min_overall && share - 3.0 * error <= max_overall;
}

}  // namespace

int main(int argc, char** argv) {
    const auto models = argc > 1 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(250);
    const auto seed = argc > 2 ? parse_unsigned(argv[2]) : std::optional<std::uint64_t>(600001);
    if (argc > 3 || !models || !seed || *models < 2) {
        fmt::print(stderr, "usage: fitted_interval_bench [MODELS [SEED]]\n");
        return 2;
    }
    try {
        return run(*models, static_cast<unsigned>(*seed)) ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "fitted_interval_bench: error: {}\n", error.what());
        return 1;
    }
}

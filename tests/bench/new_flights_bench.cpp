// How many flights to come keep what is promised from few flights: aircraft that nobody knows, models of their flights.
// Exit code 1 where a row keeps less than was promised, beyond three standard errors and half a point. usage:
// new_flights_bench [MODELS [SEED]]: 2000 models a row (a tenth where that takes long) and seed 500001 if not said

#include "base/number.h"
#include "helpers/new_flights.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

constexpr std::array<std::size_t, 5> model_flights{2, 3, 4, 6, 11};

/// Rows of one kind of promise.
struct Rows {
    const char* name = "";
    std::vector<std::size_t> flights;
    test::PromiseTrial trial;
    std::size_t models = 0;
    unsigned step = 1;  ///< 3: ideal batteries alone
};

constexpr double least_kept = 0.945;

/// Whether all rows keep what was promised; of a spread that is taken as known it is known that they do not.
bool print_rows(const Rows& rows, unsigned seed) {
    bool all_kept = true;
    for (const auto flights : rows.flights) {
        auto trial = rows.trial;
        trial.flights = flights;
        const auto kept = keep_promises(trial, rows.models, seed, rows.step);
        fmt::print("{:<38}  {:>7}  {:>6}  {:>6.2f} +- {:.2f}  {:>12}\n", rows.name, flights, rows.models,
                   100.0 * kept.share, 100.0 * kept.standard_error, kept.without_plan);
        std::fflush(stdout);
        all_kept = all_kept && (trial.as_if_known || kept.share + 3.0 * kept.standard_error >= least_kept);
    }
    return all_kept;
}

/// What takes long has a tenth of the models.
bool run(std::size_t models, unsigned seed) {
    fmt::print("a reserve promised with 95 %, from seed {}, 200 new flights a model\n\n", seed);
    fmt::print("{:<38}  {:>7}  {:>6}  {:>14}  {:>12}\n", "promise", "flights", "models", "kept, %", "without plan");
    const std::vector<std::size_t> all(model_flights.begin(), model_flights.end());
    const auto fewer = std::max<std::size_t>(models / 10, 2);
    const std::vector<Rows> kinds{{"ideal battery", all, {}, models, 3},
                                  {"ideal battery, fitted", {3, 4}, {.by_fit = true}, fewer, 3},
                                  {"ideal battery, spread as if known", all, {.as_if_known = true}, models, 3},
                                  {"ideal, resistance, Thevenin", all, {}, fewer},
                                  {"ideal battery, plan", all, {.by_plan = true}, fewer, 3}};
    bool all_kept = true;
    for (const auto& rows : kinds) all_kept = print_rows(rows, seed) && all_kept;
    return all_kept;
}

}  // namespace

int main(int argc, char** argv) {
    const auto models = argc > 1 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(2000);
    const auto seed = argc > 2 ? parse_unsigned(argv[2]) : std::optional<std::uint64_t>(500001);
    if (argc > 3 || !models || !seed || *models < 2) {
        fmt::print(stderr, "usage: new_flights_bench [MODELS [SEED]]\n");
        return 2;
    }
    try {
        return run(*models, static_cast<unsigned>(*seed)) ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "new_flights_bench: error: {}\n", error.what());
        return 1;
    }
}

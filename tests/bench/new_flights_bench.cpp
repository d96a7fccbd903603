// How many flights to come keep what is promised from few flights: aircraft that nobody knows, models of their flights.
// usage: new_flights_bench [MODELS [SEED]]: 2000 models a row (a tenth where that takes long) and seed 500001 if not said

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

void print_rows(const Rows& rows, unsigned seed) {
    for (const auto flights : rows.flights) {
        auto trial = rows.trial;
        trial.flights = flights;
        const auto kept = keep_promises(trial, rows.models, seed, rows.step);
        fmt::print("{:<38}  {:>7}  {:>6}  {:>6.2f} +- {:.2f}  {:>12}\n", rows.name, flights, rows.models,
                   100.0 * kept.share, 100.0 * kept.standard_error, kept.without_plan);
        std::fflush(stdout);
    }
}

/// What takes long has a tenth of the models.
void run(std::size_t models, unsigned seed) {
    fmt::print("a reserve promised with 95 %, from seed {}, 200 new flights a model\n\n", seed);
    fmt::print("{:<38}  {:>7}  {:>6}  {:>14}  {:>12}\n", "promise", "flights", "models", "kept, %", "without plan");
    const std::vector<std::size_t> all(model_flights.begin(), model_flights.end());
    const auto fewer = std::max<std::size_t>(models / 10, 2);
    print_rows({"ideal battery", all, {}, models, 3}, seed);
    print_rows({"ideal battery, fitted", {3, 4}, {.by_fit = true}, fewer, 3}, seed);
    print_rows({"ideal battery, spread as if known", all, {.as_if_known = true}, models, 3}, seed);
    print_rows({"ideal, resistance, Thevenin", all, {}, fewer}, seed);
    print_rows({"ideal battery, plan", all, {.by_plan = true}, fewer, 3}, seed);
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
        run(*models, static_cast<unsigned>(*seed));
    } catch (const std::exception& error) {
        fmt::print(stderr, "new_flights_bench: error: {}\n", error.what());
        return 1;
    }
    return 0;
}

// How often the 95 % interval of a prediction in flight holds the energy of a generated cruise.
// usage: in_flight_coverage_bench [FITS]: flights excluded in turn, of each row, about; 1000 if not said

#include "base/number.h"
#include "helpers/generated_flights.h"
#include "mechanical/validation.h"

#include <cmath>
#include <cstdio>
#include <exception>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

constexpr unsigned first_seed = 1001;  // the tests use those from 1 on

void print_row(std::size_t flights, double until_s, std::size_t left_out) {
    const auto sets = static_cast<unsigned>((left_out + flights - 1) / flights);
    double covered = 0.0;
    double before_wh = 0.0;
    double during_wh = 0.0;
    for (unsigned set = 0; set < sets; ++set) {
        auto generated = test::generated(flights, first_seed + set, until_s);
        for (auto& flight : generated) {  // the cruise alone is asked about
            flight.samples.phases[flight::Phase::takeoff].reset();
            flight.samples.phases[flight::Phase::landing].reset();
        }
        const auto validated = leave_one_out(generated);
        const auto during = score_of(validated, "in_flight", flight::Phase::cruise).value();
        covered += during.coverage_95.value() / sets;
        during_wh += during.mean_absolute_error_wh / sets;
        before_wh += score_of(validated, "fourier", flight::Phase::cruise)->mean_absolute_error_wh / sets;
    }
    const auto count = static_cast<double>(sets * flights);
    const double error = std::sqrt(covered * (1.0 - covered) / count);
    fmt::print("{:>14}  {:>7.0f}  {:>8.0f}  {:>6.1f} +- {:.1f}  {:>15.3f}  {:>15.3f}\n", flights - 1, until_s, count,
               units::percent_of(covered, 1.0), units::percent_of(error, 1.0), before_wh, during_wh);
    std::fflush(stdout);
}

void run(std::size_t left_out) {
    fmt::print(
        "Cruises of about 600 s, seeds from {}; +- is the binomial error, as if folds shared no flights.\n\n"
        "flights a model  until s   flights  covered, %     error before, Wh  error during, Wh\n",
        first_seed);
    for (const std::size_t flights : {4U, 5U, 9U, 12U}) {
        for (const double until_s : {100.0, 300.0, 450.0}) print_row(flights, until_s, left_out);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto fits = argc == 2 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(1000);
    if (argc > 2 || !fits || *fits == 0) {
        fmt::print(stderr, "usage: in_flight_coverage_bench [FITS]\n");
        return 2;
    }
    try {
        run(*fits);
    } catch (const std::exception& error) {
        fmt::print(stderr, "in_flight_coverage_bench: error: {}\n", error.what());
        return 1;
    }
    return 0;
}

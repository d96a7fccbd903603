// How often the 95 % interval of a prediction before flight and of one in flight covers the energy of a generated
// cruise, and how wide it is. Exit code 1 where a row covers less than 92 % or more than 98 %, beyond three standard
// errors. usage: in_flight_coverage_bench [FLIGHTS]: excluded in turn, or not seen, of each row, about (2000)

#include "base/number.h"
#include "base/units.h"
#include "helpers/binomial.h"
#include "helpers/generated_flights.h"
#include "helpers/generated_motion.h"
#include "mechanical/prediction.h"
#include "mechanical/validation.h"

#include <cmath>
#include <cstdio>
#include <exception>

#include <fmt/format.h>

namespace {

using namespace flightwatt;

constexpr unsigned first_seed = 1001;  // the tests use those from 1 on

constexpr double min_share = 0.92;
constexpr double largest_share = 0.98;

/// Sums over the flights of a row.
struct Row {
    double covered = 0.0;
    double covered_before = 0.0;  ///< by the interval of the prediction that does not look at the flight
    double half_width_wh = 0.0;
    double error_wh = 0.0;
    double before_wh = 0.0;  ///< error of that prediction
    std::size_t flights = 0;
};

void add(Row& row, double measured_wh, const mechanical::EnergyEstimate& before,
         const mechanical::EnergyEstimate& estimate) {
    const auto interval = interval_95(estimate).value();
    row.covered += interval.contains(measured_wh) ? 1.0 : 0.0;
    row.covered_before += interval_95(before).value().contains(measured_wh) ? 1.0 : 0.0;
    row.half_width_wh += 0.5 * (interval.high - interval.low);
    row.error_wh += std::abs(estimate.energy_wh - measured_wh);
    row.before_wh += std::abs(before.energy_wh - measured_wh);
    ++row.flights;
}

/// Prints a row; whether both shares are within the limits.
bool print(std::size_t flights_of_model, double part, const Row& row) {
    const auto count = static_cast<double>(row.flights);
    bool within = true;
    fmt::print("{:>14}  {:>6.0f}  {:>8}", flights_of_model, units::percentage(part, 1.0), row.flights);
    for (const double share : {row.covered_before / count, row.covered / count}) {
        fmt::print("  {:>6.1f} +- {:.1f}", units::percentage(share, 1.0),
                   units::percentage(test::binomial_error(share, row.flights), 1.0));
        within = within && test::is_at_least(share, min_share, row.flights) &&
                 test::is_at_least(1.0 - share, 1.0 - largest_share, row.flights);
    }
    fmt::print("  {:>13.3f}  {:>15.3f}  {:>15.3f}{}\n", row.half_width_wh / count, row.before_wh / count,
               row.error_wh / count, within ? "" : "  outside 92 to 98 %");
    std::fflush(stdout);
    return within;
}

/// Cruises of the published model's shape and spread, without a path.
bool print_by_curve(std::size_t flights, double part, std::size_t left_out) {
    constexpr double cruise_s = 600.0;
    const auto sets = static_cast<unsigned>((left_out + flights - 1) / flights);
    Row row;
    for (unsigned set = 0; set < sets; ++set) {
        auto generated = test::generated(flights, first_seed + set, part * cruise_s);
        for (auto& flight : generated) {  // the cruise alone is asked about
            flight.samples.phases[flight::Phase::takeoff].reset();
            flight.samples.phases[flight::Phase::landing].reset();
        }
        for (const auto& flight : leave_one_out(generated)) {
            const auto during = predicted_energy(flight, "in_flight", flight::Phase::cruise).value();
            const auto before = predicted_energy(flight, "fourier", flight::Phase::cruise).value();
            add(row, during.measured_wh, before.estimate, during.estimate);
        }
    }
    return print(flights - 1, part, row);
}

/// Flights of 1800 s with the drift of the real ones, whose path is known.
bool print_by_path(std::size_t flights, double part, std::size_t unseen) {
    constexpr std::size_t bins = 60;
    const test::MotionTruth truth{.level_sd = 0.05, .drift_sd_w = 6.5, .correlation_s = 60.0};
    Row row;
    for (unsigned set = 0; set < unseen; ++set) {
        auto motions = test::made_up_motions(flights + 1, bins, truth, first_seed + set);
        const auto flight = std::move(motions.back());
        motions.pop_back();
        const auto model = fit_power_terms(
            motions, {mechanical::PowerTerm::drag, mechanical::PowerTerm::climb, mechanical::PowerTerm::descent});
        const auto now = static_cast<std::ptrdiff_t>(std::round(part * bins));
        mechanical::FlightProgress flown;
        flown.motion.bins.assign(flight.bins.begin(), flight.bins.begin() + now);
        flown.until_s = flight.bins[static_cast<std::size_t>(now)].start_s;
        const std::vector<mechanical::FlightBin> ahead(flight.bins.begin() + now, flight.bins.end());
        double measured_wh = 0.0;
        for (const auto& bin : ahead) measured_wh += units::wh_from_joule(bin.power_w * bin.duration_s);
        const double remaining_s = mechanical::default_bin_s * static_cast<double>(ahead.size());
        const auto values = mean_values(ahead);
        const auto before = energy_of(predicted_power(model, values, remaining_s), remaining_s);
        add(row, measured_wh, before, predict_remaining_physical(model, flown, {values, remaining_s}).energy);
    }
    return print(flights, part, row);
}

/// Whether all rows are within the limits.
bool run(std::size_t flights_of_row) {
    constexpr auto head =
        "flights a model  flown %   flights   before, %      during, %      half width, Wh  error before, Wh  error during, Wh\n";
    bool within = true;
    fmt::print(
        "Seeds from {}; covered before flight and in flight; +- is the binomial error, as if folds shared no flights.\n\n",
        first_seed);
    fmt::print("By the curve, cruises of about 600 s:\n{}", head);
    for (const std::size_t flights : {4U, 5U, 9U, 12U})
        for (const double part : {0.10, 0.25, 0.50, 0.75})
            within = print_by_curve(flights, part, flights_of_row) && within;
    fmt::print("\nBy the path that is known, flights of 1800 s whose drift is that of the real ones:\n{}", head);
    for (const std::size_t flights : {2U, 3U, 4U, 8U})
        for (const double part : {0.10, 0.25, 0.50, 0.75})
            within = print_by_path(flights, part, flights_of_row) && within;
    return within;
}

}  // namespace

int main(int argc, char** argv) {
    const auto flights = argc == 2 ? parse_unsigned(argv[1]) : std::optional<std::uint64_t>(2000);
    if (argc > 2 || !flights || *flights == 0) {
        fmt::print(stderr, "usage: in_flight_coverage_bench [FLIGHTS]\n");
        return 2;
    }
    try {
        return run(*flights) ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "in_flight_coverage_bench: error: {}\n", error.what());
        return 1;
    }
}

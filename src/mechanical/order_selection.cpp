#include "mechanical/order_selection.h"

#include "base/error.h"
#include "base/statistics.h"
#include "mechanical/fit/flight_weights.h"
#include "mechanical/fit/phase_fit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr std::size_t time_folds = 5;
constexpr std::size_t max_blocks = 20;
constexpr std::size_t min_samples_a_block = 2;

/// What is fitted and what is held back.
struct OrderFold {
    std::vector<PhaseSamples> seen;
    PhaseSamples held_back;
};

std::vector<OrderFold> folds_of_flights(std::span<const PhaseSamples> flights) {
    std::vector<OrderFold> folds;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        folds.push_back({{flights.begin(), flights.end()}, flights[i]});
        folds.back().seen.erase(folds.back().seen.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return folds;
}

std::vector<OrderFold> folds_of_time(const PhaseSamples& flight) {
    const std::size_t samples = flight.tau.size();
    const auto blocks = std::clamp(samples / min_samples_a_block, time_folds, max_blocks);
    const PhaseSamples none{flight.flight, flight.duration_s, {}, {}};
    std::vector<OrderFold> folds(time_folds, {{none}, none});
    for (std::size_t j = 0; j < samples; ++j) {
        const std::size_t held_back = j * blocks / samples % time_folds;
        for (std::size_t i = 0; i < time_folds; ++i) {
            auto& part = i == held_back ? folds[i].held_back : folds[i].seen.front();
            part.tau.push_back(flight.tau[j]);
            part.power_w.push_back(flight.power_w[j]);
        }
    }
    std::erase_if(folds, [](const OrderFold& fold) { return fold.held_back.tau.empty(); });
    return folds;
}

double mean_square_error_w2(flight::Phase phase, const OrderFold& fold, const PhaseFitOptions& options,
                            Weighting weighting) {
    const auto fit = fit_phase(phase, fold.seen, options);
    const auto average = average_phase(fit, flight_weights(fit, weighting));
    double sum = 0.0;
    for (std::size_t j = 0; j < fold.held_back.tau.size(); ++j) {
        const double predicted_w = power_w(average.fourier, fold.held_back.tau[j] * average.duration_s);
        sum += std::pow(fold.held_back.power_w[j] - predicted_w, 2);
    }
    return sum / static_cast<double>(fold.held_back.tau.size());
}

OrderError error_of(flight::Phase phase, const std::vector<OrderFold>& folds, const PhaseFitOptions& options,
                    Weighting weighting) {
    OrderError error;
    error.order = options.order;
    try {
        for (const auto& fold : folds) {
            error.mean_square_w2.push_back(mean_square_error_w2(phase, fold, options, weighting));
        }
        error.rms_w = std::sqrt(mean(error.mean_square_w2));
    } catch (const NoResultError& no_answer) {
        error.mean_square_w2.clear();
        error.reason = no_answer.what();
    }
    return error;
}

void compare(OrderError& error, const std::vector<double>& best_w2) {
    std::vector<double> differences;
    std::ranges::transform(error.mean_square_w2, best_w2, std::back_inserter(differences), std::minus());
    error.excess_mse_w2 = mean(differences);
    error.standard_error_w2 = std::sqrt(sample_variance(differences) / static_cast<double>(differences.size()));
}

}  // namespace

std::string_view to_string(HoldOutScheme held_back) {
    return held_back == HoldOutScheme::one_flight ? "leave one flight out" : "blocks of time";
}

OrderSelection select_order(flight::Phase phase, std::span<const PhaseSamples> flights, const PhaseFitOptions& options,
                            Weighting weighting) {
    if (flights.empty()) throw NoResultError(fmt::format("no flight has a {} to fit", to_string(phase)));
    OrderSelection choice;
    choice.held_back = flights.size() > 1 ? HoldOutScheme::one_flight : HoldOutScheme::blocks_of_time;
    const auto folds =
        choice.held_back == HoldOutScheme::one_flight ? folds_of_flights(flights) : folds_of_time(flights.front());
    choice.folds = folds.size();
    auto tried = options;
    for (int order = 0; order <= max_tested_order; ++order) {
        tried.order = order;
        choice.errors.push_back(error_of(phase, folds, tried, weighting));
    }
    const auto best = std::ranges::min_element(choice.errors, {}, [](const OrderError& error) {
        return error.rms_w ? mean(error.mean_square_w2) : std::numeric_limits<double>::infinity();
    });
    if (!best->rms_w) {
        throw NoResultError(fmt::format("{}: no order can be fitted: {}", to_string(phase), choice.errors[0].reason));
    }
    choice.order = choice.best = best->order;
    const auto best_w2 = best->mean_square_w2;
    for (auto error = choice.errors.rbegin(); error != choice.errors.rend(); ++error) {
        if (!error->rms_w) continue;
        compare(*error, best_w2);
        if (error->order < choice.order && *error->excess_mse_w2 <= *error->standard_error_w2)
            choice.order = error->order;
    }
    return choice;
}

}  // namespace flightwatt::mechanical

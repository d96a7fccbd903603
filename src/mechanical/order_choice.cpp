#include "mechanical/order_choice.h"

#include "base/error.h"
#include "base/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

constexpr std::size_t time_folds = 5;
constexpr std::size_t most_blocks = 20;
constexpr std::size_t least_samples_a_block = 2;

/// What is fitted and what is predicted.
struct OrderFold {
    std::vector<PhaseSamples> seen;
    PhaseSamples excluded;
};

std::vector<OrderFold> leave_one_flight_out(std::span<const PhaseSamples> flights) {
    std::vector<OrderFold> folds;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        OrderFold fold;
        fold.excluded = flights[i];
        for (std::size_t k = 0; k < flights.size(); ++k) {
            if (k != i) fold.seen.push_back(flights[k]);
        }
        folds.push_back(std::move(fold));
    }
    return folds;
}

std::vector<OrderFold> blocks_of_time(const PhaseSamples& flight) {
    const std::size_t samples = flight.tau.size();
    const auto blocks = std::clamp(samples / least_samples_a_block, time_folds, most_blocks);
    std::vector<OrderFold> folds(time_folds);
    for (auto& fold : folds) {
        fold.seen.push_back({flight.flight, flight.duration_s, {}, {}});
        fold.excluded = {flight.flight, flight.duration_s, {}, {}};
    }
    for (std::size_t j = 0; j < samples; ++j) {
        const std::size_t out = j * blocks / samples % time_folds;
        for (std::size_t i = 0; i < time_folds; ++i) {
            auto& part = i == out ? folds[i].excluded : folds[i].seen.front();
            part.tau.push_back(flight.tau[j]);
            part.power_w.push_back(flight.power_w[j]);
        }
    }
    std::erase_if(folds, [](const OrderFold& fold) { return fold.excluded.tau.empty(); });
    return folds;
}

double mean_square_error_w2(flight::Phase phase, const OrderFold& fold, const PhaseFitOptions& options,
                            const WeightOptions& weights) {
    const auto fit = fit_phase(phase, fold.seen, options);
    const auto average = average_phase(fit, flight_weights(fit, phase, weights));
    double sum = 0.0;
    for (std::size_t j = 0; j < fold.excluded.tau.size(); ++j) {
        const double predicted_w = power_w(average.fourier, fold.excluded.tau[j] * average.duration_s);
        sum += std::pow(fold.excluded.power_w[j] - predicted_w, 2);
    }
    return sum / static_cast<double>(fold.excluded.tau.size());
}

/// One order's errors, fold by fold; empty if one cannot be fitted.
struct FoldErrors {
    std::vector<double> mean_square_w2;
    std::string reason;
};

FoldErrors errors_of(flight::Phase phase, const std::vector<OrderFold>& folds, const PhaseFitOptions& options,
                     const WeightOptions& weights) {
    FoldErrors errors;
    try {
        for (const auto& fold : folds) {
            errors.mean_square_w2.push_back(mean_square_error_w2(phase, fold, options, weights));
        }
    } catch (const NoAnswerError& error) {
        errors.mean_square_w2.clear();
        errors.reason = error.what();
    }
    return errors;
}

void compare(OrderError& error, const std::vector<double>& own, const std::vector<double>& best) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < own.size(); ++i) differences.push_back(own[i] - best[i]);
    error.behind_best_w2 = mean(differences);
    error.standard_error_w2 = std::sqrt(sample_variance(differences) / static_cast<double>(own.size()));
}

}  // namespace

OrderChoice choose_order(flight::Phase phase, std::span<const PhaseSamples> flights,
                         const PhaseFitOptions& options, const WeightOptions& weights) {
    if (flights.empty()) throw NoAnswerError(fmt::format("no flight has a {} to fit", to_string(phase)));
    OrderChoice choice;
    const bool several = flights.size() > 1;
    choice.how = several ? "leave one flight out" : "blocks of time";
    const auto folds = several ? leave_one_flight_out(flights) : blocks_of_time(flights.front());
    choice.folds = folds.size();
    const bool by_hand = weights.weighting == Weighting::by_hand;
    const WeightOptions weighting{by_hand ? Weighting::uniform : weights.weighting, {}};

    std::vector<FoldErrors> all;
    const FoldErrors* best = nullptr;
    double least_w2 = std::numeric_limits<double>::infinity();
    all.reserve(highest_tried_order + 1);  // `best` points into it
    for (int order = 0; order <= highest_tried_order; ++order) {
        auto tried = options;
        tried.order = order;
        all.push_back(errors_of(phase, folds, tried, weighting));
        OrderError error{order, std::nullopt, all.back().reason, std::nullopt, std::nullopt};
        if (!all.back().mean_square_w2.empty()) {
            const double mean_square_w2 = mean(all.back().mean_square_w2);
            error.rms_w = std::sqrt(mean_square_w2);
            if (mean_square_w2 < least_w2) {
                least_w2 = mean_square_w2;
                best = &all.back();
                choice.best = order;
            }
        }
        choice.errors.push_back(std::move(error));
    }
    if (best == nullptr) {
        throw NoAnswerError(fmt::format("{}: no order can be fitted: {}", to_string(phase), all[0].reason));
    }
    choice.order = choice.best;
    for (int order = highest_tried_order; order >= 0; --order) {
        const auto place = static_cast<std::size_t>(order);
        if (all[place].mean_square_w2.empty()) continue;
        auto& error = choice.errors[place];
        compare(error, all[place].mean_square_w2, best->mean_square_w2);
        if (order < choice.order && *error.behind_best_w2 <= *error.standard_error_w2) choice.order = order;
    }
    return choice;
}

}  // namespace flightwatt::mechanical

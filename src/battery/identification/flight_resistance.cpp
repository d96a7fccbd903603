#include "battery/identification/flight_resistance.h"

#include "base/statistics.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::battery {

double resistance_scatter_ohm(std::span<const std::optional<FlightResistance>> resistances, double fitted_ohm) {
    std::vector<double> values_ohm;
    double error_ohm2 = 0.0;
    for (const auto& own : resistances) {
        if (!own) continue;
        values_ohm.push_back(own->value_ohm);
        error_ohm2 += std::pow(own->standard_error_ohm, 2);
    }
    double sum_ohm2 = std::pow(default_scatter_fraction * fitted_ohm, 2);
    if (values_ohm.size() < 2) return std::sqrt(sum_ohm2);
    const auto n = static_cast<double>(values_ohm.size());
    sum_ohm2 += (n - 1.0) * std::max(0.0, sample_variance(values_ohm) - error_ohm2 / n);
    return std::sqrt(sum_ohm2 / n);
}

std::optional<ResistanceScatter> resistance_scatter(std::span<const std::optional<FlightResistance>> resistances,
                                                    double fitted_ohm) {
    const auto flights =
        static_cast<std::size_t>(std::ranges::count_if(resistances, [](const auto& own) { return own.has_value(); }));
    if (flights < 2) return std::nullopt;
    return ResistanceScatter{resistance_scatter_ohm(resistances, fitted_ohm), flights};
}

std::optional<ResistanceTrend> resistance_trend(std::span<const std::optional<FlightResistance>> in_order) {
    std::vector<double> number;
    std::vector<double> value_ohm;
    for (std::size_t i = 0; i < in_order.size(); ++i) {
        if (!in_order[i]) continue;
        number.push_back(static_cast<double>(i));
        value_ohm.push_back(in_order[i]->value_ohm);
    }
    constexpr std::size_t min_flights = 3;
    if (number.size() < min_flights) return std::nullopt;
    const double middle = mean(number);
    const double level_ohm = mean(value_ohm);
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 0; i < number.size(); ++i) {
        squares += std::pow(number[i] - middle, 2);
        products += (number[i] - middle) * (value_ohm[i] - level_ohm);
    }
    ResistanceTrend trend{number.size(), products / squares, {}};
    double left = 0.0;
    for (std::size_t i = 0; i < number.size(); ++i)
        left += std::pow(value_ohm[i] - level_ohm - trend.ohm_per_flight * (number[i] - middle), 2);
    const double degrees_of_freedom = static_cast<double>(number.size()) - 2.0;
    const double half = student_t_half_width(degrees_of_freedom) * std::sqrt(left / degrees_of_freedom / squares);
    trend.interval_ohm_a_flight = {trend.ohm_per_flight - half, trend.ohm_per_flight + half};
    return trend;
}

}  // namespace flightwatt::battery

#include "mechanical/uncertainty/phase_uncertainty_toml.h"

#include "base/toml_numbers.h"
#include "base/toml_text.h"

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// Numbers that are not negative, `count` of them.
std::vector<double> sizes(const TomlTable& table, std::string_view key, std::size_t count,
                          std::string_view because) {
    auto values = table.numbers(key);
    if (values.size() != count) {
        throw InputError(table.where(key), fmt::format("{} has {} numbers, expected {}: {}", key,
                                                       values.size(), count, because));
    }
    for (const double value : values) {
        if (value < 0.0) {
            throw InputError(table.where(key), fmt::format("{} holds {}, which is negative", key, value));
        }
    }
    return values;
}

}  // namespace

PhaseErrors read_errors(const TomlTable& table, std::size_t order) {
    constexpr std::string_view as_coefficients = "one for each coefficient of the phase";
    PhaseErrors errors;
    errors.omega_rad_per_s = number_in(at_least(0.0), table, "omega_rad_per_s");
    errors.frequency_is_given = table.optional_boolean("frequency_is_given").value_or(false);
    errors.a0_w = number_in(at_least(0.0), table, "a0_w");
    errors.cos_w = sizes(table, "cos_w", order, as_coefficients);
    errors.sin_w = sizes(table, "sin_w", order, as_coefficients);
    errors.curve_w = number_in(at_least(0.0), table, "curve_w");
    errors.degrees_of_freedom = number_in(at_least(1.0), table, "degrees_of_freedom");
    errors.r2 = number_in(at_most(1.0), table, "r2");
    errors.condition = number_in(at_least(1.0), table, "condition");
    errors.autocorrelation = number_in(between(0.0, 1.0), table, "autocorrelation");
    errors.effective_samples = number_in(at_least(0.0), table, "effective_samples");
    table.refuse_unknown_keys();
    return errors;
}

PhaseSpread read_spread(const TomlTable& table) {
    PhaseSpread spread;
    spread.low_w = table.numbers("low_w");
    spread.high_w = table.numbers("high_w");
    if (spread.low_w.size() < 2 || spread.high_w.size() != spread.low_w.size()) {
        throw InputError(
            table.where("high_w"),
            fmt::format("low_w has {} numbers and high_w {}, expected as many of each, two or more",
                        spread.low_w.size(), spread.high_w.size()));
    }
    for (std::size_t i = 0; i < spread.low_w.size(); ++i) {
        if (spread.high_w[i] >= spread.low_w[i]) continue;
        throw InputError(table.where("high_w"), fmt::format("number {} of high_w, {}, is below low_w's, {}",
                                                            i + 1, spread.high_w[i], spread.low_w[i]));
    }
    spread.standard_deviation_w =
        sizes(table, "standard_deviation_w", spread.low_w.size(), "as many as low_w has");
    spread.counted_flights = number_in(at_least(1.0), table, "counted_flights");
    table.refuse_unknown_keys();
    return spread;
}

std::string to_toml(const PhaseErrors& errors) {
    return "# standard errors of the weighted mean of these flights, from the noise of their samples\n" +
           fmt::format("omega_rad_per_s = {}\nfrequency_is_given = {}\na0_w = {}\ncos_w = {}\nsin_w = {}\n",
                       toml_real(errors.omega_rad_per_s), errors.frequency_is_given, toml_real(errors.a0_w),
                       toml_reals(errors.cos_w), toml_reals(errors.sin_w)) +
           fmt::format("curve_w = {}\ndegrees_of_freedom = {}\nr2 = {}\ncondition = {}\n",
                       toml_real(errors.curve_w), toml_real(errors.degrees_of_freedom), toml_real(errors.r2),
                       toml_real(errors.condition)) +
           fmt::format("autocorrelation = {}\neffective_samples = {}\n", toml_real(errors.autocorrelation),
                       toml_real(errors.effective_samples));
}

std::string to_toml(const PhaseSpread& spread) {
    return "# how the flights differ, at evenly spread parts of the phase from begin to end\n" +
           fmt::format("low_w = {}\nhigh_w = {}\nstandard_deviation_w = {}\ncounted_flights = {}\n",
                       toml_reals(spread.low_w), toml_reals(spread.high_w),
                       toml_reals(spread.standard_deviation_w), toml_real(spread.counted_flights));
}

}  // namespace flightwatt::mechanical

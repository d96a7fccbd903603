#include "mechanical/physical/physical_toml.h"

#include "base/toml_reader.h"
#include "base/toml_text.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mechanical {
namespace {

FlownRange read_motion_range(const TomlTable& table) {
    const double low = table.number("low");
    return {low, number_in(at_least(low), table, "high")};
}

PowerTerm read_term_name(const TomlTable& table) {
    const auto name = table.string("term");
    if (const auto term = power_term_from(name)) return *term;
    std::vector<std::string_view> names(all_power_terms.size());
    std::ranges::transform(all_power_terms, names.begin(), [](PowerTerm term) { return to_string(term); });
    throw InputError(table.where("term"), fmt::format("there is no term '{}'", name),
                     fmt::format("it is one of {}", fmt::join(names, ", ")));
}

void read_term(PhysicalModel& model, const TomlTable& table, std::size_t count) {
    const auto term = read_term_name(table);
    if (std::ranges::find(model.terms, term) != model.terms.end())
        throw InputError(table.where("term"), fmt::format("the term {} is given twice", to_string(term)));
    model.terms.push_back(term);
    model.coefficients[term] = table.number("coefficient");
    auto row = table.numbers("covariance");
    if (row.size() != count) {
        throw InputError(table.where("covariance"),
                         fmt::format("covariance has {} numbers, expected {}: one for each of the model's terms",
                                     row.size(), count));
    }
    model.covariance.push_back(std::move(row));
    table.refuse_unknown_keys();
}

/// Symmetric, and no combination of the terms with a variance below 0.
void require_covariance(const PhysicalModel& model, const TomlTable& table) {
    const auto count = static_cast<Eigen::Index>(model.terms.size());
    Eigen::MatrixXd correlation(count, count);
    constexpr double rounding = 1e-6;
    for (std::size_t i = 0; i < model.terms.size(); ++i) {
        for (std::size_t j = 0; j < model.terms.size(); ++j) {
            const double scale = std::sqrt(std::abs(model.covariance[i][i] * model.covariance[j][j]));
            const double value = model.covariance[i][j];
            if (std::abs(value - model.covariance[j][i]) > rounding * scale) {
                throw InputError(
                    table.where("terms"),
                    fmt::format("the covariance of {} and {} is {}, that of {} and {} is {}", to_string(model.terms[i]),
                                to_string(model.terms[j]), value, to_string(model.terms[j]), to_string(model.terms[i]),
                                model.covariance[j][i]),
                    "a covariance matrix is symmetric");
            }
            correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                scale > 0.0 ? value / scale : (value == 0.0 ? 0.0 : std::copysign(2.0, value));
        }
        if (model.covariance[i][i] < 0.0)
            throw InputError(table.where("terms"), fmt::format("the variance of {} is {}: expected 0 or more",
                                                               to_string(model.terms[i]), model.covariance[i][i]));
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
    if (solver.eigenvalues().minCoeff() >= -rounding) return;
    throw InputError(table.where("terms"), "the covariances are larger than the variances let them be");
}

void read_terms(PhysicalModel& model, const TomlTable& table) {
    const auto terms = table.tables("terms");
    if (terms.empty()) throw InputError(table.where(), "[physical] has no terms", "expected [[physical.terms]]");
    for (const auto& term : terms) read_term(model, term, terms.size());
    require_covariance(model, table);
}

std::string motion_range_toml(const FlownRange& range) {
    return fmt::format("{{ low = {}, high = {} }}", toml_real(range.low), toml_real(range.high));
}

}  // namespace

PhysicalModel read_physical(const TomlTable& table) {
    PhysicalModel model;
    model.flights = table.strings("flights");
    model.bins = count_in(table, "bins", 1);
    model.bin_s = number_in(more_than(0.0), table, "bin_s");
    model.samples = count_in(table, "samples");
    model.mean_airspeed_m_per_s = number_in(at_least(0.0), table, "mean_airspeed_m_per_s");
    const auto airspeed = table.table("airspeed_m_per_s");
    model.airspeed_m_per_s = read_motion_range(airspeed);
    airspeed.refuse_unknown_keys();
    const auto climb = table.table("climb_m_per_s");
    model.climb_m_per_s = read_motion_range(climb);
    climb.refuse_unknown_keys();
    if (const auto level = table.optional_table("level")) {
        model.level_sd = number_in(at_least(0.0), *level, "sd");
        model.degrees_of_freedom = number_in(at_least(1.0), *level, "degrees_of_freedom");
        level->refuse_unknown_keys();
    }
    const auto drift = table.table("drift");
    model.drift_sd_w = number_in(at_least(0.0), drift, "sd_w");
    model.correlation_s = number_in(more_than(0.0), drift, "correlation_s");
    model.drift_degrees_of_freedom = number_in(at_least(1.0), drift, "degrees_of_freedom");
    drift.refuse_unknown_keys();
    read_terms(model, table);
    table.refuse_unknown_keys();
    return model;
}

std::string physical_toml(const PhysicalModel& model) {
    std::vector<std::string> names;
    for (const auto& flight : model.flights) names.push_back(toml_string(flight));
    std::string text =
        "\n# Power from the motion through the air: power_w = sum of coefficient * value over the terms\n"
        "[physical]\n" +
        fmt::format("flights = [{}]\nbins = {}\nbin_s = {}\nsamples = {}\n", fmt::join(names, ", "), model.bins,
                    toml_real(model.bin_s), model.samples) +
        fmt::format("mean_airspeed_m_per_s = {}\nairspeed_m_per_s = {}\nclimb_m_per_s = {}\n",
                    toml_real(model.mean_airspeed_m_per_s), motion_range_toml(model.airspeed_m_per_s),
                    motion_range_toml(model.climb_m_per_s));
    if (model.level_sd) {
        text += fmt::format("level = {{ sd = {}, degrees_of_freedom = {} }}\n", toml_real(*model.level_sd),
                            toml_real(model.degrees_of_freedom));
    }
    text += fmt::format("drift = {{ sd_w = {}, correlation_s = {}, degrees_of_freedom = {} }}\n",
                        toml_real(model.drift_sd_w), toml_real(model.correlation_s),
                        toml_real(model.drift_degrees_of_freedom));
    for (std::size_t i = 0; i < model.terms.size(); ++i) {
        const auto term = model.terms[i];
        text += fmt::format("\n[[physical.terms]]\nterm = {}\ncoefficient = {}  # {}\ncovariance = {}\n",
                            toml_string(to_string(term)), toml_real(model.coefficients[term]), unit_of(term),
                            toml_reals(model.covariance[i]));
    }
    return text;
}

}  // namespace flightwatt::mechanical

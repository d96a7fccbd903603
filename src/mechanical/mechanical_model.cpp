#include "mechanical/mechanical_model.h"

#include "base/toml_fields.h"
#include "base/units.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mechanical {
namespace {

bool counts(const std::optional<PhaseContribution>& part) { return part && part->weight > 0.0 && part->mean_power_w; }

void use_mean_power(MechanicalModel& model, flight::Phase phase) {
    std::vector<double> powers_w;
    for (const auto& flight : model.flights)
        if (const auto& part = flight.phases[phase]; counts(part)) powers_w.push_back(*part->mean_power_w);
    if (powers_w.empty()) return;
    for (auto& flight : model.flights)
        if (auto& part = flight.phases[phase])
            part->weight = counts(part) ? 1.0 / static_cast<double>(powers_w.size()) : 0.0;
    auto& mean_power = model.phases[phase];
    mean_power.fourier = {mean_power.fourier.omega_rad_per_s, mean(powers_w), {}, {}};
    mean_power.open_frequency = mean_power.not_negative = false;
    mean_power.errors.reset();  // the curve's
    mean_power.spread.reset();
}

/// The end of its range that the frequency has reached; empty: none.
std::string_view bound_reached(const PhaseModel& phase) {
    constexpr double tolerance = 1e-5;
    if (!phase.range || phase.fourier.cos_w.empty()) return "";
    const double theta_rad = phase.fourier.omega_rad_per_s * phase.duration_s;
    return theta_rad <= (1.0 + tolerance) * phase.range->low_rad    ? "low"
           : theta_rad >= (1.0 - tolerance) * phase.range->high_rad ? "high"
                                                                    : "";
}

/// Numbers that are not negative, `count` of them.
void list_sizes(TomlFields& fields, std::string_view key, std::vector<double>& values, std::size_t count,
                std::string_view because) {
    fields.reals(key, values);
    if (fields.source() == nullptr) return;
    if (values.size() != count)
        throw InputError(fields.source()->where(key),
                         fmt::format("{} has {} numbers, expected {}: {}", key, values.size(), count, because));
    for (const double value : values)
        if (value < 0.0)
            throw InputError(fields.source()->where(key), fmt::format("{} contains {}, which is negative", key, value));
}

void list_errors(TomlFields& fields, PhaseErrors& errors, std::size_t order) {
    constexpr std::string_view as_coefficients = "one for each coefficient of the phase";
    fields.line("# standard errors of the weighted mean of these flights, from the noise of their samples");
    fields.real("omega_rad_per_s", errors.omega_rad_per_s, at_least(0.0));
    fields.flag("frequency_is_given", errors.frequency_is_fixed);
    fields.real("a0_w", errors.a0_w, at_least(0.0));
    list_sizes(fields, "cos_w", errors.cos_w, order, as_coefficients);
    list_sizes(fields, "sin_w", errors.sin_w, order, as_coefficients);
    fields.real("curve_w", errors.curve_w, at_least(0.0));
    fields.real("degrees_of_freedom", errors.degrees_of_freedom, at_least(1.0));
    fields.real("r2", errors.r2, at_most(1.0));
    fields.real("autocorrelation", errors.autocorrelation, between(0.0, 1.0));
    fields.real("effective_samples", errors.effective_samples, at_least(0.0));
    if (const auto* table = fields.source())  // of earlier versions
        for (const auto* key : {"from_flights", "noise_lasts", "interval_95", "condition"}) table->has(key);
}

void list_envelope(TomlFields& fields, FlightEnvelope& spread) {
    fields.line("# variability of the flights, at evenly spread fractions of the phase from begin to end");
    fields.reals("low_w", spread.low_w);
    fields.reals("high_w", spread.high_w);
    if (const auto* table = fields.source()) {
        const auto& [low_w, high_w, sd_w, flights] = spread;
        if (low_w.size() < 2 || !std::ranges::equal(low_w, high_w, std::less_equal<>()))
            throw InputError(table->where("high_w"), "high_w does not fit low_w",
                             "expected two numbers or more in each, none of high_w below that of low_w");
    }
    list_sizes(fields, "standard_deviation_w", spread.standard_deviation_w, spread.low_w.size(),
               "as many as low_w has");
    fields.real("counted_flights", spread.effective_flights, at_least(1.0));
}

void list_frequency_range(TomlFields& fields, FrequencyRange& range) {
    fields.real("low_rad", range.low_rad, more_than(0.0));
    fields.real("high_rad", range.high_rad, at_least(range.low_rad));
    if (const auto* table = fields.source()) table->has("at_bound");  // of earlier versions
}

void list_variance(TomlFields& fields, VarianceComponents& spread) {
    fields.count("flights", spread.flights, 2);
    fields.real("level_sd_w", spread.between_flight_sd_w, at_least(0.0));
    fields.real("drift_sd_w", spread.drift_sd_w, at_least(0.0));
    fields.real("correlation_s", spread.correlation_s, more_than(0.0));
}

void list_heights(TomlFields& fields, PhaseHeights& heights) {
    fields.real("mean_m", heights.mean_m, more_than(0.0));
    fields.real("low_m", heights.low_m, more_than_up_to(0.0, heights.mean_m));
    fields.real("high_m", heights.high_m, at_least(heights.mean_m));
    fields.real("m_per_s", heights.m_per_s, more_than(0.0));
}

void list_phase(TomlFields& fields, PhaseModel& phase) {
    const auto* table = fields.source();
    auto& fourier = phase.fourier;
    fields.real("duration_s", phase.duration_s, more_than(0.0));
    fields.optional_table("heights", phase.heights, list_heights);
    fields.real("omega_rad_per_s", fourier.omega_rad_per_s, more_than(0.0));
    fields.optional_table("omega_duration", phase.range, list_frequency_range);
    fields.real("a0_w", fourier.a0_w);
    fields.reals("cos_w", fourier.cos_w);
    fields.reals("sin_w", fourier.sin_w);
    const auto order = fourier.cos_w.size();
    if (table != nullptr && fourier.sin_w.size() != order)
        throw InputError(table->where("sin_w"),
                         fmt::format("sin_w has {} coefficients and cos_w {}, expected as many of each",
                                     fourier.sin_w.size(), order));
    fields.optional_real("rms_w", phase.rms_w, at_least(0.0));
    if (fields.has("samples", phase.samples > 0)) fields.count("samples", phase.samples);
    if (fields.has("flights", phase.flights > 0)) fields.count("flights", phase.flights);
    if (fields.has("edge_samples", phase.edge_samples > 0)) fields.count("edge_samples", phase.edge_samples);
    bool mean_curve = false;  // of earlier versions
    fields.optional_flag("mean_curve", mean_curve);
    fields.optional_flag("open_frequency", phase.open_frequency);
    fields.optional_flag("not_negative", phase.not_negative);
    fields.optional_table("level_spread", phase.level_spread, list_variance);
    if (fields.has("power", !phase.power.reason.empty())) {
        fields.choice("power", phase.power.by, {PowerBasis::curve, PowerBasis::mean});
        fields.text("power_reason", phase.power.reason);
    }
    if (table != nullptr)  // keys of earlier versions, which changed no prediction
        for (const auto* key : {"airspeed", "airspeed_law", "airspeed_cubed_parts_m3_per_s3"}) table->has(key);
    if (phase.errors) fields.line("");
    const auto list_of_order = [order](TomlFields& of, PhaseErrors& errors) { list_errors(of, errors, order); };
    fields.optional_table("errors", phase.errors, list_of_order, TomlLayout::section);
    if (phase.spread) fields.line("");
    fields.optional_table("spread", phase.spread, list_envelope, TomlLayout::section);
}

void list_contribution(TomlFields& fields, PhaseContribution& part) {
    fields.real("weight", part.weight, between(0.0, 1.0), "the weights of a phase are parts of 1");
    fields.real("duration_s", part.duration_s, more_than(0.0));
    fields.real("rms_w", part.rms_w, at_least(0.0));
    fields.count("samples", part.samples);
    fields.optional_real("mean_power_w", part.mean_power_w);
}

void list_flight(TomlFields& fields, FlightContribution& flight) {
    fields.text("flight", flight.flight);
    for (const auto phase : flight::all_phases)
        fields.optional_table(to_string(phase), flight.phases[phase], list_contribution);
}

void list_score(TomlFields& fields, HeldOutScore& score) {
    fields.text("model", score.model);
    fields.count("flights", score.flights, 1);
    fields.real("mean_absolute_error_percent", score.mean_absolute_error_percent, at_least(0.0));
}

void list_validation(TomlFields& fields, ModelValidation& validation) {
    const auto& name = validation.default_model;
    fields.text("default_model", validation.default_model);
    if (name != "fourier" && name != "constant_mean" && name != "by_phase")
        throw InputError(fields.source()->where("default_model"),
                         fmt::format("default_model = '{}', expected fourier, constant_mean or by_phase", name));
    fields.tables("scores", validation.scores, list_score, "");
}

void list_range(TomlFields& fields, Interval& range) {
    fields.real("low", range.low);
    fields.real("high", range.high, at_least(range.low));
}

/// One term of a model.
struct TermRow {
    PowerTerm term = PowerTerm::drag;
    double coefficient = 0.0;
    std::vector<double> covariance;  ///< with each of the terms
};

/// Of a term that was read, the last of `rows`: given once, with as many covariances as the model has terms.
void require_term(const TomlTable& table, const std::vector<TermRow>& rows, std::size_t count) {
    const auto& row = rows.back();
    if (std::ranges::count(rows, row.term, &TermRow::term) > 1)
        throw InputError(table.where("term"), fmt::format("the term {} is given twice", to_string(row.term)));
    if (row.covariance.size() == count) return;
    throw InputError(table.where("covariance"),
                     fmt::format("covariance has {} numbers, expected {}: one for each of the model's terms",
                                 row.covariance.size(), count));
}

/// Symmetric, with variances of 0 or more.
template <typename Model>
void require_covariance(const Model& model, const TomlTable& table) {
    constexpr double rounding = 1e-6;
    for (std::size_t i = 0; i < model.terms.size(); ++i) {
        const auto& row = model.covariance[i];
        if (row[i] < 0.0)
            throw InputError(table.where("terms"), fmt::format("the variance of {} is {}: expected 0 or more",
                                                               to_string(model.terms[i]), row[i]));
        for (std::size_t j = 0; j < i; ++j)
            if (std::abs(row[j] - model.covariance[j][i]) > rounding * std::sqrt(row[i] * model.covariance[j][j]))
                throw InputError(table.where("terms"), "the covariance matrix is not symmetric",
                                 "expected the same covariance of two terms in both rows");
    }
}

/// Of a PhysicalModel, or of SpeedTerms.
template <typename Model>
void list_terms(TomlFields& fields, Model& model) {
    std::vector<TermRow> rows;
    for (std::size_t i = 0; i < model.terms.size(); ++i)
        rows.push_back({model.terms[i], model.coefficients[model.terms[i]], model.covariance[i]});
    const auto* table = fields.source();
    const auto count = table != nullptr ? table->tables("terms").size() : rows.size();
    if (table != nullptr && count == 0)
        throw InputError(table->where(), "there are no terms", "expected a table [[...terms]] for each");
    fields.tables("terms", rows, [&](TomlFields& of, TermRow& row) {
        of.choice("term", row.term, all_power_terms);
        if (of.source() == nullptr)
            of.line(fmt::format("coefficient = {}  # {}", toml_real(row.coefficient), unit_of(row.term)));
        else
            of.real("coefficient", row.coefficient);
        of.reals("covariance", row.covariance);
        if (of.source() != nullptr) require_term(*of.source(), rows, count);
    });
    if (table == nullptr) return;
    for (const auto& row : rows) {
        model.terms.push_back(row.term);
        model.coefficients[row.term] = row.coefficient;
        model.covariance.push_back(row.covariance);
    }
    require_covariance(model, *table);
}

void list_physical(TomlFields& fields, PhysicalModel& model) {
    fields.texts("flights", model.flights);
    fields.count("bins", model.bins, 1);
    fields.real("bin_s", model.bin_s, more_than(0.0));
    fields.count("samples", model.samples);
    fields.real("mean_airspeed_m_per_s", model.mean_airspeed_m_per_s, at_least(0.0));
    fields.optional_real("cubic_mean_airspeed_m_per_s", model.cubic_mean_airspeed_m_per_s, at_least(0.0));
    fields.optional_real("airspeed_spread_m_per_s", model.airspeed_spread_m_per_s, at_least(0.0));
    fields.table("airspeed_m_per_s", model.airspeed_m_per_s, list_range);
    fields.optional_real("airspeed_sd_m_per_s", model.airspeed_sd_m_per_s, at_least(0.0));
    fields.table("climb_m_per_s", model.climb_m_per_s, list_range);
    fields.optional_table("payload_kg", model.payload_kg, [&](TomlFields& payload, Interval& range) {
        payload.real("mean", model.load.payload_kg, at_least(0.0));
        list_range(payload, range);
    });
    fields.optional_table("rotors", model.load.rotors, [](TomlFields& rotors, RotorLoading& of) {
        rotors.real("mass_kg", of.mass_kg, more_than(0.0));
        rotors.real("disc_area_m2", of.disc_area_m2, more_than(0.0));
    });
    fields.optional_table("level", model.level_sd, [&](TomlFields& level, double& sd) {
        level.real("sd", sd, at_least(0.0));
        level.real("degrees_of_freedom", model.degrees_of_freedom, at_least(1.0));
    });
    fields.table("drift", model, [](TomlFields& drift, PhysicalModel& of) {
        drift.real("sd_w", of.drift_sd_w, at_least(0.0));
        drift.real("correlation_s", of.correlation_s, more_than(0.0));
        drift.real("degrees_of_freedom", of.drift_degrees_of_freedom, at_least(1.0));
    });
    list_terms(fields, model);
    fields.optional_table(
        "speed_terms", model.speed_terms,
        [](TomlFields& of, SpeedTerms& speed) {
            of.real("degrees_of_freedom", speed.degrees_of_freedom, at_least(0.0));
            list_terms(of, speed);
        },
        TomlLayout::section);
}

void list_model(TomlFields& fields, MechanicalModel& model) {
    fields.text("name", model.name);
    if (fields.has("description", true)) fields.text("description", model.description);
    if (fields.has("weighting", true)) fields.text("weighting", model.weighting);
    fields.optional_flag("rotorcraft", model.is_rotorcraft);
    fields.optional_real("pack_voltage_v", model.pack_voltage_v, more_than(0.0));
    for (const auto phase : flight::all_phases) {
        fields.line("");
        fields.table(to_string(phase), model.phases[phase], list_phase, TomlLayout::section);
    }
    fields.tables("flights", model.flights, list_flight);
    if (model.validation)
        fields.line(
            "\n# Errors of each model on hold-out flights. Missions that state no airspeed use\n"
            "# default_model, which is what `power` of the phases states");
    fields.optional_table("validation", model.validation, list_validation, TomlLayout::section);
    if (model.physical)
        fields.line("\n# Power from the motion through the air: power_w = sum of coefficient * value over the terms");
    fields.optional_table("physical", model.physical, list_physical, TomlLayout::section);
}

/// The mean power [W] of level flight straight ahead at the airspeeds of the cruises: at two airspeeds with their mean and
/// standard deviation, as the power at the mean airspeed is less than the mean power of slower and faster flights.
double straight_power_w(const PhysicalModel& physical) {
    const double mean = physical.mean_airspeed_m_per_s;
    const double spread = physical.airspeed_spread_m_per_s.value_or(0.0);
    const double slow = std::max(0.0, mean - spread);
    const double fast = spread > 0.0 ? mean + spread * spread / (mean - slow) : mean;
    const double fast_part = spread > 0.0 ? (mean - slow) / (fast - slow) : 1.0;
    const auto power_at_w = [&](double airspeed) {
        return std::max(0.0, sum_of_terms_w(physical, term_values({airspeed}, physical.load)));
    };
    return fast_part * power_at_w(fast) + (1.0 - fast_part) * power_at_w(slow);
}

}  // namespace

std::string default_model(const MechanicalModel& model) {
    const auto means = std::ranges::count_if(model.phases.values,
                                             [](const auto& phase) { return phase.power.by == PowerBasis::mean; });
    return means == 0 ? "fourier" : means == std::ssize(model.phases.values) ? "constant_mean" : "by_phase";
}

bool motion_predicts_best(const MechanicalModel& model) {
    if (!model.physical || !model.validation) return model.physical && model.physical->flights.size() > 1;
    const auto is_physical = [](const auto& score) { return score.model == "physical"; };
    return std::ranges::any_of(model.validation->scores, is_physical);
}

MechanicalModel with_decided_power(MechanicalModel model) {
    for (const auto phase : flight::all_phases)
        if (model.phases[phase].power.by == PowerBasis::mean) use_mean_power(model, phase);
    return model;
}

double power_w(const FourierModel& model, double time_s) {
    if (model.cos_w.empty()) return model.a0_w;
    const double c = std::cos(model.omega_rad_per_s * time_s);
    const double s = std::sin(model.omega_rad_per_s * time_s);
    double power = model.a0_w;
    double cos_n = c;
    double sin_n = s;
    for (std::size_t n = 0; n < model.cos_w.size(); ++n) {
        power += model.cos_w[n] * cos_n + model.sin_w[n] * sin_n;
        const double next = cos_n * c - sin_n * s;
        sin_n = sin_n * c + cos_n * s;
        cos_n = next;
    }
    return power;
}

double energy_j(const FourierModel& model, double time_s) {
    double energy = model.a0_w * time_s;
    for (std::size_t n = 0; n < model.cos_w.size(); ++n) {
        const double omega = static_cast<double>(n + 1) * model.omega_rad_per_s;
        // 1 - cos(x) = 2 sin^2(x/2), without cancellation
        const double half = std::sin(omega * time_s / 2.0);
        energy += (model.cos_w[n] * std::sin(omega * time_s) + model.sin_w[n] * 2.0 * half * half) / omega;
    }
    return energy;
}

FourierModel time_scaled_model(const PhaseModel& phase, double flown_s, PhaseTimeScaling clock) {
    FourierModel flown = phase.fourier;
    if (clock == PhaseTimeScaling::scaled) flown.omega_rad_per_s *= phase.duration_s / flown_s;
    return flown;
}

double mean_power_w(const PhaseModel& phase) {
    return phase.duration_s > 0.0 ? energy_j(phase.fourier, phase.duration_s) / phase.duration_s : 0.0;
}

double duration_at_height_s(const PhaseModel& phase, double height_m) {
    const auto& heights = phase.heights.value();
    return phase.duration_s + (std::max(height_m, heights.low_m) - heights.mean_m) / heights.m_per_s;
}

Interval student_t_interval(double value, double standard_error, double degrees_of_freedom) {
    const double half = student_t_half_width(degrees_of_freedom) * standard_error;
    return {value - half, value + half};
}

CoefficientIntervals coefficient_intervals(const PhaseModel& phase) {
    const auto& errors = phase.errors.value();
    const auto about = [&](double value, double error) {
        return student_t_interval(value, error, errors.degrees_of_freedom);
    };
    CoefficientIntervals intervals{
        about(phase.fourier.omega_rad_per_s, errors.omega_rad_per_s), about(phase.fourier.a0_w, errors.a0_w), {}, {}};
    if (phase.range) {
        auto& [low, high] = intervals.omega_rad_per_s;
        low = std::max(low, std::min(phase.range->low_rad / phase.duration_s, phase.fourier.omega_rad_per_s));
        high = std::min(high, std::max(phase.range->high_rad / phase.duration_s, phase.fourier.omega_rad_per_s));
    }
    for (std::size_t n = 0; n < phase.fourier.cos_w.size(); ++n) {
        intervals.cos_w.push_back(about(phase.fourier.cos_w[n], errors.cos_w[n]));
        intervals.sin_w.push_back(about(phase.fourier.sin_w[n], errors.sin_w[n]));
    }
    return intervals;
}

std::size_t curve_point_count(const FourierModel& model, double duration_s) {
    const double turns = model.omega_rad_per_s * duration_s / units::rad_per_turn;
    const double swings = turns * static_cast<double>(model.cos_w.size());
    return std::max<std::size_t>(1000, static_cast<std::size_t>(std::ceil(16.0 * swings)));
}

std::vector<double> curve_w(const FourierModel& model, double duration_s, std::size_t points) {
    std::vector<double> curve(points);
    for (std::size_t i = 0; i < points; ++i) {
        const double tau = (static_cast<double>(i) + 0.5) / static_cast<double>(points);
        curve[i] = power_w(model, tau * duration_s);
    }
    return curve;
}

double rms_difference_w(const PhaseModel& a, const PhaseModel& b) {
    const auto points =
        std::max(curve_point_count(a.fourier, a.duration_s), curve_point_count(b.fourier, b.duration_s));
    const auto curve_a = curve_w(a.fourier, a.duration_s, points);
    const auto curve_b = curve_w(b.fourier, b.duration_s, points);
    double sum = 0.0;
    for (std::size_t i = 0; i < points; ++i) sum += std::pow(curve_a[i] - curve_b[i], 2);
    return std::sqrt(sum / static_cast<double>(points));
}

std::vector<std::string> model_warnings(const MechanicalModel& model) {
    std::vector<std::string> warnings;
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        if (fitted.power.by == PowerBasis::mean) continue;
        const auto curve =
            curve_w(fitted.fourier, fitted.duration_s, curve_point_count(fitted.fourier, fitted.duration_s));
        if (const double lowest_w = *std::ranges::min_element(curve); lowest_w < 0.0)
            warnings.push_back(
                fmt::format("{}: the curve falls to {:.3g} W: implausible without regeneration; try "
                            "another order or more flights",
                            phase_word(phase), lowest_w));
    }
    return warnings;
}

std::vector<std::string> fit_notes(const MechanicalModel& model) {
    std::vector<std::string> notes;
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        const auto note = [&](const std::string& text) {
            notes.push_back(fmt::format("{}: {}", phase_word(phase), text));
        };
        if (fitted.power.by == PowerBasis::mean)
            note(fmt::format("predicted by its mean power: {}", fitted.power.reason));
        if (fitted.edge_samples > 0)
            note(fmt::format("{} sample{} left out at its ends: the power is that of the neighbouring phase",
                             fitted.edge_samples, fitted.edge_samples == 1 ? " was" : "s were"));
        if (const auto bound = bound_reached(fitted); !bound.empty())
            note(fmt::format("the frequency is at its {} bound: the data determine the curve, but not its frequency",
                             bound));
        if (fitted.open_frequency)
            note("the samples do not determine the frequency: the coefficients describe this curve only");
        if (fitted.not_negative) note("the curve would fall below 0 W: its harmonics were reduced");
    }
    return notes;
}

MechanicalModel read_mechanical_model(const std::filesystem::path& path) {
    const auto root = read_toml(path, FileKind::mechanical_model);
    require_known_format(root);
    MechanicalModel model;
    TomlFields fields(root);
    list_model(fields, model);
    root.refuse_unknown_keys();
    // Earlier versions decided on all phases together.
    const bool is_decided =
        std::ranges::any_of(model.phases.values, [](const auto& phase) { return !phase.power.reason.empty(); });
    if (!is_decided && model.validation && model.validation->default_model == "constant_mean")
        for (auto& phase : model.phases.values)
            phase.power = {PowerBasis::mean, "leave-one-out did not prefer the curves"};
    return model;
}

MechanicalModel read_predicting_model(const std::filesystem::path& path) {
    constexpr double max_times = 2.0;
    auto model = with_decided_power(read_mechanical_model(path));
    for (const auto phase : flight::all_phases) {
        double lowest_w = 0.0;
        double highest_w = 0.0;
        for (const auto& flight : model.flights)
            if (const auto& part = flight.phases[phase]; part && part->mean_power_w) {
                lowest_w = std::min(lowest_w, *part->mean_power_w);
                highest_w = std::max(highest_w, *part->mean_power_w);
            }
        const double mean_w = mean_power_w(model.phases[phase]);
        if (highest_w == lowest_w || (mean_w >= max_times * lowest_w && mean_w <= max_times * highest_w)) continue;
        throw InputError({path.string()},
                         fmt::format("[{}]: its curve has a mean of {:.4g} W, and its flights of {:.4g} to {:.4g} W: "
                                     "their samples do not determine it",
                                     to_string(phase), mean_w, lowest_w, highest_w),
                         "fit it again, without --model-kind fourier: the mean power predicts then");
    }
    return model;
}

std::string to_toml(const MechanicalModel& model) {
    auto listed = model;
    TomlFields fields("");
    list_model(fields, listed);
    return "# Mechanical power of a flight, one Fourier series a phase (t in seconds since the phase began):\n"
           "#   power_w(t) = a0_w + sum over n of cos_w[n] cos(n omega t) + sin_w[n] sin(n omega t)\n" +
           format_line() + fields.lines() + "\n";
}

std::size_t model_order(const MechanicalModel& model) {
    std::size_t order = 0;
    for (const auto& phase : model.phases.values) order = std::max(order, phase.fourier.cos_w.size());
    return order;
}

double power_beyond_straight_flight_w(const MechanicalModel& model) {
    const auto& physical = model.physical;
    if (!physical || !(physical->mean_airspeed_m_per_s > 0.0)) return 0.0;
    return std::max(0.0, mean_power_w(model.phases[flight::Phase::cruise]) - straight_power_w(*physical));
}

}  // namespace flightwatt::mechanical

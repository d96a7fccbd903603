#include "base/toml_reader.h"
#include "base/toml_text.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/physical/physical_toml.h"

#include <limits>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

/// Numbers that are not negative, `count` of them.
std::vector<double> sizes(const TomlTable& table, std::string_view key, std::size_t count, std::string_view because) {
    auto values = table.numbers(key);
    if (values.size() != count) {
        throw InputError(table.where(key),
                         fmt::format("{} has {} numbers, expected {}: {}", key, values.size(), count, because));
    }
    for (const double value : values) {
        if (value < 0.0) {
            throw InputError(table.where(key), fmt::format("{} holds {}, which is negative", key, value));
        }
    }
    return values;
}

double positive(const TomlTable& table, std::string_view key) { return number_in(more_than(0.0), table, key); }

double not_negative(const TomlTable& table, std::string_view key) { return number_in(at_least(0.0), table, key); }

/// Two lists, low and high, as intervals.
std::vector<Interval> read_interval_list(const TomlTable& table, std::string_view low_key, std::string_view high_key,
                                         std::size_t count) {
    const auto low = table.numbers(low_key);
    const auto high = table.numbers(high_key);
    std::vector<Interval> intervals;
    for (const auto& [key, values] : {std::pair(low_key, low), std::pair(high_key, high)}) {
        if (values.size() == count) continue;
        throw InputError(table.where(key),
                         fmt::format("{} has {} numbers, expected {}: one for each coefficient of the "
                                     "phase",
                                     key, values.size(), count));
    }
    for (std::size_t i = 0; i < count; ++i) {
        if (low[i] > high[i]) {
            throw InputError(table.where(high_key), fmt::format("number {} of {}, {}, is below that of {}, {}", i + 1,
                                                                high_key, high[i], low_key, low[i]));
        }
        intervals.push_back({low[i], high[i]});
    }
    return intervals;
}

Interval read_interval(const TomlTable& table, std::string_view key) {
    const auto ends = table.numbers(key);
    if (ends.size() == 2 && ends[0] <= ends[1]) return {ends[0], ends[1]};
    throw InputError(table.where(key), fmt::format("{} is no interval, expected [low, high]", key));
}

CoefficientIntervals read_intervals(const TomlTable& table, std::size_t order) {
    CoefficientIntervals intervals{read_interval(table, "omega_rad_per_s"), read_interval(table, "a0_w"),
                                   read_interval_list(table, "cos_low_w", "cos_high_w", order),
                                   read_interval_list(table, "sin_low_w", "sin_high_w", order)};
    table.refuse_unknown_keys();
    return intervals;
}

PhaseErrors read_errors(const TomlTable& table, std::size_t order) {
    constexpr std::string_view as_coefficients = "one for each coefficient of the phase";
    PhaseErrors errors;
    errors.omega_rad_per_s = not_negative(table, "omega_rad_per_s");
    errors.frequency_is_fixed = table.optional_boolean("frequency_is_given").value_or(false);
    errors.a0_w = not_negative(table, "a0_w");
    errors.cos_w = sizes(table, "cos_w", order, as_coefficients);
    errors.sin_w = sizes(table, "sin_w", order, as_coefficients);
    errors.curve_w = not_negative(table, "curve_w");
    errors.degrees_of_freedom = number_in(at_least(1.0), table, "degrees_of_freedom");
    errors.r2 = number_in(at_most(1.0), table, "r2");
    errors.condition = number_in(at_least(1.0), table, "condition");
    errors.autocorrelation = number_in(between(0.0, 1.0), table, "autocorrelation");
    errors.effective_samples = not_negative(table, "effective_samples");
    table.optional_boolean("from_flights");  // of files of 0.2: it says how the errors were found, not what they are
    errors.noise_lasts = table.optional_boolean("noise_lasts").value_or(false);
    if (const auto intervals = table.optional_table("interval_95"))
        errors.intervals = read_intervals(*intervals, order);
    table.refuse_unknown_keys();
    return errors;
}

FlightEnvelope read_spread(const TomlTable& table) {
    FlightEnvelope spread;
    spread.low_w = table.numbers("low_w");
    spread.high_w = table.numbers("high_w");
    if (spread.low_w.size() < 2 || spread.high_w.size() != spread.low_w.size()) {
        throw InputError(table.where("high_w"),
                         fmt::format("low_w has {} numbers and high_w {}, expected as many of each, two or more",
                                     spread.low_w.size(), spread.high_w.size()));
    }
    for (std::size_t i = 0; i < spread.low_w.size(); ++i) {
        if (spread.high_w[i] >= spread.low_w[i]) continue;
        throw InputError(table.where("high_w"), fmt::format("number {} of high_w, {}, is below low_w's, {}", i + 1,
                                                            spread.high_w[i], spread.low_w[i]));
    }
    spread.standard_deviation_w = sizes(table, "standard_deviation_w", spread.low_w.size(), "as many as low_w has");
    spread.effective_flights = number_in(at_least(1.0), table, "counted_flights");
    table.refuse_unknown_keys();
    return spread;
}

std::string interval_toml(std::string_view key, const Interval& interval) {
    return fmt::format("interval_95.{} = {}\n", key, toml_reals({interval.low, interval.high}));
}

std::string interval_list_toml(std::string_view name, const std::vector<Interval>& intervals) {
    std::vector<double> low;
    std::vector<double> high;
    for (const auto& interval : intervals) {
        low.push_back(interval.low);
        high.push_back(interval.high);
    }
    return fmt::format("interval_95.{0}_low_w = {1}\ninterval_95.{0}_high_w = {2}\n", name, toml_reals(low),
                       toml_reals(high));
}

std::string intervals_toml(const CoefficientIntervals& intervals) {
    return interval_toml("omega_rad_per_s", intervals.omega_rad_per_s) + interval_toml("a0_w", intervals.a0_w) +
           interval_list_toml("cos", intervals.cos_w) + interval_list_toml("sin", intervals.sin_w);
}

std::string errors_toml(const PhaseErrors& errors) {
    return "# standard errors and intervals of the weighted mean of these flights, from the noise of their samples\n" +
           fmt::format("omega_rad_per_s = {}\nfrequency_is_given = {}\na0_w = {}\ncos_w = {}\nsin_w = {}\n",
                       toml_real(errors.omega_rad_per_s), errors.frequency_is_fixed, toml_real(errors.a0_w),
                       toml_reals(errors.cos_w), toml_reals(errors.sin_w)) +
           fmt::format("curve_w = {}\ndegrees_of_freedom = {}\nr2 = {}\ncondition = {}\n", toml_real(errors.curve_w),
                       toml_real(errors.degrees_of_freedom), toml_real(errors.r2), toml_real(errors.condition)) +
           fmt::format("autocorrelation = {}\neffective_samples = {}\n", toml_real(errors.autocorrelation),
                       toml_real(errors.effective_samples)) +
           (errors.noise_lasts ? "noise_lasts = true\n" : "") +
           (errors.intervals ? intervals_toml(*errors.intervals) : "");
}

std::string spread_toml(const FlightEnvelope& spread) {
    return "# how the flights differ, at evenly spread parts of the phase from begin to end\n" +
           fmt::format("low_w = {}\nhigh_w = {}\nstandard_deviation_w = {}\ncounted_flights = {}\n",
                       toml_reals(spread.low_w), toml_reals(spread.high_w), toml_reals(spread.standard_deviation_w),
                       toml_real(spread.effective_flights));
}

FrequencyBound read_bound(const TomlTable& table) {
    const auto name = table.string("at_bound");
    for (const auto bound : {FrequencyBound::none, FrequencyBound::low, FrequencyBound::high}) {
        if (name == to_string(bound)) return bound;
    }
    throw InputError(table.where("at_bound"), fmt::format("at_bound = '{}', expected none, low or high", name));
}

FrequencyRange read_range(const TomlTable& table) {
    const double low_rad = positive(table, "low_rad");
    const FrequencyRange range{low_rad, number_in(at_least(low_rad), table, "high_rad"), read_bound(table)};
    table.refuse_unknown_keys();
    return range;
}

VarianceComponents read_level_spread(const TomlTable& table) {
    const VarianceComponents spread{count_in(table, "flights", 2), not_negative(table, "level_sd_w"),
                                    not_negative(table, "drift_sd_w"), positive(table, "correlation_s")};
    table.refuse_unknown_keys();
    return spread;
}

Covariate read_covariate(const TomlTable& table) {
    const auto name = table.string("covariate");
    if (const auto covariate = covariate_from(name)) return *covariate;
    throw InputError(table.where("covariate"), fmt::format("there is no covariate '{}'", name),
                     fmt::format("it is one of {}", covariate_names()));
}

CovariateRegression read_level_law(const TomlTable& table) {
    const auto covariate = read_covariate(table);
    const CovariateRegression law{.covariate = covariate,
                                  .flights = count_in(table, "flights", min_regression_flights(covariate)),
                                  .mean = table.number("mean"),
                                  .sd = positive(table, "sd"),
                                  .least = table.number("least"),
                                  .most = table.number("most"),
                                  .mean_power_w = positive(table, "mean_power_w"),
                                  .slope_w = table.number("slope_w"),
                                  .residual_sd_w = not_negative(table, "residual_sd_w")};
    require_in(between(law.least, law.most), law.mean, "mean", table.where("mean"),
               "the mean lies between least and most");
    if (is_through_origin(covariate)) require_in(more_than(0.0), law.mean, "mean", table.where("mean"));
    table.refuse_unknown_keys();
    return law;
}

CovariateRegression read_airspeed_law(const TomlTable& table) {
    const auto law = read_level_law(table);
    if (law.covariate == Covariate::airspeed_cubed) return law;
    throw InputError(table.where("covariate"), fmt::format("an airspeed law of {}", to_string(law.covariate)),
                     fmt::format("it follows {}", to_string(Covariate::airspeed_cubed)));
}

/// The airspeed law as FlightWatt 0.1 wrote it, which did not keep its flights' airspeeds.
CovariateRegression read_airspeed_of_0_1(const TomlTable& table) {
    const auto flights = count_in(table, "flights", 2);
    const double coefficient = positive(table, "coefficient_w_s3_per_m3");
    const double relative_sd = not_negative(table, "relative_sd");
    table.refuse_unknown_keys();
    constexpr double most = std::numeric_limits<double>::max();
    return {Covariate::airspeed_cubed, flights, 1.0, 1.0, 0.0, most, coefficient, coefficient,
            coefficient * relative_sd};
}

std::vector<double> read_airspeed_parts(const TomlTable& table) {
    constexpr std::string_view key = "airspeed_cubed_parts_m3_per_s3";
    auto parts = table.numbers(key);
    if (parts.empty()) throw InputError(table.where(key), fmt::format("{} holds no number", key));
    for (const double part : parts) require_in(at_least(0.0), part, key, table.where(key));
    return parts;
}

PhaseModel read_phase(const TomlTable& table) {
    PhaseModel phase;
    phase.duration_s = positive(table, "duration_s");
    phase.fourier.omega_rad_per_s = positive(table, "omega_rad_per_s");
    phase.fourier.a0_w = table.number("a0_w");
    phase.fourier.cos_w = table.numbers("cos_w");
    phase.fourier.sin_w = table.numbers("sin_w");
    if (phase.fourier.cos_w.size() != phase.fourier.sin_w.size()) {
        throw InputError(table.where("sin_w"),
                         fmt::format("sin_w has {} coefficients and cos_w {}, expected as many of each",
                                     phase.fourier.sin_w.size(), phase.fourier.cos_w.size()));
    }
    if (table.has("rms_w")) phase.rms_w = not_negative(table, "rms_w");
    phase.samples = count_in_or(table, "samples", 0, 0);
    phase.flights = count_in_or(table, "flights", 0, 0);
    phase.edge_samples = count_in_or(table, "edge_samples", 0, 0);
    phase.mean_curve = table.optional_boolean("mean_curve").value_or(false);
    phase.not_negative = table.optional_boolean("not_negative").value_or(false);
    if (const auto range = table.optional_table("omega_duration")) phase.range = read_range(*range);
    const auto order = phase.fourier.cos_w.size();
    if (const auto errors = table.optional_table("errors")) phase.errors = read_errors(*errors, order);
    if (const auto spread = table.optional_table("spread")) phase.spread = read_spread(*spread);
    if (const auto spread = table.optional_table("level_spread")) phase.level_spread = read_level_spread(*spread);
    if (const auto law = table.optional_table("level_law")) phase.level_law = read_level_law(*law);
    if (const auto law = table.optional_table("airspeed_law")) phase.airspeed_law = read_airspeed_law(*law);
    if (table.has("airspeed_cubed_parts_m3_per_s3")) phase.airspeed_cubed_parts_m3_per_s3 = read_airspeed_parts(table);
    if (const auto old = table.optional_table("airspeed")) phase.airspeed_law = read_airspeed_of_0_1(*old);
    table.refuse_unknown_keys();
    return phase;
}

PhaseContribution read_contribution(const TomlTable& table) {
    PhaseContribution part{number_in(between(0.0, 1.0), table, "weight", "the weights of a phase are parts of 1"),
                           positive(table, "duration_s"), not_negative(table, "rms_w"), count_in(table, "samples")};
    if (table.has("mean_power_w")) part.mean_power_w = table.number("mean_power_w");
    table.refuse_unknown_keys();
    return part;
}

FlightContribution read_flight(const TomlTable& table) {
    FlightContribution flight;
    flight.flight = table.string("flight");
    for (const auto phase : flight::all_phases) {
        if (const auto part = table.optional_table(to_string(phase))) flight.phases[phase] = read_contribution(*part);
    }
    table.refuse_unknown_keys();
    return flight;
}

HeldOutScore read_score(const TomlTable& table) {
    HeldOutScore score{table.string("model"), count_in(table, "flights", 1),
                       not_negative(table, "mean_absolute_error_percent")};
    table.refuse_unknown_keys();
    return score;
}

ModelValidation read_validation(const TomlTable& table) {
    ModelValidation validation;
    const auto name = table.string("default_model");
    validation.prefers_curve = name == default_model({.prefers_curve = true, .scores = {}});
    if (name != default_model(validation))
        throw InputError(table.where("default_model"),
                         fmt::format("default_model = '{}', expected fourier or constant_mean", name));
    for (const auto& score : table.tables("scores")) validation.scores.push_back(read_score(score));
    table.refuse_unknown_keys();
    return validation;
}

std::string validation_toml(const ModelValidation& validation) {
    auto text = fmt::format(
        "\n# How far off each model was on flights left out of the fit in turn. Missions use default_model where they\n"
        "# state no airspeed\n[validation]\ndefault_model = {}\n",
        toml_string(default_model(validation)));
    for (const auto& score : validation.scores)
        text += fmt::format("[[validation.scores]]\nmodel = {}\nflights = {}\nmean_absolute_error_percent = {}\n",
                            toml_string(score.model), score.flights, toml_real(score.mean_absolute_error_percent));
    return text;
}

std::string level_law_toml(std::string_view key, const CovariateRegression& law) {
    return fmt::format(
        "{} = {{ covariate = {}, flights = {}, mean = {}, sd = {}, least = {}, most = {}, "
        "mean_power_w = {}, slope_w = {}, residual_sd_w = {} }}\n",
        key, toml_string(to_string(law.covariate)), law.flights, toml_real(law.mean), toml_real(law.sd),
        toml_real(law.least), toml_real(law.most), toml_real(law.mean_power_w), toml_real(law.slope_w),
        toml_real(law.residual_sd_w.value()));
}

std::string phase_toml(flight::Phase name, const PhaseModel& phase) {
    std::string text = fmt::format("\n[{}]\nduration_s = {}\nomega_rad_per_s = {}\n", to_string(name),
                                   toml_real(phase.duration_s), toml_real(phase.fourier.omega_rad_per_s));
    if (phase.range) {
        text += fmt::format("omega_duration = {{ low_rad = {}, high_rad = {}, at_bound = {} }}\n",
                            toml_real(phase.range->low_rad), toml_real(phase.range->high_rad),
                            toml_string(to_string(phase.range->at_bound)));
    }
    text += fmt::format("a0_w = {}\ncos_w = {}\nsin_w = {}\n", toml_real(phase.fourier.a0_w),
                        toml_reals(phase.fourier.cos_w), toml_reals(phase.fourier.sin_w));
    if (phase.rms_w) text += fmt::format("rms_w = {}\n", toml_real(*phase.rms_w));
    if (phase.samples > 0) text += fmt::format("samples = {}\n", phase.samples);
    if (phase.flights > 0) text += fmt::format("flights = {}\n", phase.flights);
    if (phase.edge_samples > 0) text += fmt::format("edge_samples = {}\n", phase.edge_samples);
    if (phase.mean_curve) text += "mean_curve = true\n";
    if (phase.not_negative) text += "not_negative = true\n";
    if (const auto& spread = phase.level_spread) {
        text += fmt::format("level_spread = {{ flights = {}, level_sd_w = {}, drift_sd_w = {}, correlation_s = {} }}\n",
                            spread->flights, toml_real(spread->between_flight_sd_w), toml_real(spread->drift_sd_w),
                            toml_real(spread->correlation_s));
    }
    if (phase.level_law) text += level_law_toml("level_law", *phase.level_law);
    if (phase.airspeed_law) text += level_law_toml("airspeed_law", *phase.airspeed_law);
    if (const auto& parts = phase.airspeed_cubed_parts_m3_per_s3; !parts.empty())
        text += fmt::format("airspeed_cubed_parts_m3_per_s3 = {}\n", toml_reals(parts));
    if (phase.errors) text += fmt::format("\n[{}.errors]\n{}", to_string(name), errors_toml(*phase.errors));
    if (phase.spread) text += fmt::format("\n[{}.spread]\n{}", to_string(name), spread_toml(*phase.spread));
    return text;
}

std::string flight_toml(const FlightContribution& flight) {
    std::string text = fmt::format("\n[[flights]]\nflight = {}\n", toml_string(flight.flight));
    for (const auto phase : flight::all_phases) {
        if (const auto& part = flight.phases[phase]) {
            text += fmt::format("{} = {{ weight = {}, duration_s = {}, rms_w = {}, samples = {}", to_string(phase),
                                toml_real(part->weight), toml_real(part->duration_s), toml_real(part->rms_w),
                                part->samples);
            if (part->mean_power_w) text += fmt::format(", mean_power_w = {}", toml_real(*part->mean_power_w));
            text += " }\n";
        }
    }
    return text;
}

}  // namespace

MechanicalModel read_mechanical_model(const std::filesystem::path& path) {
    const auto root = read_toml(path);
    require_kind(root, FileKind::mechanical_model);
    require_known_format(root);
    MechanicalModel model;
    model.name = root.string("name");
    model.description = root.optional_string("description").value_or("");
    model.weighting = root.optional_string("weighting").value_or("");
    for (const auto phase : flight::all_phases) model.phases[phase] = read_phase(root.table(to_string(phase)));
    for (const auto& flight : root.tables("flights")) model.flights.push_back(read_flight(flight));
    if (const auto validation = root.optional_table("validation")) model.validation = read_validation(*validation);
    if (const auto physical = root.optional_table("physical")) model.physical = read_physical(*physical);
    root.refuse_unknown_keys();
    return model;
}

std::string to_toml(const MechanicalModel& model) {
    std::string text =
        "# Mechanical power of a flight, one Fourier series a phase (t in seconds since the phase began):\n"
        "#   power_w(t) = a0_w + sum over n of cos_w[n] cos(n omega t) + sin_w[n] sin(n omega t)\n";
    text += format_line();
    text += fmt::format("name = {}\ndescription = {}\nweighting = {}\n", toml_string(model.name),
                        toml_string(model.description), toml_string(model.weighting));
    for (const auto phase : flight::all_phases) text += phase_toml(phase, model.phases[phase]);
    for (const auto& flight : model.flights) text += flight_toml(flight);
    if (model.validation) text += validation_toml(*model.validation);
    if (model.physical) text += physical_toml(*model.physical);
    return text;
}

}  // namespace flightwatt::mechanical

#include "base/toml_reader.h"
#include "base/toml_text.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/uncertainty/phase_uncertainty_toml.h"

#include <cmath>

#include <fmt/format.h>

namespace flightwatt::mechanical {
namespace {

double positive_number(const TomlTable& table, std::string_view key) {
    const double value = table.number(key);
    if (value <= 0.0) {
        throw InputError(table.where(key), fmt::format("{} = {} is not positive", key, value));
    }
    return value;
}

double number_from_zero(const TomlTable& table, std::string_view key) {
    const double value = table.number(key);
    if (value < 0.0) throw InputError(table.where(key), fmt::format("{} = {} is negative", key, value));
    return value;
}

std::size_t count(const TomlTable& table, std::string_view key) {
    constexpr double largest_exact = 9007199254740992.0;  // 2^53: beyond, a double is no count
    const double value = number_from_zero(table, key);
    if (value != std::floor(value) || value > largest_exact) {
        throw InputError(table.where(key), fmt::format("{} = {} is not a whole number", key, value));
    }
    return static_cast<std::size_t>(value);
}

double weight(const TomlTable& table, std::string_view key) {
    const double value = number_from_zero(table, key);
    if (value > 1.0) {
        throw InputError(table.where(key), fmt::format("{} = {} is more than 1", key, value),
                         "the weights of a phase are parts of 1");
    }
    return value;
}

FrequencyRange read_range(const TomlTable& table) {
    FrequencyRange range{positive_number(table, "low_rad"), positive_number(table, "high_rad"),
                         table.string("at_bound")};
    if (range.at_bound != "none" && range.at_bound != "low" && range.at_bound != "high") {
        throw InputError(table.where("at_bound"),
                         fmt::format("at_bound = '{}', expected none, low or high", range.at_bound));
    }
    if (range.high_rad < range.low_rad) {
        throw InputError(table.where("high_rad"),
                         fmt::format("high_rad = {} is below low_rad = {}", range.high_rad, range.low_rad));
    }
    table.refuse_unknown_keys();
    return range;
}

std::size_t flights_of_spread(const TomlTable& table) {
    const auto flights = count(table, "flights");
    if (flights < 2) {
        throw InputError(table.where("flights"),
                         fmt::format("flights = {}: a spread needs 2 or more", flights));
    }
    return flights;
}

LevelSpread read_level_spread(const TomlTable& table) {
    const LevelSpread spread{flights_of_spread(table), number_from_zero(table, "level_sd_w"),
                             number_from_zero(table, "drift_sd_w"), positive_number(table, "correlation_s")};
    table.refuse_unknown_keys();
    return spread;
}

AirspeedLaw read_airspeed(const TomlTable& table) {
    const AirspeedLaw law{flights_of_spread(table), positive_number(table, "coefficient_w_s3_per_m3"),
                          number_from_zero(table, "relative_sd")};
    table.refuse_unknown_keys();
    return law;
}

LevelLaw read_level_law(const TomlTable& table) {
    const auto name = table.string("covariate");
    const auto covariate = covariate_from(name);
    if (!covariate) {
        throw InputError(table.where("covariate"), fmt::format("there is no covariate '{}'", name),
                         fmt::format("it is one of {}", covariate_names()));
    }
    LevelLaw law{*covariate,
                 count(table, "flights"),
                 table.number("mean"),
                 positive_number(table, "sd"),
                 table.number("least"),
                 table.number("most"),
                 positive_number(table, "mean_power_w"),
                 table.number("slope_w"),
                 number_from_zero(table, "residual_sd_w")};
    if (law.flights < least_flights_of_law) {
        throw InputError(table.where("flights"), fmt::format("flights = {}: a level law needs {} or more",
                                                             law.flights, least_flights_of_law));
    }
    if (!(law.least <= law.mean && law.mean <= law.most)) {
        throw InputError(table.where("mean"), fmt::format("mean = {} is not between least = {} and most = {}",
                                                          law.mean, law.least, law.most));
    }
    table.refuse_unknown_keys();
    return law;
}

PhaseModel read_phase(const TomlTable& table) {
    PhaseModel phase;
    phase.duration_s = positive_number(table, "duration_s");
    phase.fourier.omega_rad_per_s = positive_number(table, "omega_rad_per_s");
    phase.fourier.a0_w = table.number("a0_w");
    phase.fourier.cos_w = table.numbers("cos_w");
    phase.fourier.sin_w = table.numbers("sin_w");
    if (phase.fourier.cos_w.size() != phase.fourier.sin_w.size()) {
        throw InputError(table.where("sin_w"),
                         fmt::format("sin_w has {} coefficients and cos_w {}, expected as many of each",
                                     phase.fourier.sin_w.size(), phase.fourier.cos_w.size()));
    }
    if (table.has("rms_w")) phase.rms_w = number_from_zero(table, "rms_w");
    if (table.has("samples")) phase.samples = count(table, "samples");
    if (table.has("flights")) phase.flights = count(table, "flights");
    if (const auto range = table.optional_table("omega_duration")) phase.range = read_range(*range);
    const auto order = phase.fourier.cos_w.size();
    if (const auto errors = table.optional_table("errors")) phase.errors = read_errors(*errors, order);
    if (const auto spread = table.optional_table("spread")) phase.spread = read_spread(*spread);
    if (const auto spread = table.optional_table("level_spread"))
        phase.level_spread = read_level_spread(*spread);
    if (const auto airspeed = table.optional_table("airspeed")) phase.airspeed = read_airspeed(*airspeed);
    if (const auto law = table.optional_table("level_law")) phase.level_law = read_level_law(*law);
    table.refuse_unknown_keys();
    return phase;
}

PhaseContribution read_contribution(const TomlTable& table) {
    PhaseContribution part{weight(table, "weight"), positive_number(table, "duration_s"),
                           number_from_zero(table, "rms_w"), count(table, "samples")};
    table.refuse_unknown_keys();
    return part;
}

FlightContribution read_flight(const TomlTable& table) {
    FlightContribution flight;
    flight.flight = table.string("flight");
    for (const auto phase : flight::all_phases) {
        if (const auto part = table.optional_table(to_string(phase))) {
            flight.phases[phase] = read_contribution(*part);
        }
    }
    table.refuse_unknown_keys();
    return flight;
}

std::string level_law_toml(const LevelLaw& law) {
    return fmt::format(
        "level_law = {{ covariate = {}, flights = {}, mean = {}, sd = {}, least = {}, most = {}, "
        "mean_power_w = {}, slope_w = {}, residual_sd_w = {} }}\n",
        toml_string(to_string(law.covariate)), law.flights, toml_real(law.mean), toml_real(law.sd),
        toml_real(law.least), toml_real(law.most), toml_real(law.mean_power_w), toml_real(law.slope_w),
        toml_real(law.residual_sd_w.value()));
}

std::string phase_toml(flight::Phase name, const PhaseModel& phase) {
    std::string text = fmt::format("\n[{}]\nduration_s = {}\nomega_rad_per_s = {}\n", to_string(name),
                                   toml_real(phase.duration_s), toml_real(phase.fourier.omega_rad_per_s));
    if (phase.range) {
        text += fmt::format("omega_duration = {{ low_rad = {}, high_rad = {}, at_bound = {} }}\n",
                            toml_real(phase.range->low_rad), toml_real(phase.range->high_rad),
                            toml_string(phase.range->at_bound));
    }
    text += fmt::format("a0_w = {}\ncos_w = {}\nsin_w = {}\n", toml_real(phase.fourier.a0_w),
                        toml_reals(phase.fourier.cos_w), toml_reals(phase.fourier.sin_w));
    if (phase.rms_w) text += fmt::format("rms_w = {}\n", toml_real(*phase.rms_w));
    if (phase.samples > 0) text += fmt::format("samples = {}\n", phase.samples);
    if (phase.flights > 0) text += fmt::format("flights = {}\n", phase.flights);
    if (const auto& spread = phase.level_spread) {
        text += fmt::format(
            "level_spread = {{ flights = {}, level_sd_w = {}, drift_sd_w = {}, correlation_s = {} }}\n",
            spread->flights, toml_real(spread->level_sd_w), toml_real(spread->drift_sd_w),
            toml_real(spread->correlation_s));
    }
    if (const auto& law = phase.level_law) text += level_law_toml(*law);
    if (const auto& law = phase.airspeed) {
        text +=
            fmt::format("airspeed = {{ flights = {}, coefficient_w_s3_per_m3 = {}, relative_sd = {} }}\n",
                        law->flights, toml_real(law->coefficient_w_s3_per_m3), toml_real(law->relative_sd));
    }
    if (phase.errors) text += fmt::format("\n[{}.errors]\n{}", to_string(name), to_toml(*phase.errors));
    if (phase.spread) text += fmt::format("\n[{}.spread]\n{}", to_string(name), to_toml(*phase.spread));
    return text;
}

std::string flight_toml(const FlightContribution& flight) {
    std::string text = fmt::format("\n[[flights]]\nflight = {}\n", toml_string(flight.flight));
    for (const auto phase : flight::all_phases) {
        if (const auto& part = flight.phases[phase]) {
            text += fmt::format("{} = {{ weight = {}, duration_s = {}, rms_w = {}, samples = {} }}\n",
                                to_string(phase), toml_real(part->weight), toml_real(part->duration_s),
                                toml_real(part->rms_w), part->samples);
        }
    }
    return text;
}

}  // namespace

MechanicalModel read_mechanical_model(const std::filesystem::path& path) {
    const auto root = read_toml(path);
    MechanicalModel model;
    model.name = root.string("name");
    model.description = root.optional_string("description").value_or("");
    model.weighting = root.optional_string("weighting").value_or("");
    for (const auto phase : flight::all_phases)
        model.phases[phase] = read_phase(root.table(to_string(phase)));
    for (const auto& flight : root.tables("flights")) model.flights.push_back(read_flight(flight));
    root.refuse_unknown_keys();
    return model;
}

std::string to_toml(const MechanicalModel& model) {
    std::string text =
        "# Mechanical power of a flight, one Fourier series a phase (t in seconds since the phase began):\n"
        "#   power_w(t) = a0_w + sum over n of cos_w[n] cos(n omega t) + sin_w[n] sin(n omega t)\n";
    text += fmt::format("name = {}\ndescription = {}\nweighting = {}\n", toml_string(model.name),
                        toml_string(model.description), toml_string(model.weighting));
    for (const auto phase : flight::all_phases) text += phase_toml(phase, model.phases[phase]);
    for (const auto& flight : model.flights) text += flight_toml(flight);
    return text;
}

}  // namespace flightwatt::mechanical

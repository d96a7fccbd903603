#include "exchange/model_text.h"

#include "base/text.h"
#include "base/units.h"
#include "battery/battery_toml.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <vector>

#include <boost/algorithm/string/case_conv.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <toml++/toml.h>

namespace flightwatt::exchange {
namespace {

/// nlohmann prints the shortest digits of a number, toml++ 17.
std::string json_text(const std::string& toml) {
    std::ostringstream json;
    json << toml::json_formatter(toml::parse(toml));
    return nlohmann::json::parse(json.str()).dump(2) + "\n";
}

bool is_letter(char c) { return c >= 'a' && c <= 'z'; }

/// A list of doubles in C, which reads the digits of TOML.
std::string c_numbers(const std::vector<double>& values) {
    auto list = toml_reals(values);
    list.front() = '{';
    list.back() = '}';
    return list;
}

/// Text without characters that could end the comment, begin one within it, or be a trigraph.
std::string comment_text(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const bool is_plain = static_cast<unsigned char>(c) >= 0x20 && static_cast<unsigned char>(c) < 0x7F;
        result += is_plain && c != '*' && c != '?' ? c : '.';
    }
    return result;
}

/// A line with the phases whose curve is a constant by decision, though the description has series; empty without one.
std::string note_of_means(const mechanical::MechanicalModel& model) {
    std::vector<std::string_view> names;
    for (const auto phase : flight::all_phases) {
        const auto& of = model.phases[phase];
        if (of.power.by == mechanical::PowerBasis::mean && of.fourier.cos_w.empty()) names.push_back(to_string(phase));
    }
    if (names.empty()) return "";
    return fmt::format(" * Of the flights' mean power, not of a series: {}.\n", fmt::join(names, ", "));
}

std::string heading(const mechanical::MechanicalModel& model, const std::string& prefix) {
    std::vector<std::string> flights;
    for (const auto& flight : model.flights) flights.push_back(comment_text(flight.flight));
    return fmt::format(
        "/* Electrical power of an aircraft over its flight: model {0}.\n"
        " * {1}\n"
        "{2}{5}"
        " * Written by flightwatt export " FLIGHTWATT_VERSION
        ". C99, needs <math.h> alone. Powers in W, energies in J, times in s\n"
        " * since the phase began, speeds in m/s, angles in rad. */\n"
        "#ifndef {3}_MODEL_H\n#define {3}_MODEL_H\n\n#include <math.h>\n\n"
        "enum {4}_phase {{ {3}_TAKEOFF, {3}_CRUISE, {3}_LANDING }};\n\n",
        comment_text(model.name), comment_text(model.description),
        flights.empty() ? "" : fmt::format(" * Flights: {}.\n", fmt::join(flights, ", ")),
        boost::algorithm::to_upper_copy(prefix), prefix, note_of_means(model));
}

/// One row a phase, filled up with zeros.
std::string rows(const mechanical::MechanicalModel& model, std::vector<double> mechanical::FourierModel::*member,
                 std::size_t order) {
    std::vector<std::string> lines;
    for (const auto phase : flight::all_phases) {
        auto values = model.phases[phase].fourier.*member;
        values.resize(order, 0.0);
        lines.push_back("        " + c_numbers(values));
    }
    return fmt::format("{{\n{}}}", fmt::join(lines, ",\n"));
}

template <typename Get>
std::string a_phase(const mechanical::MechanicalModel& model, const Get& get) {
    std::vector<double> values;
    values.reserve(flight::all_phases.size());
    for (const auto phase : flight::all_phases) values.push_back(get(model.phases[phase]));
    return c_numbers(values);
}

/// The constants, which each function holds for itself: a header's own would be unused in some files.
std::string constants(const mechanical::MechanicalModel& model, std::size_t order) {
    using mechanical::FourierModel;
    using mechanical::PhaseModel;
    return fmt::format(
        "    static const double omega_rad_per_s[3] = {};\n    static const double a0_w[3] = {};\n"
        "    static const double cos_w[3][{}] = {};\n    static const double sin_w[3][{}] = {};\n    int n;\n",
        a_phase(model, [](const PhaseModel& phase) { return phase.fourier.omega_rad_per_s; }),
        a_phase(model, [](const PhaseModel& phase) { return phase.fourier.a0_w; }), order,
        rows(model, &FourierModel::cos_w, order), order, rows(model, &FourierModel::sin_w, order));
}

std::string curve_functions(const mechanical::MechanicalModel& model, const std::string& prefix) {
    const auto order = std::max<std::size_t>(1, model_order(model));  // C has no arrays of length 0
    const auto values = constants(model, order);
    const auto durations = a_phase(model, [](const mechanical::PhaseModel& phase) { return phase.duration_s; });
    return fmt::format(
        "/* Duration of the phase in the model's flights. */\n"
        "static inline double {0}_duration_s(enum {0}_phase phase) {{\n"
        "    static const double duration_s[3] = {1};\n    return duration_s[phase];\n}}\n\n"
        "/* a0 + sum of a_n cos(n omega t) + b_n sin(n omega t). */\n"
        "static inline double {0}_power_w(enum {0}_phase phase, double time_s) {{\n{2}"
        "    double power_w = a0_w[phase];\n"
        "    for (n = 0; n < {3}; ++n) {{\n"
        "        const double angle_rad = (n + 1) * omega_rad_per_s[phase] * time_s;\n"
        "        power_w += cos_w[phase][n] * cos(angle_rad) + sin_w[phase][n] * sin(angle_rad);\n"
        "    }}\n    return power_w;\n}}\n\n"
        "/* The same scaled in time to a phase of flown_s, above 0. */\n"
        "static inline double {0}_flown_power_w(enum {0}_phase phase, double time_s, double flown_s) {{\n"
        "    return {0}_power_w(phase, time_s * {0}_duration_s(phase) / flown_s);\n}}\n\n"
        "/* The integral of the power from the start of the phase. */\n"
        "static inline double {0}_energy_j(enum {0}_phase phase, double time_s) {{\n{2}"
        "    double energy_j = a0_w[phase] * time_s;\n"
        "    for (n = 0; n < {3}; ++n) {{\n"
        "        const double rate = (n + 1) * omega_rad_per_s[phase];\n"
        "        const double half = sin(rate * time_s / 2.0); /* 1 - cos(x) = 2 sin^2(x/2) */\n"
        "        energy_j += (cos_w[phase][n] * sin(rate * time_s) + sin_w[phase][n] * 2.0 * half * half) / rate;\n"
        "    }}\n    return energy_j;\n}}\n\n",
        prefix, durations, values, order);
}

/// The induced power of its rotors, by Glauert.
std::string hover_term(const mechanical::PhysicalModel& physical) {
    if (!physical.load.rotors) return "0.0";
    const double hover_w = mechanical::induced_power_w(physical.load, 0.0);
    const double weight_n =
        (physical.load.rotors->mass_kg + physical.load.payload_kg) * units::standard_gravity_m_per_s2;
    const double velocity_square = std::pow(hover_w / weight_n, 2);
    return fmt::format("{} / sqrt(0.5 * airspeed * airspeed + sqrt(0.25 * pow(airspeed, 4.0) + {}))",
                       toml_real(physical.coefficients[mechanical::PowerTerm::hover] * weight_n * velocity_square),
                       toml_real(velocity_square * velocity_square));
}

std::string motion_function(const mechanical::PhysicalModel& physical, const std::string& prefix) {
    using mechanical::PowerTerm;
    const auto& c = physical.coefficients;
    return fmt::format(
        "/* Power of a motion through the air: airspeed above 0, climb rate (below 0: descending), load factor\n"
        " * 1 / cos(bank). Range: {1:.1f} to {2:.1f} m/s, climb {3:.1f} to {4:.1f} m/s; extrapolated outside. */\n"
        "static inline double {0}_motion_power_w(double airspeed, double climb, double load_factor) {{\n"
        "    const double power_w = {5} * airspeed * airspeed * airspeed + {6} / airspeed +\n"
        "                           {7} * (load_factor * load_factor - 1.0) / airspeed + {8} * climb +\n"
        "                           {9} * (climb < 0.0 ? climb : 0.0) + {10} + {11} * airspeed * airspeed +\n"
        "                           {12};\n"
        "    return power_w > 0.0 ? power_w : 0.0;\n}}\n\n",
        prefix, physical.airspeed_m_per_s.low, physical.airspeed_m_per_s.high, physical.climb_m_per_s.low,
        physical.climb_m_per_s.high, toml_real(c[PowerTerm::drag]), toml_real(c[PowerTerm::induced]),
        toml_real(c[PowerTerm::turn]), toml_real(c[PowerTerm::climb]), toml_real(c[PowerTerm::descent]),
        toml_real(c[PowerTerm::constant] + c[PowerTerm::payload] * physical.load.payload_kg),
        toml_real(c[PowerTerm::blade]), hover_term(physical));
}

}  // namespace

std::string to_json_text(const mechanical::MechanicalModel& model) { return json_text(to_toml(model)); }

std::string to_json_text(const battery::Battery& battery) { return json_text(to_toml(battery)); }

std::string c_prefix(const std::string& name) {
    auto prefix = boost::algorithm::to_lower_copy(name);
    std::ranges::replace_if(
        prefix, [](char c) { return !is_letter(c) && !(c >= '0' && c <= '9'); }, '_');
    if (prefix.empty() || !is_letter(prefix.front())) prefix = "model_" + prefix;
    return prefix;
}

std::string to_c_header(const mechanical::MechanicalModel& model) {
    const auto prefix = c_prefix(model.name);
    auto text = heading(model, prefix) + curve_functions(model, prefix);
    if (model.physical) text += motion_function(*model.physical, prefix);
    return text + fmt::format("#endif /* {}_MODEL_H */\n", boost::algorithm::to_upper_copy(prefix));
}

}  // namespace flightwatt::exchange

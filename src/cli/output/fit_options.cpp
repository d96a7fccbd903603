#include "cli/output/fit_options.h"

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"

#include <cstdint>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

/// "FLIGHT=0.4" or "FLIGHT:cruise=0.4".
mechanical::ManualWeight parse_hand_weight(const std::string& text) {
    const auto equals = text.rfind('=');
    const auto value = equals == std::string::npos ? std::nullopt : parse_number(text.substr(equals + 1));
    if (!value) throw UsageError(fmt::format("--weight {}: expected FLIGHT=NUMBER or FLIGHT:PHASE=NUMBER", text));
    mechanical::ManualWeight weight{text.substr(0, equals), std::nullopt, *value};
    if (const auto colon = weight.flight.rfind(':'); colon != std::string::npos) {
        weight.phase = flight::phase_from(weight.flight.substr(colon + 1));
        if (!weight.phase) {
            throw UsageError(fmt::format("--weight {}: no phase '{}', expected takeoff, cruise or landing", text,
                                         weight.flight.substr(colon + 1)));
        }
        weight.flight.resize(colon);
    }
    return weight;
}

}  // namespace

void add_fit_options(boost::program_options::options_description& options, AutoOrder automatic) {
    auto add = options.add_options();
    add("order", value("N")->default_value("3"),
        automatic == AutoOrder::accepted
            ? "order of the Fourier series, 0 to 8, or auto: chosen for each phase by how well it predicts "
              "a flight that was not fitted (blocks of time of a single flight)"
            : "order of the Fourier series, 0 to 8");
    add("weights", value("HOW")->default_value("agreement"), "uniform, inverse-variance or agreement");
    add("weight", value<std::vector<std::string>>("FLIGHT[:PHASE]=W")->composing(),
        "a weight by hand; then every flight needs one");
    add("min-periods", value<double>("X")->default_value(0.5, "0.5"),
        "least periods of the series in a phase; fewer make its basis collinear");
    add("max-periods", value<double>("X")->default_value(120.0, "120"),
        "most periods in a phase; the sampling may allow fewer");
}

std::optional<int> read_order(const StageCall& call, AutoOrder automatic) {
    const auto text = call.get<std::string>("order");
    if (text == "auto" && automatic == AutoOrder::accepted) return std::nullopt;
    const auto number = parse_unsigned(text);
    if (!number || *number > static_cast<std::uint64_t>(mechanical::max_order)) {
        throw UsageError(fmt::format("--order {}: expected 0 to {}{}", text, mechanical::max_order,
                                     automatic == AutoOrder::accepted ? " or auto"
                                     : text == "auto"                 ? "; 'flightwatt fit' can choose it"
                                                                      : ""));
    }
    return static_cast<int>(*number);
}

mechanical::ModelFitOptions read_fit_options(const StageCall& call, AutoOrder automatic) {
    mechanical::ModelFitOptions options;
    options.phases.order = read_order(call, automatic).value_or(options.phases.order);
    options.phases.min_theta_rad = units::rad_from_turns(call.get<double>("min-periods"));
    options.phases.max_periods = call.get<double>("max-periods");
    admissible_frequencies({}, options.phases);  // refuses bad options before any log is read
    const auto name = call.get<std::string>("weights");
    const auto weighting = mechanical::weighting_from(name);
    if (!weighting || *weighting == mechanical::Weighting::manual) {
        throw UsageError(fmt::format("--weights {}: expected uniform, inverse-variance or agreement{}", name,
                                     weighting ? "; give weights by hand with --weight" : ""));
    }
    options.weights.weighting = *weighting;
    if (const auto weights = call.get_optional<std::vector<std::string>>("weight")) {
        if (!call.options["weights"].defaulted())
            throw UsageError("--weights and --weight exclude each other: give one of them");
        options.weights.weighting = mechanical::Weighting::manual;
        for (const auto& text : *weights) options.weights.by_hand.push_back(parse_hand_weight(text));
    }
    return options;
}

}  // namespace flightwatt::cli

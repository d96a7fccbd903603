#include "cli/output/validation_output.h"

#include "base/units.h"
#include "cli/output/json_text.h"

#include <optional>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

/// A phase, or the whole flight.
struct ValidatedPart {
    std::string name;
    std::optional<flight::Phase> phase;
};

std::vector<ValidatedPart> validated_parts() {
    std::vector<ValidatedPart> parts;
    parts.reserve(std::size(flight::all_phases) + 1);
    for (const auto phase : flight::all_phases) parts.push_back({std::string(to_string(phase)), phase});
    parts.push_back({"total", std::nullopt});
    return parts;
}

std::string comparison(const std::string& part, const std::string& challenger, const mechanical::ModelScore& ours,
                       const std::string& baseline, const mechanical::ModelScore& theirs) {
    const bool better = ours.mean_absolute_error_wh < theirs.mean_absolute_error_wh;
    return fmt::format("{}: {} {} {}: {:.3f} Wh against {:.3f} Wh\n", part, challenger,
                       better ? "beats" : "does not beat", baseline, ours.mean_absolute_error_wh,
                       theirs.mean_absolute_error_wh);
}

/// Which covariates beat the constant mean in cruise, and which cannot be judged.
std::string verdicts_on(const std::vector<mechanical::Covariate>& covariates,
                        const std::vector<mechanical::ValidatedFlight>& flights) {
    std::string text;
    const auto mean = score_of(flights, "constant_mean", flight::Phase::cruise);
    for (const auto covariate : covariates) {
        const auto model = fmt::format("by_{}", to_string(covariate));
        const auto score = score_of(flights, model, flight::Phase::cruise);
        text += score && mean ? comparison("cruise", model, *score, "constant_mean", *mean)
                              : fmt::format("cruise: {} is not known of all flights\n", model);
    }
    if (!covariates.empty() && flights.size() <= 3) {
        text += "a line through 2 flights or fewer fits any covariate: what beats the mean here may be chance\n";
    }
    return text;
}

}  // namespace

TextTable flights_table(const std::vector<mechanical::ValidatedFlight>& flights) {
    TextTable table{{"flight", "phase", "model", "measured Wh", "counter Wh", "predicted Wh", "error Wh", "error %",
                     "95 % low", "95 % high"},
                    {}};
    for (const auto& flight : flights) {
        for (const auto& part : validated_parts()) {
            for (const auto& model : model_names(flights)) {
                const auto energy = predicted_energy(flight, model, part.phase);
                if (!energy) continue;
                const auto& [measured_wh, estimate] = *energy;
                const double error_wh = estimate.energy_wh - measured_wh;
                const auto interval = interval_95(estimate);
                table.rows.push_back({flight.flight, part.name, model, fixed(measured_wh, 3),
                                      fixed(part.phase ? flight.counter_wh[*part.phase] : std::nullopt, 3),
                                      fixed(estimate.energy_wh, 3), fmt::format("{:+.3f}", error_wh),
                                      part.phase == flight::Phase::landing
                                          ? "-"
                                          : fmt::format("{:+.1f}", units::percentage(error_wh, measured_wh)),
                                      interval ? fixed(interval->low_wh, 3) : "-",
                                      interval ? fixed(interval->high_wh, 3) : "-"});
            }
        }
    }
    return table;
}

TextTable scores_table(const std::vector<mechanical::ValidatedFlight>& flights) {
    TextTable table{
        {"phase", "model", "flights", "mean |error| Wh", "mean |error| %", "bias Wh", "95 % interval covers"}, {}};
    for (const auto& part : validated_parts()) {
        for (const auto& model : model_names(flights)) {
            const auto score = score_of(flights, model, part.phase);
            if (!score) continue;
            table.rows.push_back(
                {part.name, model, fmt::format("{}", score->flights), fixed(score->mean_absolute_error_wh, 3),
                 fixed(score->mean_absolute_error_percent, 1), fmt::format("{:+.3f}", score->bias_wh),
                 score->coverage_95 ? fmt::format("{:.0f} %", units::percentage(*score->coverage_95, 1.0)) : "-"});
        }
    }
    return table;
}

std::string verdict(const std::vector<mechanical::ValidatedFlight>& flights, const std::string& challenger,
                    const std::string& baseline) {
    std::string text;
    for (const auto& part : validated_parts()) {
        const auto ours = score_of(flights, challenger, part.phase);
        const auto theirs = score_of(flights, baseline, part.phase);
        if (!ours || !theirs) continue;
        if (ours->mean_absolute_error_wh == theirs->mean_absolute_error_wh) continue;
        text += comparison(part.name, challenger, *ours, baseline, *theirs);
    }
    return text;
}

std::string validation_text(const std::vector<mechanical::ValidatedFlight>& flights,
                            const std::vector<mechanical::Covariate>& covariates, bool in_flight,
                            const Screen& screen) {
    const ScreenTable shown{fmt::format("{} flights, each predicted by the others", flights.size()),
                            {"flight", "phase", "model", "error %", "measured Wh", "predicted Wh", "error Wh"}};
    auto text = screen_text(flights_table(flights), screen, shown) + "\n" +
                screen_text(scores_table(flights), screen, {"how well they predict", {}}) + "\n" +
                verdict(flights, "fourier", "constant_mean");
    if (in_flight) text += verdict(flights, "in_flight", "fourier");
    text += verdicts_on(covariates, flights);
    constexpr std::size_t few = 20;
    if (flights.size() < few) {
        text += fmt::format("coverage over {} flights means little: each counts for {:.0f} points\n", flights.size(),
                            units::percentage(1.0, static_cast<double>(flights.size())));
    }
    return text;
}

nlohmann::ordered_json scores_json(const std::vector<mechanical::ValidatedFlight>& flights) {
    using Json = nlohmann::ordered_json;
    Json json{{"flights", flights.size()}};
    for (const auto& part : validated_parts()) {
        json[part.name] = Json::object();
        for (const auto& model : model_names(flights)) {
            const auto score = score_of(flights, model, part.phase);
            if (!score) continue;
            json[part.name][model] = {
                {"mean_absolute_error_wh", score->mean_absolute_error_wh},
                {"mean_absolute_error_percent", optional_json(score->mean_absolute_error_percent)},
                {"bias_wh", score->bias_wh},
                {"coverage_95", optional_json(score->coverage_95)},
                {"flights", score->flights}};
        }
    }
    return json;
}

}  // namespace flightwatt::cli

#include "report/figures/validation_figure.h"

#include "mechanical/validation.h"

#include <optional>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

FigureData error_rows(std::span<const mechanical::ValidatedFlight> flights) {
    FigureData data({"error_wh", "measured_wh", "predicted_wh"}, {"model", "flight"});
    for (const auto& model : model_names(flights)) {
        for (const auto& flight : flights) {
            const auto energy = predicted_energy(flight, model, std::nullopt);
            if (!energy) continue;
            const double predicted_wh = energy->estimate.energy_wh;
            data.add({predicted_wh - energy->measured_wh, energy->measured_wh, predicted_wh},
                     {model, flight.flight});
        }
    }
    return data;
}

std::string described(std::span<const mechanical::ValidatedFlight> flights) {
    std::string text = fmt::format(
        "Error of the predicted energy of {} flights, each predicted by the others.", flights.size());
    for (const auto& model : model_names(flights)) {
        const auto score = score_of(flights, model, std::nullopt);
        if (!score) continue;
        text += fmt::format(" {}: {:.3f} Wh on average.", model, score->mean_absolute_error_wh);
    }
    return text;
}

}  // namespace

Figure validation_figure(std::span<const mechanical::ValidatedFlight> flights, const std::string& id) {
    Figure figure;
    figure.id = id;
    figure.caption =
        "Energy of the whole flight, predicted from its durations by the other flights, less measured. "
        "A ring is a flight.";
    figure.description = described(flights);
    const auto data = error_rows(flights);
    figure.spec = new_spec(figure);
    figure.spec["width"] = 560;
    figure.spec["height"] = {{"step", 30}};
    const VegaJson y = category("model", "", {{"sort", nullptr}});
    const VegaJson zero{{"data", {{"values", VegaJson::array({VegaJson::object()})}}},
                        {"mark", {{"type", "rule"}, {"style", "edge"}, {"aria", false}}},
                        {"encoding", {{"x", {{"datum", 0}}}}}};
    const VegaJson flights_layer{{"data", data.json()},
                                 {"mark", {{"type", "point"}, {"size", 55}, {"opacity", 0.85}}},
                                 {"encoding",
                                  {{"x", quantity("error_wh", "predicted less measured energy [Wh]")},
                                   {"y", y},
                                   {"color", category("model", "", {{"legend", nullptr}})},
                                   {"tooltip",
                                    {category("flight", "flight"), category("model", "model"),
                                     quantity("measured_wh", "measured [Wh]", {{"format", ".3f"}}),
                                     quantity("predicted_wh", "predicted [Wh]", {{"format", ".3f"}}),
                                     quantity("error_wh", "error [Wh]", {{"format", "+.3f"}})}}}}};
    figure.spec["layer"] = {zero, flights_layer};
    return figure;
}

}  // namespace flightwatt::report

#include "base/text.h"
#include "mechanical/validation.h"
#include "report/figures/flight_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr std::size_t curve_points = 101;
constexpr auto phase_time_title = "time since the phase began [s]";

enum PhaseCurve : std::size_t { model_curve, mean_band, flights_envelope, published_curve };

const VegaJson& curve_names() {
    static const VegaJson names{"model", "95 % band of the mean", "envelope of the flights", "published, Fig. 2"};
    return names;
}

double time_at(std::size_t i, double duration_s) {
    return duration_s * static_cast<double>(i) / static_cast<double>(curve_points - 1);
}

/// The color of a curve, and its place in the legend; `drawn` are the curves that the figure has.
VegaJson color_of(PhaseCurve curve, const VegaJson& drawn) {
    return {{"datum", curve_names()[curve]},
            {"type", "nominal"},
            {"title", ""},
            {"scale", {{"domain", curve_names()}, {"range", "curves"}}},
            {"legend", {{"values", drawn}, {"symbolType", "square"}, {"columns", 4}}}};
}

VegaJson power_axis(std::string_view field) {
    return numeric_channel(field, "power [W]", {{"scale", {{"zero", false}}}});
}

VegaJson area_layer(const std::vector<double>& time_s, const std::vector<double>& low_w,
                    const std::vector<double>& high_w, double opacity, const VegaJson& color) {
    FigureData data({"time_s", "low_w", "high_w"});
    for (std::size_t i = 0; i < time_s.size(); ++i) data.add({time_s[i], low_w[i], high_w[i]});
    auto area = layer(data.json(), R"({"type": "area", "opacity": 0, "clip": true, "aria": false})",
                      {{"x", numeric_channel("time_s", phase_time_title)},
                       {"y", power_axis("low_w")},
                       {"y2", {{"field", "high_w"}}},
                       {"color", color}});
    area["mark"]["opacity"] = opacity;
    return area;
}

VegaJson band_layers(const mechanical::CurveBand& band, const VegaJson& drawn) {
    auto layers = VegaJson::array();
    if (!band.flights_low_w.empty()) {
        layers.push_back(
            area_layer(band.time_s, band.flights_low_w, band.flights_high_w, 0.55, color_of(flights_envelope, drawn)));
    }
    if (!band.time_s.empty()) {
        layers.push_back(area_layer(band.time_s, band.low_95_w, band.high_95_w, 0.4, color_of(mean_band, drawn)));
    }
    return layers;
}

VegaJson model_layer(const mechanical::PhaseModel& phase, const VegaJson& drawn) {
    FigureData data({"time_s", "power_w"});
    for (std::size_t i = 0; i < curve_points; ++i) {
        const double time_s = time_at(i, phase.duration_s);
        data.add({time_s, power_w(phase.fourier, time_s)});
    }
    return layer(
        data.json(),
        R"({"type": "line", "strokeWidth": 2, "clip": true,
                     "point": {"opacity": 0, "size": 60, "aria": false}})",
        {{"x", numeric_channel("time_s", phase_time_title, {{"scale", {{"nice", false}}}})},
         {"y", power_axis("power_w")},
         {"color", color_of(model_curve, drawn)},
         {"tooltip", {tooltip_number("time_s", "time [s]", ".1f"), tooltip_number("power_w", "model [W]", ".2f")}}});
}

VegaJson published_layer(const PublishedCurve& curve, const VegaJson& drawn) {
    FigureData data({"time_s", "power_w"});
    for (std::size_t i = 0; i < curve.time_s.size(); ++i) data.add({curve.time_s[i], curve.value[i]});
    return layer(data.json(), R"({"type": "point", "size": 14, "strokeWidth": 1.2, "clip": true, "aria": false})",
                 {{"x", numeric_channel("time_s", phase_time_title)},
                  {"y", power_axis("power_w")},
                  {"color", color_of(published_curve, drawn)},
                  {"tooltip",
                   {tooltip_number("time_s", "time [s]", ".1f"), tooltip_number("power_w", "published [W]", ".2f")}}});
}

/// Root mean square of published less model, over the points within the phase.
double rms_w(const mechanical::PhaseModel& phase, const PublishedCurve& curve) {
    double squares = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < curve.time_s.size(); ++i) {
        if (curve.time_s[i] > phase.duration_s) continue;
        squares += std::pow(curve.value[i] - power_w(phase.fourier, curve.time_s[i]), 2);
        ++count;
    }
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(count, 1)));
}

std::string model_described(const mechanical::MechanicalModel& model) {
    std::string text = fmt::format("Mechanical power model {} over each phase.", model.name);
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        std::vector<double> curve_w;
        for (std::size_t i = 0; i < curve_points; ++i)
            curve_w.push_back(power_w(fitted.fourier, time_at(i, fitted.duration_s)));
        const auto [least, greatest] = std::ranges::minmax_element(curve_w);
        text += fmt::format(" {}: {:.1f} to {:.1f} W over {:.0f} s.", phase_word(phase), *least, *greatest,
                            fitted.duration_s);
    }
    return text;
}

std::string model_caption(const mechanical::MechanicalModel& model, const PublishedFigures& published) {
    std::string text = "Power of each phase (Eq. 1).";
    if (published.power[flight::Phase::cruise].time_s.empty()) return text;
    text += " Points: the paper's Fig. 2 (c-e), digitised; RMS difference";
    for (const auto phase : flight::all_phases) {
        text += fmt::format("{} {} {:.3f} W", phase == flight::Phase::takeoff ? "" : ",", phase_word(phase),
                            rms_w(model.phases[phase], published.power[phase]));
    }
    return text + ".";
}

FigureData error_rows(std::span<const mechanical::ValidatedFlight> flights) {
    FigureData data({"error_wh", "measured_wh", "predicted_wh"}, {"model", "flight"});
    for (const auto& model : model_names(flights)) {
        for (const auto& flight : flights) {
            const auto energy = predicted_energy(flight, model, std::nullopt);
            if (!energy) continue;
            const double predicted_wh = energy->estimate.energy_wh;
            data.add({predicted_wh - energy->measured_wh, energy->measured_wh, predicted_wh}, {model, flight.flight});
        }
    }
    return data;
}

std::string errors_described(std::span<const mechanical::ValidatedFlight> flights) {
    std::string text =
        fmt::format("Error of the predicted energy of {} flights, each predicted by the others.", flights.size());
    for (const auto& model : model_names(flights)) {
        const auto score = score_of(flights, model, std::nullopt);
        if (!score) continue;
        text += fmt::format(" {}: {:.3f} Wh on average.", model, score->mean_absolute_error_wh);
    }
    return text;
}

constexpr int points_of_line = 41;
constexpr auto airspeed_title = "airspeed [m/s]";
constexpr auto motion_power_title = "power [W]";

FigureData stretch_rows(std::span<const mechanical::BinnedFlight> flights) {
    FigureData data({"airspeed_m_per_s", "power_w", "climb_m_per_s", "start_s"}, {"flight"});
    for (const auto& flight : flights) {
        for (const auto& bin : flight.bins) {
            data.add({bin.airspeed_m_per_s, bin.power_w, bin.values[mechanical::PowerTerm::climb], bin.start_s},
                     {valid_utf8(flight.flight)});
        }
    }
    return data;
}

/// The climbs that are drawn: level, and half of what was flown to both sides.
std::vector<double> drawn_climbs(const mechanical::PhysicalModel& model) {
    std::vector<double> climbs{0.0};
    if (model.climb_m_per_s.low < 0.0) climbs.insert(climbs.begin(), 0.5 * model.climb_m_per_s.low);
    if (model.climb_m_per_s.high > 0.0) climbs.push_back(0.5 * model.climb_m_per_s.high);
    return climbs;
}

FigureData line_rows(const mechanical::PhysicalModel& model) {
    FigureData data({"airspeed_m_per_s", "power_w", "climb_m_per_s"}, {"line"});
    const auto& range = model.airspeed_m_per_s;
    for (const double climb : drawn_climbs(model)) {
        for (int i = 0; i < points_of_line; ++i) {
            const double airspeed = range.low + (range.high - range.low) * i / (points_of_line - 1);
            if (!(airspeed > 0.0)) continue;
            data.add({airspeed, power_w(model, {airspeed, climb}), climb}, {fmt::format("{:+.1f} m/s", climb)});
        }
    }
    return data;
}

std::string motion_described(const mechanical::PhysicalModel& model) {
    std::string text = fmt::format("Power over airspeed of {} stretches of {} flights, and the model.", model.bins,
                                   model.flights.size());
    for (const double climb : drawn_climbs(model)) {
        const auto& range = model.airspeed_m_per_s;
        text += fmt::format(" Climbing {:+.1f} m/s: {:.1f} W at {:.1f} m/s, {:.1f} W at {:.1f} m/s.", climb,
                            power_w(model, {std::max(range.low, 0.1), climb}), range.low,
                            power_w(model, {range.high, climb}), range.high);
    }
    return text;
}

VegaJson climb_color() {
    return numeric_channel(
        "climb_m_per_s", "climb [m/s]",
        {{"scale", {{"scheme", "blueorange"}, {"domainMid", 0}}}, {"legend", {{"orient", "right"}}}});
}

}  // namespace

Figure model_figure(const mechanical::MechanicalModel& model, const flight::PerPhase<mechanical::CurveBand>& bands,
                    const PublishedFigures& published, const std::string& id) {
    VegaJson drawn{curve_names()[model_curve]};
    const auto& cruise = bands[flight::Phase::cruise];
    if (!cruise.time_s.empty()) drawn.push_back(curve_names()[mean_band]);
    if (!cruise.flights_low_w.empty()) drawn.push_back(curve_names()[flights_envelope]);
    if (!published.power[flight::Phase::cruise].time_s.empty()) drawn.push_back(curve_names()[published_curve]);
    auto panels = VegaJson::array();
    for (const auto phase : flight::all_phases) {
        auto layers = band_layers(bands[phase], drawn);
        layers.push_back(model_layer(model.phases[phase], drawn));
        if (!published.power[phase].time_s.empty()) layers.push_back(published_layer(published.power[phase], drawn));
        layers.push_back(panel_name(phase_word(phase)));
        panels.push_back({{"width", 200}, {"height", 230}, {"layer", layers}});
    }
    auto figure = new_figure(id, model_caption(model, published), model_described(model));
    set_panels(figure, 3, 72, panels);
    return figure;
}

Figure validation_figure(std::span<const mechanical::ValidatedFlight> flights, const std::string& id) {
    auto figure =
        new_figure(id,
                   "Energy of the whole flight, predicted from its durations by the other flights, less measured. "
                   "A ring is a flight.",
                   errors_described(flights));
    figure.spec["width"] = 560;
    figure.spec["height"] = {{"step", 30}};
    figure.spec["layer"] = {layer(vega(R"({"values": [{}]})"), R"({"type": "rule", "style": "edge", "aria": false})",
                                  vega(R"({"x": {"datum": 0}})")),
                            layer(error_rows(flights).json(), R"({"type": "point", "size": 55, "opacity": 0.85})",
                                  {{"x", numeric_channel("error_wh", "predicted less measured [Wh]")},
                                   {"y", nominal_channel("model", "", {{"sort", nullptr}})},
                                   {"color", nominal_channel("model", "", {{"legend", nullptr}})},
                                   {"tooltip",
                                    {nominal_channel("flight", "flight"), nominal_channel("model", "model"),
                                     tooltip_number("measured_wh", "measured [Wh]", ".3f"),
                                     tooltip_number("predicted_wh", "predicted [Wh]", ".3f"),
                                     tooltip_number("error_wh", "error [Wh]", "+.3f")}}})};
    return figure;
}

Figure physical_figure(const mechanical::PhysicalModel& model, std::span<const mechanical::BinnedFlight> flights,
                       const std::string& id) {
    auto figure =
        new_figure(id,
                   "Power over airspeed. A ring is a stretch of a flight of about 30 s; lines are the model in "
                   "level flight, climbing and descending. The colour is the climb.",
                   motion_described(model));
    const auto x = numeric_channel("airspeed_m_per_s", airspeed_title, {{"scale", {{"zero", false}}}});
    const auto y = numeric_channel("power_w", motion_power_title);
    figure.spec["width"] = 560;
    figure.spec["height"] = 360;
    figure.spec["layer"] = {
        layer(stretch_rows(flights).json(), R"({"type": "point", "size": 40, "opacity": 0.8})",
              {{"x", x},
               {"y", y},
               {"color", climb_color()},
               {"tooltip",
                {nominal_channel("flight", "flight"), tooltip_number("start_s", "from [s]", ".0f"),
                 tooltip_number("airspeed_m_per_s", "airspeed [m/s]", ".2f"),
                 tooltip_number("climb_m_per_s", "climb [m/s]", "+.2f"),
                 tooltip_number("power_w", "measured [W]", ".2f")}}}),
        layer(line_rows(model).json(), R"({"type": "line", "strokeWidth": 2})",
              {{"x", x},
               {"y", y},
               {"color", climb_color()},
               {"detail", {{"field", "line"}, {"type", "nominal"}}},
               {"tooltip",
                {nominal_channel("line", "model, climbing"), tooltip_number("power_w", "power [W]", ".2f")}}})};
    return figure;
}

}  // namespace flightwatt::report

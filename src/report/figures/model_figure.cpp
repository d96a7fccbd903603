#include "report/figures/model_figure.h"

#include "report/sections/phase_words.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr std::size_t curve_points = 101;
constexpr auto phase_time_title = "time since the phase began [s]";
constexpr auto power_title = "power [W]";

const VegaJson& curve_names() {
    static const VegaJson names{"model", "95 % band of the mean", "envelope of the flights",
                                "published, Fig. 2"};
    return names;
}

double time_at(std::size_t i, double duration_s) {
    return duration_s * static_cast<double>(i) / static_cast<double>(curve_points - 1);
}

/// The color of a curve, and its place in the legend; `shown` are the curves that the figure has.
VegaJson color_of(std::size_t curve, const VegaJson& shown) {
    return {{"datum", curve_names()[curve]},
            {"type", "nominal"},
            {"title", ""},
            {"scale", {{"domain", curve_names()}, {"range", "curves"}}},
            {"legend", {{"values", shown}, {"symbolType", "square"}, {"columns", 4}}}};
}

VegaJson axis_of(std::string_view field) {
    return quantity(field, power_title, {{"scale", {{"zero", false}}}});
}

VegaJson area_layer(const FigureData& data, std::string_view low, std::string_view high, double opacity,
                    const VegaJson& color) {
    return {{"data", data.json()},
            {"mark", {{"type", "area"}, {"opacity", opacity}, {"clip", true}, {"aria", false}}},
            {"encoding",
             {{"x", quantity("time_s", phase_time_title)},
              {"y", axis_of(low)},
              {"y2", {{"field", high}}},
              {"color", color}}}};
}

VegaJson band_layers(const mechanical::CurveBand& band, const VegaJson& shown) {
    VegaJson layers = VegaJson::array();
    if (!band.flights_low_w.empty()) {
        FigureData envelope({"time_s", "low_w", "high_w"});
        for (std::size_t i = 0; i < band.time_s.size(); ++i) {
            envelope.add({band.time_s[i], band.flights_low_w[i], band.flights_high_w[i]});
        }
        layers.push_back(area_layer(envelope, "low_w", "high_w", 0.55, color_of(2, shown)));
    }
    if (!band.time_s.empty()) {
        FigureData mean({"time_s", "low_w", "high_w"});
        for (std::size_t i = 0; i < band.time_s.size(); ++i) {
            mean.add({band.time_s[i], band.low_95_w[i], band.high_95_w[i]});
        }
        layers.push_back(area_layer(mean, "low_w", "high_w", 0.4, color_of(1, shown)));
    }
    return layers;
}

VegaJson model_layer(const mechanical::PhaseModel& phase, const VegaJson& shown) {
    FigureData data({"time_s", "power_w"});
    for (std::size_t i = 0; i < curve_points; ++i) {
        const double time_s = time_at(i, phase.duration_s);
        data.add({time_s, power_w(phase.fourier, time_s)});
    }
    return {{"data", data.json()},
            {"mark",
             {{"type", "line"},
              {"strokeWidth", 2},
              {"clip", true},
              {"point", {{"opacity", 0}, {"size", 60}, {"aria", false}}}}},
            {"encoding",
             {{"x", quantity("time_s", phase_time_title, {{"scale", {{"nice", false}}}})},
              {"y", axis_of("power_w")},
              {"color", color_of(0, shown)},
              {"tooltip",
               {quantity("time_s", "time [s]", {{"format", ".1f"}}),
                quantity("power_w", "model [W]", {{"format", ".2f"}})}}}}};
}

VegaJson published_layer(const PublishedCurve& curve, const VegaJson& shown) {
    FigureData data({"time_s", "power_w"});
    for (std::size_t i = 0; i < curve.time_s.size(); ++i) data.add({curve.time_s[i], curve.value[i]});
    return {
        {"data", data.json()},
        {"mark", {{"type", "point"}, {"size", 14}, {"strokeWidth", 1.2}, {"clip", true}, {"aria", false}}},
        {"encoding",
         {{"x", quantity("time_s", phase_time_title)},
          {"y", axis_of("power_w")},
          {"color", color_of(3, shown)},
          {"tooltip",
           {quantity("time_s", "time [s]", {{"format", ".1f"}}),
            quantity("power_w", "published [W]", {{"format", ".2f"}})}}}}};
}

/// Root mean square of published less model, over the curve_points within the phase.
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

std::string described(const mechanical::MechanicalModel& model) {
    std::string text = fmt::format("Mechanical power model {} over each phase.", model.name);
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.phases[phase];
        double least = power_w(fitted.fourier, 0.0);
        double greatest = least;
        for (std::size_t i = 1; i < curve_points; ++i) {
            const double power = power_w(fitted.fourier, time_at(i, fitted.duration_s));
            least = std::min(least, power);
            greatest = std::max(greatest, power);
        }
        text += fmt::format(" {}: {:.1f} to {:.1f} W over {:.0f} s.", phase_word(phase), least, greatest,
                            fitted.duration_s);
    }
    return text;
}

std::string caption_of(const mechanical::MechanicalModel& model, const PublishedFigures& published) {
    std::string text = "Power of each phase (Eq. 1).";
    if (published.power[flight::Phase::cruise].time_s.empty()) return text;
    text += " Points: the paper's Fig. 2 (c-e), digitised; RMS difference";
    for (const auto phase : flight::all_phases) {
        text += fmt::format("{} {} {:.3f} W", phase == flight::Phase::takeoff ? "" : ",", phase_word(phase),
                            rms_w(model.phases[phase], published.power[phase]));
    }
    return text + ".";
}

}  // namespace

Figure model_figure(const mechanical::MechanicalModel& model,
                    const flight::PerPhase<mechanical::CurveBand>& bands, const PublishedFigures& published,
                    const std::string& id) {
    Figure figure;
    figure.id = id;
    figure.caption = caption_of(model, published);
    figure.description = described(model);
    VegaJson shown{curve_names()[0]};
    const auto& cruise = bands[flight::Phase::cruise];
    if (!cruise.time_s.empty()) shown.push_back(curve_names()[1]);
    if (!cruise.flights_low_w.empty()) shown.push_back(curve_names()[2]);
    if (!published.power[flight::Phase::cruise].time_s.empty()) shown.push_back(curve_names()[3]);
    VegaJson panels = VegaJson::array();
    for (const auto phase : flight::all_phases) {
        auto layers = band_layers(bands[phase], shown);
        layers.push_back(model_layer(model.phases[phase], shown));
        if (!published.power[phase].time_s.empty()) {
            layers.push_back(published_layer(published.power[phase], shown));
        }
        panels.push_back({{"title", phase_word(phase)}, {"width", 200}, {"height", 230}, {"layer", layers}});
    }
    figure.spec = new_spec(figure);
    figure.spec["columns"] = 3;
    figure.spec["bounds"] = "flush";  // panels of a row on one line, whatever their labels
    figure.spec["spacing"] = {{"column", 62}, {"row", 72}};
    figure.spec["concat"] = panels;
    return figure;
}

}  // namespace flightwatt::report

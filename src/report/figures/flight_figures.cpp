#include "report/figures/flight_figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr double max_event_distance_s = 60.0;

/// Evidence of an edge.
std::string describe_edge(const flight::PhaseEdge& edge) {
    auto text = fmt::format("altitude {:.1f} m", edge.altitude_m);
    if (edge.throttle_percent) text += fmt::format(", throttle {:.0f} %", *edge.throttle_percent);
    if (edge.takeoff_after_s && std::abs(*edge.takeoff_after_s) < max_event_distance_s) {
        text += fmt::format(", nearest TAKEOFF message {:.1f} s {}", std::abs(*edge.takeoff_after_s),
                            *edge.takeoff_after_s < 0.0 ? "before" : "after");
    }
    if (edge.mode) text += fmt::format(", mode {}", *edge.mode);
    if (edge.block) text += fmt::format(", block {}", *edge.block);
    return text + fmt::format("; known within {:.1f} s", edge.gap_s);
}

std::string edge_name(const flight::PhaseSpan& span, bool begin) {
    if (span.phase == flight::Phase::takeoff) return begin ? "lift-off" : "end of take-off";
    if (span.phase == flight::Phase::landing) return begin ? "start of landing" : "touchdown";
    return begin ? "start of cruise" : "end of cruise, start of landing";
}

/// Whether an incomplete phase ends with the log.
bool is_end_of_log(const flight::Track& clock, double time_s) {
    constexpr double near_s = 2.0;  // altitude and power have clocks of their own
    return time_s - clock.time_s.front() < near_s || clock.time_s.back() - time_s < near_s;
}

constexpr std::size_t power_columns = 250;
constexpr int decimals = 2;  // of times and values

/// A row for each phase.
FigureData phase_rows(const flight::FlightPhases& phases) {
    FigureData data({"start_s", "end_s"}, {"phase"});
    for (const auto& sortie : phases.sorties)
        for (const auto& span : sortie.phases) data.add({span.start.time_s, span.end.time_s}, {phase_word(span.phase)});
    return data;
}

FigureData edge_rows(const ReportFlight& flight) {
    FigureData data({"time_s"}, {"edge", "evidence"});
    for (const auto& edge : name_edges(flight)) data.add({edge.time_s}, {edge.name, edge.evidence});
    return data;
}

/// Measured power, and the model's curve of every phase of the flight.
FigureData power_rows(const ReportFlight& flight, const flight::Track& power,
                      const mechanical::MechanicalModel* model) {
    FigureData data({"time_s", "power_w"}, {"curve"});
    data.round_to({decimals, decimals});
    for (const auto i : downsample_m4(power.time_s, power.value, power_columns)) {
        data.add({power.time_s[i], power.value[i]}, {"measured"});
    }
    if (model == nullptr) return data;
    constexpr int points = 60;
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            if (!span.complete || span.duration_s() <= 0.0) continue;
            const auto curve =
                time_scaled_model(model->phases[span.phase], span.duration_s(), mechanical::PhaseTimeScaling::scaled);
            for (int i = 0; i <= points; ++i) {
                const double time_s = span.duration_s() * i / points;
                data.add({span.start.time_s + time_s, power_w(curve, time_s)}, {"model"});
            }
            data.add({span.end.time_s, std::nan("")}, {"model"});  // a gap between phases
        }
    }
    return data;
}

FigureData channel_rows(const std::vector<double>& time_s, const std::vector<double>& values,
                        const std::string& column) {
    FigureData data({"time_s", column});
    data.round_to({decimals, decimals});
    for (const auto i : downsample_m4(time_s, values, power_columns)) data.add({time_s[i], values[i]});
    return data;
}

std::string caption_of(bool has_model) {
    return fmt::format(
        "Phases are shaded and end at the dashed lines, which show their evidence under the pointer.{} Of "
        "many samples, the extremes of each pixel column are drawn.",
        has_model ? " The model is each phase's curve, scaled to the measured duration." : "");
}

}  // namespace

std::vector<NamedEdge> name_edges(const ReportFlight& flight) {
    std::vector<NamedEdge> edges;
    if (flight.phases.sorties.empty()) return edges;
    const auto& clock = flight.data.power_w.empty() ? flight.data.altitude_m : flight.data.power_w;
    for (const auto& sortie : flight.phases.sorties) {
        for (std::size_t i = 0; i < sortie.phases.size(); ++i) {
            const auto& span = sortie.phases[i];
            const bool continues = i > 0 && sortie.phases[i - 1].end.time_s == span.start.time_s;
            const auto add = [&](const flight::PhaseEdge& edge, bool begin) {
                const bool cut = !span.complete && is_end_of_log(clock, edge.time_s);
                edges.push_back({edge.time_s,
                                 cut ? (begin ? "the log begins" : "the log ends") : edge_name(span, begin),
                                 describe_edge(edge)});
            };
            if (!continues) add(span.start, true);
            add(span.end, false);
        }
    }
    return edges;
}

Figure flight_figure(const ReportFlight& flight, const mechanical::MechanicalModel* model, const std::string& id) {
    const auto& data = flight.data;
    const auto& time_s = data.power_w.time_s;
    const auto templates = figure_template("flight")["vconcat"];  // for other tracks, and for power
    auto panels = VegaJson::array();
    auto views = VegaJson::array();
    const auto add_panel = [&](VegaJson panel, VegaJson values) {
        views.push_back(fmt::format("panel_{}", views.size()));
        values["name"] = views.back();
        panels.push_back(fill_template(std::move(panel), values));
    };
    const auto add_track = [&](const flight::Track& track, std::string_view title, int height) {
        if (track.empty()) return;
        const auto& column = track.name;
        const auto rows = channel_rows(time_s, resample(track, time_s), column);
        add_panel(templates[0], {{"rows", rows.json()}, {"column", column}, {"title", title}, {"height", height}});
    };
    add_track(data.altitude_m, "altitude [m]", 110);
    add_track(data.throttle_percent, "throttle [%]", 80);
    add_panel(templates[1], {{"rows", power_rows(flight, data.power_w, model).json()}});
    auto figure =
        new_figure("flight", id, caption_of(model != nullptr),
                   fmt::format("Altitude, throttle and power of flight {} over time, with its phases.", flight.name),
                   {{"views", views},
                    {"power_view", views.back()},
                    {"phases", phase_rows(flight.phases).csv()},
                    {"edges", edge_rows(flight).csv()}});
    figure.spec["vconcat"] = panels;
    return figure;
}

}  // namespace flightwatt::report

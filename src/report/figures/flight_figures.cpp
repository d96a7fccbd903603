#include "report/figures/flight_figures.h"

#include "flight/edge_events.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <boost/geometry/algorithms/append.hpp>
#include <boost/geometry/algorithms/assign.hpp>
#include <boost/geometry/algorithms/expand.hpp>
#include <boost/geometry/algorithms/simplify.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/strategies/cartesian/distance_projected_point.hpp>
#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// Where a phase begins or ends, in words.
std::string explained(const flight::PhaseEdge& edge) {
    auto text = fmt::format("altitude {:.1f} m", edge.altitude_m);
    if (edge.throttle_percent) text += fmt::format(", throttle {:.0f} %", *edge.throttle_percent);
    if (edge.takeoff_after_s && std::abs(*edge.takeoff_after_s) < flight::max_event_distance_s) {
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

/// An incomplete phase begins or ends there because the log does.
bool is_end_of_log(const flight::Track& clock, double time_s) {
    constexpr double near_s = 2.0;  // altitude and power have clocks of their own
    return time_s - clock.time_s.front() < near_s || clock.time_s.back() - time_s < near_s;
}

/// What the autopilot says of the edge, if that was recorded.
std::string verdict_at(const ReportFlight& flight, double time_s) {
    constexpr double same_edge_s = 2e-3;  // edges are rounded to the millisecond
    for (const auto& verdict : flight.verdicts) {
        if (std::abs(verdict.time_s - time_s) < same_edge_s) return verdict.text;
    }
    return "-";
}

constexpr std::size_t power_columns = 250;
/// More than a panel's height in pixels, and than its width when it is zoomed fifty times.
constexpr double value_steps = 500.0;
constexpr double time_steps = 32000.0;

/// One row a phase: for the shading and its names.
FigureData phase_rows(const flight::FlightPhases& phases) {
    FigureData data({"start_s", "end_s", "middle_s"}, {"phase", "word"});
    for (const auto& sortie : phases.sorties) {
        for (const auto& span : sortie.phases) {
            data.add({span.start.time_s, span.end.time_s, std::midpoint(span.start.time_s, span.end.time_s)},
                     {to_string(span.phase), phase_word(span.phase)});
        }
    }
    return data;
}

FigureData edge_rows(const ReportFlight& flight) {
    FigureData data({"time_s"}, {"edge", "evidence", "verdict"});
    for (const auto& edge : edges_of(flight)) {
        data.add({edge.time_s}, {edge.name, edge.evidence, edge.verdict});
    }
    return data;
}

/// Measured power, and the model's curve of every phase of the flight.
FigureData power_rows(const ReportFlight& flight, const flight::Track& power,
                      const std::optional<mechanical::MechanicalModel>& model) {
    FigureData data({"time_s", "power_w"}, {"curve"});
    data.round_to({decimals_for(power.time_s, time_steps, 1), decimals_for(power.value, value_steps, 1)});
    for (const auto i : downsample_m4(power.time_s, power.value, power_columns)) {
        data.add({power.time_s[i], power.value[i]}, {"measured"});
    }
    if (!model) return data;
    constexpr int points = 60;
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            if (!span.complete || span.duration_s() <= 0.0) continue;
            const auto curve = time_scaled_model(model->phases[span.phase], span.duration_s(),
                                                 mechanical::PhaseTimeScaling::scaled);
            for (int i = 0; i <= points; ++i) {
                const double time_s = span.duration_s() * i / points;
                data.add({span.start.time_s + time_s, power_w(curve, time_s)}, {"model"});
            }
            data.add({span.end.time_s, std::nan("")}, {"model"});  // phases do not join
        }
    }
    return data;
}

FigureData channel_rows(const std::vector<double>& time_s, const std::vector<double>& values,
                        const std::string& column) {
    FigureData data({"time_s", column});
    data.round_to({decimals_for(time_s, time_steps, 1), decimals_for(values, value_steps, 1)});
    for (const auto i : downsample_m4(time_s, values, power_columns)) data.add({time_s[i], values[i]});
    return data;
}

std::string description_of(const ReportFlight& flight) {
    std::string text = fmt::format("Altitude, throttle and power of flight {} over time.", flight.name);
    const flight::PowerStatistics power(flight.series);
    std::size_t number = 0;
    for (const auto& sortie : flight.phases.sorties) {
        ++number;
        for (const auto& span : sortie.phases) {
            const auto statistics = power.between(span.start.time_s, span.end.time_s);
            text += fmt::format(" Sortie {}, {}: {:.0f} s from {:.1f} s on, {:.1f} W on average.", number,
                                phase_word(span.phase), span.duration_s(), span.start.time_s, statistics.mean_power_w);
        }
    }
    return text;
}

std::string caption_of(const flight::Track& power, bool has_model) {
    std::string text = "Phases are shaded and end at the dashed lines; those tell their evidence when pointed at.";
    if (has_model) text += " The model is each phase's curve, stretched to the time flown.";
    const auto samples = power.time_s.size();
    const auto drawn = downsample_m4(power.time_s, power.value, power_columns).size();
    if (drawn < samples) {
        text += fmt::format(" Drawn with {} of {} samples: the extremes of each column of the screen.", drawn, samples);
    }
    return text;
}

}  // namespace

std::vector<NamedEdge> edges_of(const ReportFlight& flight) {
    std::vector<NamedEdge> edges;
    if (flight.phases.sorties.empty()) return edges;
    auto clock = power_track(flight.series);
    if (clock.empty()) clock = select_track(flight.series, "altitude_m");
    for (const auto& sortie : flight.phases.sorties) {
        for (std::size_t i = 0; i < sortie.phases.size(); ++i) {
            const auto& span = sortie.phases[i];
            const bool continues = i > 0 && sortie.phases[i - 1].end.time_s == span.start.time_s;
            const auto add = [&](const flight::PhaseEdge& edge, bool begin) {
                const bool cut = !span.complete && is_end_of_log(clock, edge.time_s);
                edges.push_back({edge.time_s,
                                 cut ? (begin ? "the log begins" : "the log ends") : edge_name(span, begin),
                                 explained(edge), verdict_at(flight, edge.time_s)});
            };
            if (!continues) add(span.start, true);
            add(span.end, false);
        }
    }
    return edges;
}

Figure flight_figure(const ReportFlight& flight, const std::optional<mechanical::MechanicalModel>& model,
                     const std::string& id) {
    const flight::SelectedTracks tracks(flight.series);
    const auto& power = tracks["power_w"];
    const auto& time_s = power.time_s;
    const auto templates = figure_template("flight")["vconcat"];  // of other tracks, and of power
    auto panels = VegaJson::array();
    auto views = VegaJson::array();
    const auto add_panel = [&](VegaJson panel, VegaJson values) {
        if (!panels.empty()) panel["layer"].erase(2);  // only the first panel names the phases
        views.push_back(fmt::format("panel_{}", views.size()));
        values["name"] = views.back();
        panels.push_back(filled(std::move(panel), values));
    };
    const auto add_track = [&](const std::string& column, std::string_view title, int height) {
        const auto& track = tracks[column];
        if (track.empty()) return;
        const auto rows = channel_rows(time_s, resample(track, time_s), column);
        add_panel(templates[0], {{"rows", rows.json()}, {"column", column}, {"title", title}, {"height", height}});
    };
    add_track("altitude_m", "altitude [m]", 110);
    add_track("throttle_percent", "throttle [%]", 80);
    add_panel(templates[1], {{"rows", power_rows(flight, power, model).json()}});
    auto figure = new_figure("flight", id, caption_of(power, model.has_value()), description_of(flight),
                             {{"views", views},
                              {"power_view", views.back()},
                              {"phases", phase_rows(flight.phases).csv()},
                              {"edges", edge_rows(flight).csv()}});
    figure.spec["vconcat"] = panels;
    return figure;
}

Figure in_flight_figure(const std::string& name, const PredictedFlight& flight, const std::string& id) {
    FigureData data({"flown_s", "energy_wh", "low_wh", "high_wh", "measured_wh"});
    std::size_t held = 0;
    for (const auto& [flown_s, energy_wh, interval] : flight.moments) {
        data.add({flown_s, energy_wh, interval.low_wh, interval.high_wh, flight.measured_wh});
        if (interval.contains(flight.measured_wh)) ++held;
    }
    const auto& first = flight.moments.front();
    const auto& last = flight.moments.back();
    return new_figure(
        "in_flight", id,
        fmt::format(
            "What flightwatt predict would have said in every minute of the cruise, from what was flown until then "
            "and a model of the {} other flights; the durations of cruise and landing taken as known. Level line: "
            "measured. {} of {} intervals of 95 % hold it (neighbours share what they rest on).",
            flight.others, held, flight.moments.size()),
        fmt::format(
            "Predicted energy of flight {}: {:.2f} Wh after {:.0f} s, {:.2f} Wh after {:.0f} s; measured {:.2f} Wh.",
            name, first.energy_wh, first.flown_s, last.energy_wh, last.flown_s, flight.measured_wh),
        {{"moments", data.json()}});
}

namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;  ///< east, north, height
using Line = bg::model::linestring<Point>;

constexpr int side = 380;  // [px] of the panels

/// Where the aircraft was, on the clock of the power samples.
struct GroundTrack {
    std::vector<double> time_s;
    std::vector<double> east_m;
    std::vector<double> north_m;
    std::vector<double> height_m;  ///< above the ground at the first lift-off; 0 throughout if nobody knows
};

GroundTrack ground_track(const ReportFlight& flight) {
    const auto& series = flight.series;
    const auto time_s = power_track(series).time_s;
    const auto altitude = select_track(series, "altitude_m");
    GroundTrack track{time_s, sample_selected_track(series, "east_m", time_s),
                      sample_selected_track(series, "north_m", time_s), std::vector<double>(time_s.size(), 0.0)};
    if (altitude.empty() || flight.phases.sorties.empty()) return track;
    track.height_m = resample(altitude, time_s);
    const double ground_m = value_at(altitude, flight.phases.sorties.front().phases.front().start.time_s);
    for (auto& height_m : track.height_m) height_m -= ground_m;
    return track;
}

/// A square around the track.
struct Square {
    double east_m = 0.0;  ///< its middle
    double north_m = 0.0;
    double half_m = 1.0;
};

/// Around the flight alone: on the ground, before its first fix, an aircraft may seem to be anywhere.
Square square_around(const ReportFlight& flight, const GroundTrack& track) {
    bg::model::box<Point> box;
    bg::assign_inverse(box);
    for (const auto& sortie : flight.phases.sorties) {
        for (std::size_t i = 0; i < track.time_s.size(); ++i) {
            if (track.time_s[i] < sortie.phases.front().start.time_s ||
                track.time_s[i] > sortie.phases.back().end.time_s) {
                continue;
            }
            bg::expand(box, Point(track.east_m[i], track.north_m[i], 0.0));
        }
    }
    constexpr double margin = 1.05;
    const double wide_m = bg::get<0>(box.max_corner()) - bg::get<0>(box.min_corner());
    const double high_m = bg::get<1>(box.max_corner()) - bg::get<1>(box.min_corner());
    return {std::midpoint(bg::get<0>(box.min_corner()), bg::get<0>(box.max_corner())),
            std::midpoint(bg::get<1>(box.min_corner()), bg::get<1>(box.max_corner())),
            std::max(1.0, margin * std::max(wide_m, high_m) / 2.0)};
}

/// The track between two times in pieces: where power samples, whose clock it is on, are missing, nobody knows it.
std::vector<Line> pieces(const GroundTrack& track, double start_s, double end_s) {
    const double gap_s = flight::gap_threshold_s(track.time_s);
    std::vector<Line> lines;
    double last_s = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < track.time_s.size(); ++i) {
        if (track.time_s[i] < start_s || track.time_s[i] > end_s) continue;
        if (track.time_s[i] - last_s > gap_s) lines.emplace_back();
        bg::append(lines.back(), Point(track.east_m[i], track.north_m[i], track.height_m[i]));
        last_s = track.time_s[i];
    }
    return lines;
}

/// What of the tracks a screen can show: no point is further than the tolerance from what is kept.
FigureData track_rows(const ReportFlight& flight, const GroundTrack& track, double tolerance_m) {
    FigureData data({"east_m", "north_m", "height_m", "order", "piece"}, {"phase", "word"});
    constexpr double steps = 4.0;     // of the tolerance
    constexpr double colors = 256.0;  // that a screen has of a scale
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(tolerance_m / steps))));
    data.round_to({decimals, decimals, decimals_for(track.height_m, colors, 0), 0, 0});
    double piece = 0.0;
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            for (const auto& line : pieces(track, span.start.time_s, span.end.time_s)) {
                ++piece;
                Line simple;
                bg::simplify(line, simple, tolerance_m);
                double order = 0.0;
                for (const auto& point : simple) {
                    data.add({bg::get<0>(point), bg::get<1>(point), bg::get<2>(point), order++, piece},
                             {to_string(span.phase), phase_word(span.phase)});
                }
            }
        }
    }
    return data;
}

VegaJson around(double middle_m, double half_m) { return {middle_m - half_m, middle_m + half_m}; }

}  // namespace

std::optional<Figure> track_figure(const ReportFlight& flight, const std::string& id) {
    const auto track = ground_track(flight);
    if (track.east_m.empty() || track.north_m.empty()) return std::nullopt;
    const auto square = square_around(flight, track);
    const auto data = track_rows(flight, track, square.half_m / side);
    if (data.empty()) return std::nullopt;
    return new_figure(
        "track", id,
        "Ground track from above, coloured by phase and by height over the place of lift-off; broken where samples are "
        "missing.",
        fmt::format(
            "Ground track of flight {} coloured by phase and by height, within {:.0f} m from west to east and from "
            "south to north.",
            flight.name, 2.0 * square.half_m),
        {{"track", data.json()},
         {"east", around(square.east_m, square.half_m)},
         {"north", around(square.north_m, square.half_m)}});
}

}  // namespace flightwatt::report

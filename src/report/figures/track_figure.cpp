#include "flight/chosen_track.h"
#include "flight/phase_statistics.h"
#include "report/figures/flight_figures.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include <boost/geometry/algorithms/append.hpp>
#include <boost/geometry/algorithms/assign.hpp>
#include <boost/geometry/algorithms/expand.hpp>
#include <boost/geometry/algorithms/simplify.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/strategies/cartesian/distance_projected_point.hpp>
#include <fmt/format.h>

namespace flightwatt::report {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Line = bg::model::linestring<Point>;

constexpr int side = 380;  // [px]

/// Where the aircraft was, on the clock of the power samples.
struct GroundTrack {
    std::vector<double> time_s;
    std::vector<double> east_m;
    std::vector<double> north_m;
};

GroundTrack ground_track(const flight::FlightSeries& series) {
    const auto time_s = power_track(series).time_s;
    return {time_s, chosen_at(series, "east_m", time_s), chosen_at(series, "north_m", time_s)};
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
            bg::expand(box, Point(track.east_m[i], track.north_m[i]));
        }
    }
    constexpr double margin = 1.05;
    const double wide_m = box.max_corner().x() - box.min_corner().x();
    const double high_m = box.max_corner().y() - box.min_corner().y();
    return {std::midpoint(box.min_corner().x(), box.max_corner().x()),
            std::midpoint(box.min_corner().y(), box.max_corner().y()),
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
        bg::append(lines.back(), Point(track.east_m[i], track.north_m[i]));
        last_s = track.time_s[i];
    }
    return lines;
}

/// What of the tracks a screen can show: no point is further than the tolerance from what is kept.
FigureData track_rows(const ReportFlight& flight, const GroundTrack& track, double tolerance_m) {
    FigureData data({"east_m", "north_m", "order", "piece"}, {"phase", "word"});
    double piece = 0.0;
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            for (const auto& line : pieces(track, span.start.time_s, span.end.time_s)) {
                ++piece;
                Line simple;
                bg::simplify(line, simple, tolerance_m);
                double order = 0.0;
                for (const auto& point : simple) {
                    data.add({point.x(), point.y(), order++, piece}, {to_string(span.phase), phase_word(span.phase)});
                }
            }
        }
    }
    return data;
}

VegaJson encoding_of(const Square& square) {
    const auto axis = [&](std::string_view field, std::string_view title, double middle_m) {
        return quantity(
            field, title,
            {{"scale",
              {{"domain", {middle_m - square.half_m, middle_m + square.half_m}}, {"nice", false}, {"zero", false}}}});
    };
    const auto color = vega(R"({"scale": {"domain": ["take-off", "cruise", "landing"], "range": "phases"},
        "legend": {"symbolType": "stroke"}})");
    auto dash = color;
    dash["scale"]["range"] = vega("[[6, 2], [1, 0], [2, 2]]");
    return {{"x", axis("east_m", "east [m]", square.east_m)},
            {"y", axis("north_m", "north [m]", square.north_m)},
            {"order", {{"field", "order"}, {"type", "quantitative"}}},
            {"detail", {{"field", "piece"}}},
            {"color", category("word", "", color)},
            {"strokeDash", category("word", "", dash)},
            {"tooltip",
             {category("word", "phase"), shown("east_m", "east [m]", ".0f"), shown("north_m", "north [m]", ".0f")}}};
}

}  // namespace

std::optional<Figure> track_figure(const ReportFlight& flight, const std::string& id) {
    const auto track = ground_track(flight.series);
    if (track.east_m.empty() || track.north_m.empty()) return std::nullopt;
    const auto square = square_around(flight, track);
    const auto data = track_rows(flight, track, square.half_m / side);
    if (data.empty()) return std::nullopt;
    auto figure = new_figure(
        id, "Ground track from above, coloured by phase; broken where samples are missing.",
        fmt::format("Ground track of flight {} coloured by phase, within {:.0f} m from west to east and from south to "
                    "north.",
                    flight.name, 2.0 * square.half_m));
    figure.spec["data"] = data.json();
    figure.spec["width"] = side;
    figure.spec["height"] = side;
    figure.spec["mark"] = vega(R"({"type": "line", "strokeWidth": 1.5, "clip": true,
        "point": {"opacity": 0, "size": 50, "aria": false}})");
    figure.spec["encoding"] = encoding_of(square);
    return figure;
}

}  // namespace flightwatt::report

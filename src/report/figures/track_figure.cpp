#include "flight/phase_statistics.h"
#include "flight/selected_track.h"
#include "report/figures/flight_figures.h"

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

/// The length of 1, 2 or 5 times a power of ten that is nearest below a quarter of the square.
double scale_bar_m(const Square& square) {
    const double max_m = square.half_m / 2.0;
    const double decade_m = std::pow(10.0, std::floor(std::log10(max_m)));
    for (const double times : {5.0, 2.0}) {
        if (times * decade_m <= max_m) return times * decade_m;
    }
    return decade_m;
}

/// In the lower left corner.
VegaJson scale_bar(const Square& square, double length_m) {
    constexpr double margin = 0.05;
    const double start_m = square.east_m - square.half_m * (1.0 - 2.0 * margin);
    const double north_m = square.north_m - square.half_m * (1.0 - 2.0 * margin);
    return {{"values", {{{"east_m", start_m}, {"end_m", start_m + length_m}, {"north_m", north_m}}}}};
}

VegaJson around(double middle_m, double half_m) { return {middle_m - half_m, middle_m + half_m}; }

}  // namespace

std::optional<Figure> track_figure(const ReportFlight& flight, const std::string& id) {
    const auto track = ground_track(flight);
    if (track.east_m.empty() || track.north_m.empty()) return std::nullopt;
    const auto square = square_around(flight, track);
    const auto data = track_rows(flight, track, square.half_m / side);
    if (data.empty()) return std::nullopt;
    const double length_m = scale_bar_m(square);
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
         {"north", around(square.north_m, square.half_m)},
         {"scale_bar", scale_bar(square, length_m)},
         {"length", fmt::format("{:g} m", length_m)}});
}

}  // namespace flightwatt::report

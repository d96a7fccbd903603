#include "base/duration_text.h"
#include "base/units.h"
#include "flight/selected_track.h"
#include "report/sections/page_data.h"
#include "report/sections/sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

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
using Point = bg::model::d2::point_xy<double>;  ///< east, north [m]
using Line = bg::model::linestring<Point>;
using Box = bg::model::box<Point>;

constexpr std::size_t max_tracks = 40;
constexpr double tolerance_m = 2.0;  ///< of the drawn lines

struct Piece {
    flight::Phase phase = flight::Phase::cruise;
    Line line;
};

/// Positions of a flight.
struct Positions {
    std::vector<double> time_s;
    std::vector<double> east_m;
    std::vector<double> north_m;

    Point at(double moment_s) const {
        const auto after = std::ranges::lower_bound(time_s, moment_s);
        const auto i = static_cast<std::size_t>(std::min(after, time_s.end() - 1) - time_s.begin());
        return {east_m[i], north_m[i]};
    }
};

Positions positions_of(const flight::FlightSeries& series) {
    auto east = select_track(series, "east_m");
    auto north_m = sample_selected_track(series, "north_m", east.time_s);
    if (north_m.empty()) return {};
    return {std::move(east.time_s), std::move(east.value), std::move(north_m)};
}

/// The track of the phases, split at gaps of the samples.
std::vector<Piece> pieces_of(const ReportFlight& flight, const Positions& positions) {
    std::vector<Piece> pieces;
    const double gap_s = flight::gap_threshold_s(positions.time_s);
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            double last_s = -std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < positions.time_s.size(); ++i) {
                const double now_s = positions.time_s[i];
                if (now_s < span.start.time_s || now_s > span.end.time_s) continue;
                if (now_s - last_s > gap_s) pieces.push_back({span.phase, {}});
                bg::append(pieces.back().line, Point(positions.east_m[i], positions.north_m[i]));
                last_s = now_s;
            }
        }
    }
    return pieces;
}

VegaJson line_data(const Line& line, const Point& middle) {
    Line simple;
    bg::simplify(line, simple, tolerance_m);
    auto points = VegaJson::array();
    for (const auto& point : simple)
        points.push_back({rounded_json(point.x() - middle.x(), 0), rounded_json(point.y() - middle.y(), 0)});
    return points;
}

/// Charge left [%] at a time, by the battery's record of the flight; none without one.
std::optional<double> charge_percent(const ReportBattery* battery, const std::string& flight, double time_s) {
    if (battery == nullptr || !battery->identified) return std::nullopt;
    const auto& records = battery->records;
    const auto record = std::ranges::find(records, flight, &battery::DischargeRecord::flight);
    if (record == records.end() || record->time_s.empty()) return std::nullopt;
    const auto index = static_cast<std::size_t>(record - records.begin());
    const auto sample = std::min(std::ranges::lower_bound(record->time_s, time_s), record->time_s.end() - 1);
    const double drawn_ah = record->charge_ah[static_cast<std::size_t>(sample - record->time_s.begin())] +
                            battery->identified->flights[index].initial_depletion_ah;
    const double capacity_ah = battery->identified->battery.capacity_ah;
    return units::percentage(capacity_ah - drawn_ah, capacity_ah);
}

/// Every 5 minutes (or more, of long flights) from lift-off to touchdown.
VegaJson marks_of(const ReportFlight& flight, const Positions& positions, const Point& middle,
                  const ReportBattery* battery) {
    constexpr double max_marks = 8.0;
    const double start_s = flight.phases.sorties.front().phases.front().start.time_s;
    const double end_s = flight.phases.sorties.back().phases.back().end.time_s;
    const double step_min =
        5.0 * std::max(1.0, std::ceil((end_s - start_s) / units::seconds_per_minute / 5.0 / max_marks));
    auto marks = VegaJson::array();
    for (double minutes = step_min; start_s + minutes * units::seconds_per_minute < end_s; minutes += step_min) {
        const double time_s = start_s + minutes * units::seconds_per_minute;
        const auto point = positions.at(time_s);
        const auto charge = charge_percent(battery, flight.name, time_s);
        marks.push_back(
            {{"x", rounded_json(point.x() - middle.x(), 0)},
             {"y", rounded_json(point.y() - middle.y(), 0)},
             {"text", fmt::format("{:.0f} min{}", minutes, charge ? fmt::format(": {:.0f} %", *charge) : "")}});
    }
    return marks;
}

/// "22 min 52 s in block Standby", of the block flown longest.
std::string longest_block(const ReportFlight& flight) {
    const auto block = select_track(flight.series, "block");
    if (block.empty() || flight.phases.sorties.empty()) return "";
    const double start_s = flight.phases.sorties.front().phases.front().start.time_s;
    const double end_s = flight.phases.sorties.back().phases.back().end.time_s;
    std::map<int, double> time_s;
    for (std::size_t i = 0; i < block.time_s.size(); ++i) {
        const double next_s = i + 1 < block.time_s.size() ? block.time_s[i + 1] : end_s;
        const double flown_s = std::min(next_s, end_s) - std::max(block.time_s[i], start_s);
        if (flown_s > 0.0) time_s[static_cast<int>(block.value[i])] += flown_s;
    }
    if (time_s.empty()) return "";
    const auto& [number, longest_s] = *std::ranges::max_element(time_s, {}, [](const auto& one) { return one.second; });
    const auto name = flight.series.block_names.find(number);
    return fmt::format("{} in block {}{}", duration_text(std::round(longest_s)),
                       name == flight.series.block_names.end() ? fmt::format("{}", number) : name->second,
                       time_s.size() > 1 ? fmt::format(", of {} blocks", time_s.size()) : "");
}

/// Longitudes and latitudes as metres of the flight's own axes, by its position at one time; empty without one.
VegaJson outline_data(const std::vector<Outline>& outlines, const flight::FlightSeries& series,
                      const Positions& positions, const Point& middle) {
    auto lines = VegaJson::array();
    const auto longitude = sample_selected_track(series, "longitude_deg", positions.time_s);
    const auto latitude = sample_selected_track(series, "latitude_deg", positions.time_s);
    if (longitude.empty() || latitude.empty()) return lines;
    const auto at = positions.time_s.size() / 2;
    const double narrowing = std::cos(latitude[at] / units::degree_per_rad);
    for (const auto& outline : outlines) {
        auto line = VegaJson::array();
        for (const auto& [longitude_deg, latitude_deg] : outline)
            line.push_back(
                {rounded_json(positions.east_m[at] - middle.x() +
                                  (longitude_deg - longitude[at]) * narrowing * units::metre_per_degree,
                              0),
                 rounded_json(
                     positions.north_m[at] - middle.y() + (latitude_deg - latitude[at]) * units::metre_per_degree, 0)});
        lines.push_back(std::move(line));
    }
    return lines;
}

/// Data of one map, centred, with its half extent; null without positions.
VegaJson track_data(const ReportFlight& flight, const ReportBattery* battery, const std::vector<Outline>& outlines) {
    if (!flight.rejected.empty() || flight.phases.sorties.empty()) return {};
    const auto positions = positions_of(flight.series);
    if (positions.time_s.empty()) return {};
    const auto pieces = pieces_of(flight, positions);
    if (pieces.empty()) return {};
    Box box;
    bg::assign_inverse(box);
    for (const auto& piece : pieces)
        for (const auto& point : piece.line) bg::expand(box, point);
    const Point middle(std::midpoint(box.min_corner().x(), box.max_corner().x()),
                       std::midpoint(box.min_corner().y(), box.max_corner().y()));
    auto lines = VegaJson::array();
    for (const auto& [phase, line] : pieces)
        lines.push_back({{"phase", phase_word(phase)}, {"points", line_data(line, middle)}});
    return {{"title", flight_title(flight)},
            {"text", longest_block(flight)},
            {"half_m",
             rounded_json(std::max({1.0, box.max_corner().x() - middle.x(), box.max_corner().y() - middle.y()}), 0)},
            {"lines", lines},
            {"marks", marks_of(flight, positions, middle, battery)},
            {"outline", outline_data(outlines, flight.series, positions, middle)}};
}

}  // namespace

std::optional<Section> tracks_section(const BatchContent& batch, const ReportBattery* battery,
                                      const std::vector<Outline>& outlines) {
    auto tracks = VegaJson::array();
    std::size_t left_out = 0;
    std::string maps;
    for (const auto& flight : batch.flights) {
        if (tracks.size() == max_tracks) {
            ++left_out;
            continue;
        }
        auto data = track_data(flight, battery, outlines);
        if (data.is_null()) continue;
        maps += fmt::format(
            "<div class=\"card\"><h3>{}</h3>\n<p class=\"soft\">{}</p>\n<div class=\"drawn\" data-draw=\"track\" "
            "data-track=\"{}\"></div></div>\n",
            html_escaped(data["title"].get<std::string>()), html_escaped(data["text"].get<std::string>()),
            tracks.size());
        tracks.push_back(std::move(data));
    }
    if (tracks.empty()) return std::nullopt;
    Section section{"tracks", "Tracks"};
    const bool has_charge = battery != nullptr && battery->identified;
    section.html = fmt::format(
        "<p class=\"soft\"><b class=\"takeoff\">Take-off</b>, <b class=\"cruise\">cruise</b>, <b "
        "class=\"landing\">landing</b>. Dots: minutes since lift-off{}. All maps have the same scale.</p>\n",
        has_charge ? fmt::format(", and the charge left of {:.3g} Ah", battery->identified->battery.capacity_ah) : "");
    section.html += "<div class=\"maps\">\n" + maps + "</div>\n" + data_block("tracks", tracks);
    if (left_out > 0)
        section.html += paragraph(
            fmt::format("{} further flights are not drawn; flightwatt export writes their tracks.", left_out), "soft");
    return section;
}

}  // namespace flightwatt::report

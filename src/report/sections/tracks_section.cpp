#include "report/sections/tracks_section.h"

#include "base/text.h"
#include "base/units.h"
#include "report/sections/aircraft_panel.h"
#include "report/sections/page_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <boost/geometry/algorithms/append.hpp>
#include <boost/geometry/algorithms/simplify.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/strategies/cartesian/distance_projected_point.hpp>
#include <fmt/format.h>

namespace flightwatt::report {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;  ///< east, north [m]
using Line = bg::model::linestring<Point>;

constexpr std::size_t max_tracks = 40;
constexpr double tolerance_m = 2.0;  ///< of the drawn lines

VegaJson point_data(const Point& point) { return {rounded_json(point.x(), 0), rounded_json(point.y(), 0)}; }

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

Positions positions_of(const flight::FlightData& data) {
    auto north_m = resample(data.north_m, data.east_m.time_s);
    if (north_m.empty()) return {};
    return {data.east_m.time_s, data.east_m.value, std::move(north_m)};
}

/// The lines of the phases, split at gaps of the samples.
VegaJson lines_of(const ReportFlight& flight, const Positions& positions) {
    auto lines = VegaJson::array();
    const auto add = [&](flight::Phase phase, const Line& line) {
        if (line.empty()) return;
        Line simple;
        bg::simplify(line, simple, tolerance_m);
        auto points = VegaJson::array();
        for (const auto& point : simple) points.push_back(point_data(point));
        lines.push_back({{"phase", phase_word(phase)}, {"points", points}});
    };
    const double gap_s = flight::gap_threshold_s(positions.time_s);
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            Line line;
            double last_s = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < positions.time_s.size(); ++i) {
                const double now_s = positions.time_s[i];
                if (now_s < span.start.time_s || now_s > span.end.time_s) continue;
                if (now_s - last_s > gap_s) {
                    add(span.phase, line);
                    line.clear();
                }
                bg::append(line, Point(positions.east_m[i], positions.north_m[i]));
                last_s = now_s;
            }
            add(span.phase, line);
        }
    }
    return lines;
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
VegaJson marks_of(const ReportFlight& flight, const Positions& positions, const ReportBattery* battery) {
    constexpr double max_marks = 8.0;
    const double start_s = flight.phases.sorties.front().phases.front().start.time_s;
    const double end_s = flight.phases.sorties.back().phases.back().end.time_s;
    const double step_min =
        5.0 * std::max(1.0, std::ceil((end_s - start_s) / units::seconds_per_minute / 5.0 / max_marks));
    auto marks = VegaJson::array();
    for (double minutes = step_min; start_s + minutes * units::seconds_per_minute < end_s; minutes += step_min) {
        const double time_s = start_s + minutes * units::seconds_per_minute;
        const auto charge = charge_percent(battery, flight.name, time_s);
        marks.push_back(
            {{"point", point_data(positions.at(time_s))},
             {"text", fmt::format("{:.0f} min{}", minutes, charge ? fmt::format(": {:.0f} %", *charge) : "")}});
    }
    return marks;
}

/// "22 min 52 s in block Standby", of the block flown longest.
std::string longest_block(const ReportFlight& flight) {
    const auto& block = flight.data.block;
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
    const auto name = flight.data.block_names.find(number);
    return fmt::format("{} in block {}{}", duration_text(std::round(longest_s)),
                       name == flight.data.block_names.end() ? fmt::format("{}", number) : name->second,
                       time_s.size() > 1 ? fmt::format(", of {} blocks", time_s.size()) : "");
}

/// [east, north, longitude, latitude] at one time, by which outlines are placed; null without a longitude.
VegaJson place_of(const flight::FlightData& data, const Positions& positions) {
    const auto longitude_deg = resample(data.longitude_deg, positions.time_s);
    const auto latitude_deg = resample(data.latitude_deg, positions.time_s);
    if (longitude_deg.empty() || latitude_deg.empty()) return {};
    const auto at = positions.time_s.size() / 2;
    return {positions.east_m[at], positions.north_m[at], longitude_deg[at], latitude_deg[at]};
}

/// Data of one map; null without positions.
VegaJson track_data(const ReportFlight& flight, const ReportBattery* battery) {
    if (!flight.rejected.empty() || flight.phases.sorties.empty()) return {};
    const auto positions = positions_of(flight.data);
    if (positions.time_s.empty()) return {};
    auto lines = lines_of(flight, positions);
    if (lines.empty()) return {};
    return {{"title", flight_title(flight)},
            {"text", longest_block(flight)},
            {"lines", std::move(lines)},
            {"marks", marks_of(flight, positions, battery)},
            {"place", place_of(flight.data, positions)}};
}

}  // namespace

std::optional<Section> tracks_section(const BatchContent& batch, const ReportBattery* battery,
                                      const std::vector<Outline>& outlines) {
    auto tracks = VegaJson::array();
    std::size_t left_out = 0;
    for (const auto& flight : batch.flights) {
        if (tracks.size() == max_tracks)
            ++left_out;
        else if (auto data = track_data(flight, battery); !data.is_null())
            tracks.push_back(std::move(data));
    }
    if (tracks.empty()) return std::nullopt;
    const bool has_charge = battery != nullptr && battery->identified;
    Section section{"tracks", "Tracks"};
    section.html = fmt::format(
        "<p class=\"soft\"><b class=\"takeoff\">Take-off</b>, <b class=\"cruise\">cruise</b>, <b "
        "class=\"landing\">landing</b>. Dots: minutes since lift-off{}. All maps have the same scale.</p>\n"
        "<div class=\"maps\"></div>\n{}{}",
        has_charge ? fmt::format(", and the charge left of {:.3g} Ah", battery->identified->battery.capacity_ah) : "",
        data_block("tracks", tracks), data_block("outlines", outlines));
    if (left_out > 0)
        section.html += paragraph(
            fmt::format("{} further flights are not drawn; flightwatt export writes their tracks.", left_out), "soft");
    return section;
}

}  // namespace flightwatt::report

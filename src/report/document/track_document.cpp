#include "report/document/track_document.h"

#include "base/text.h"
#include "base/units.h"
#include "report/document/columns.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

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

constexpr double tolerance_m = 2.0;  ///< of the lines

/// Positions of a flight.
struct Positions {
    std::vector<double> time_s;
    std::vector<double> east_m;
    std::vector<double> north_m;
    std::vector<double> latitude_deg;  ///< empty: unknown
    std::vector<double> longitude_deg;
};

Positions positions_of(const flight::FlightData& data) {
    const auto& clock = data.east_m.empty() ? data.longitude_deg : data.east_m;
    Positions positions{clock.time_s, data.east_m.value, resample(data.north_m, clock.time_s),
                        resample(data.latitude_deg, clock.time_s), resample(data.longitude_deg, clock.time_s)};
    const auto& [time_s, east_m, north_m, latitude_deg, longitude_deg] = positions;
    if (latitude_deg.empty() || longitude_deg.empty()) positions.latitude_deg = positions.longitude_deg = {};
    if (!east_m.empty() && !north_m.empty()) return positions;
    if (latitude_deg.empty()) return {};
    positions.east_m.clear();
    positions.north_m.clear();
    const double shrink = std::cos(latitude_deg.front() * std::numbers::pi / 180.0);
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        positions.east_m.push_back((longitude_deg[i] - longitude_deg.front()) * units::metre_per_degree * shrink);
        positions.north_m.push_back((latitude_deg[i] - latitude_deg.front()) * units::metre_per_degree);
    }
    return positions;
}

/// The columns of a position and its time at these samples.
Json columns_at(const Positions& positions, const std::vector<std::size_t>& samples) {
    constexpr int degree_decimals = 6;
    const auto column = [&](const std::vector<double>& values, int decimals) -> Json {
        if (values.empty()) return nullptr;
        Json::array_t chosen;
        for (const auto i : samples) chosen.push_back(rounded_json(values[i], decimals));
        return chosen;
    };
    return {{"time_s", column(positions.time_s, 1)},
            {"east_m", column(positions.east_m, 1)},
            {"north_m", column(positions.north_m, 1)},
            {"latitude_deg", column(positions.latitude_deg, degree_decimals)},
            {"longitude_deg", column(positions.longitude_deg, degree_decimals)}};
}

/// The samples of a line from `first` to before `end` that are within the tolerance of all.
std::vector<std::size_t> simplified(const Positions& positions, std::size_t first, std::size_t end) {
    Line line;
    for (auto i = first; i < end; ++i) bg::append(line, Point(positions.east_m[i], positions.north_m[i]));
    Line simple;
    bg::simplify(line, simple, tolerance_m);
    std::vector<std::size_t> samples;
    for (const auto& point : simple) {
        const auto is_here = [&](std::size_t i) {
            return positions.east_m[i] == point.x() && positions.north_m[i] == point.y();
        };
        auto i = samples.empty() ? first : samples.back() + 1;
        while (i < end && !is_here(i)) ++i;
        if (i < end) samples.push_back(i);
    }
    return samples;
}

/// The lines of the phases, split at gaps of the samples.
Json lines_of(const ReportFlight& flight, const Positions& positions) {
    auto lines = Json::array();
    const auto& time_s = positions.time_s;
    const double gap_s = flight::gap_threshold_s(time_s);
    for (const auto& sortie : flight.phases.sorties) {
        for (const auto& span : sortie.phases) {
            auto i = flight::first_at_or_after(time_s, span.start.time_s);
            while (i < time_s.size() && time_s[i] <= span.end.time_s) {
                const auto first = i++;
                while (i < time_s.size() && time_s[i] <= span.end.time_s && time_s[i] - time_s[i - 1] <= gap_s) ++i;
                Json line{{"phase", to_string(span.phase)}};
                line.update(columns_at(positions, simplified(positions, first, i)));
                lines.push_back(std::move(line));
            }
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
Json marks_of(const ReportFlight& flight, const Positions& positions, const ReportBattery* battery) {
    constexpr double max_marks = 8.0;
    const double start_s = flight.phases.sorties.front().start_s();
    const double end_s = flight.phases.sorties.back().end_s();
    const double step_min =
        5.0 * std::max(1.0, std::ceil((end_s - start_s) / units::seconds_per_minute / 5.0 / max_marks));
    auto marks = Json::array();
    for (double minutes = step_min; start_s + minutes * units::seconds_per_minute < end_s; minutes += step_min) {
        const double time_s = start_s + minutes * units::seconds_per_minute;
        const auto charge = charge_percent(battery, flight.name, time_s);
        const auto after = std::min(std::ranges::lower_bound(positions.time_s, time_s), positions.time_s.end() - 1);
        Json mark{{"text", fmt::format("{:.0f} min{}", minutes, charge ? fmt::format(": {:.0f} %", *charge) : "")}};
        const auto columns = columns_at(positions, {static_cast<std::size_t>(after - positions.time_s.begin())});
        for (const auto& [key, column] : columns.items()) mark[key] = column.is_null() ? column : column.front();
        marks.push_back(std::move(mark));
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

}  // namespace

Json track_json(const ReportFlight& flight, const ReportBattery* battery) {
    if (flight.phases.sorties.empty()) return nullptr;
    const auto positions = positions_of(flight.data);
    if (positions.time_s.empty()) return nullptr;
    auto lines = lines_of(flight, positions);
    if (lines.empty()) return nullptr;
    return {
        {"text", longest_block(flight)}, {"lines", std::move(lines)}, {"marks", marks_of(flight, positions, battery)}};
}

}  // namespace flightwatt::report

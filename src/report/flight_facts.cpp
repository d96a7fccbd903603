#include "report/flight_facts.h"

#include "base/units.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <cmath>

#include <boost/geometry/algorithms/distance.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/strategies/geographic/distance.hpp>
#include <fmt/chrono.h>

namespace flightwatt::report {
namespace {

std::optional<double> start_clock_s(const ReportFlight& flight) {
    const auto& logged_s = flight.series.start_clock_s;
    if (logged_s && *logged_s > 0.0) return logged_s;
    const auto start = flight::start_in_name(flight.name);
    if (!start) return std::nullopt;
    return static_cast<double>(start->time_since_epoch().count());
}

std::string date_of(const std::optional<double>& clock_s) {
    return clock_s ? fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(static_cast<std::time_t>(*clock_s))) : "";
}

using Place = boost::geometry::model::point<double, 2, boost::geometry::cs::geographic<boost::geometry::degree>>;

/// Over ground between two times, from the track's metres or else its degrees; none where it has neither.
std::optional<double> flown_m(const flight::FlightSeries& series, double start_s, double end_s) {
    const bool in_metres = !select_track(series, "east_m").empty();
    const auto east = select_track(series, in_metres ? "east_m" : "longitude_deg");
    const auto north = sample_selected_track(series, in_metres ? "north_m" : "latitude_deg", east.time_s);
    if (north.empty()) return std::nullopt;
    double length_m = 0.0;
    for (std::size_t i = 1; i < east.time_s.size(); ++i) {
        if (east.time_s[i - 1] < start_s || east.time_s[i] > end_s) continue;
        length_m += in_metres ? std::hypot(east.value[i] - east.value[i - 1], north[i] - north[i - 1])
                              : boost::geometry::distance(Place(east.value[i - 1], north[i - 1]),
                                                          Place(east.value[i], north[i]));
    }
    return length_m;
}

std::optional<double> max_m(const flight::Track& altitude, double start_s, double end_s) {
    if (altitude.empty()) return std::nullopt;
    double max_m = value_at(altitude, start_s);
    for (std::size_t i = 0; i < altitude.time_s.size(); ++i) {
        if (altitude.time_s[i] >= start_s && altitude.time_s[i] <= end_s) max_m = std::max(max_m, altitude.value[i]);
    }
    return max_m - value_at(altitude, start_s);
}

/// All that were flown in one log.
struct Cruises {
    double energy_wh = 0.0;
    double duration_s = 0.0;
};

/// The sum where both are known.
void add(std::optional<double>& sum, const std::optional<double>& more) {
    if (!more) sum.reset();
    if (sum) *sum += *more;
}

}  // namespace

FlightSummary summarize_flight(const ReportFlight& flight, std::optional<std::size_t> sortie) {
    const auto& series = flight.series;
    const flight::PowerStatistics power(series);
    const auto altitude = select_track(series, "altitude_m");
    const auto airspeed = select_track(series, "airspeed_m_per_s");
    FlightSummary facts;
    facts.start_clock_s = start_clock_s(flight);
    facts.date = date_of(facts.start_clock_s);
    facts.distance_m = 0.0;
    if (!airspeed.empty()) facts.air_distance_m = 0.0;
    if (power.has_power()) facts.energy_wh = 0.0;
    Cruises cruises;
    for (std::size_t s = 0; s < flight.phases.sorties.size(); ++s) {
        if (sortie && s != *sortie) continue;
        const double start_s = flight.phases.sorties[s].phases.front().start.time_s;
        const double end_s = flight.phases.sorties[s].phases.back().end.time_s;
        facts.in_air_s += end_s - start_s;
        add(facts.distance_m, flown_m(series, start_s, end_s));
        if (const auto height_m = max_m(altitude, start_s, end_s))
            facts.height_m = std::max(*height_m, facts.height_m.value_or(*height_m));
        if (facts.air_distance_m)
            *facts.air_distance_m += flight::integrated(airspeed.time_s, airspeed.value, start_s, end_s);
        if (facts.energy_wh) *facts.energy_wh += power.between(start_s, end_s).energy_wh;
        for (const auto& span : flight.phases.sorties[s].phases) {
            if (span.phase != flight::Phase::cruise) continue;
            cruises.energy_wh += power.between(span.start.time_s, span.end.time_s).energy_wh;
            cruises.duration_s += span.duration_s();
        }
    }
    if (power.has_power() && cruises.duration_s > 0.0)
        facts.cruise_power_w = units::joule_from_wh(cruises.energy_wh) / cruises.duration_s;
    return facts;
}

}  // namespace flightwatt::report

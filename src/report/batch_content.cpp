#include "report/batch_content.h"

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "batch/batch_files.h"
#include "batch/batch_run.h"
#include "flight/flight_identity.h"
#include "flight/phase_statistics.h"
#include "flight/select.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <boost/geometry/algorithms/distance.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/strategies/geographic/distance.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>

namespace flightwatt::report {
namespace {

std::string date_of(const std::optional<double>& clock_s) {
    return clock_s ? fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(static_cast<std::time_t>(*clock_s))) : "";
}

using Position = boost::geometry::model::point<double, 2, boost::geometry::cs::geographic<boost::geometry::degree>>;

/// Distance over ground between two times, by positions in metres or degrees.
std::optional<double> flown_m(const flight::FlightData& data, double start_s, double end_s) {
    const bool in_metres = !data.east_m.empty();
    const auto& east = in_metres ? data.east_m : data.longitude_deg;
    const auto north = resample(in_metres ? data.north_m : data.latitude_deg, east.time_s);
    if (north.empty()) return std::nullopt;
    double length_m = 0.0;
    for (std::size_t i = 1; i < east.time_s.size(); ++i) {
        if (east.time_s[i - 1] < start_s || east.time_s[i] > end_s) continue;
        length_m += in_metres ? std::hypot(east.value[i] - east.value[i - 1], north[i] - north[i - 1])
                              : boost::geometry::distance(Position(east.value[i - 1], north[i - 1]),
                                                          Position(east.value[i], north[i]));
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

/// Sum, if both are known.
void add(std::optional<double>& sum, const std::optional<double>& more) {
    if (!more) sum.reset();
    if (sum) *sum += *more;
}

/// Leaves out what a VTOL only hovers, as the batch does: of each aircraft on its own.
void leave_out_hover(const std::set<std::string>& keep, BatchContent& content) {
    if (std::ranges::none_of(content.measured, &mechanical::MeasuredFlight::only_hovers)) return;
    const auto is_measured = [&](const ReportFlight& flight) {
        return std::ranges::any_of(content.measured, [&](const auto& measured) {
            return mechanical::is_sortie_of(measured.samples.flight, flight.name);
        });
    };
    std::vector<ReportFlight*> flown;
    std::vector<batch::FlightAircraft> aircraft;
    for (auto& flight : content.flights) {
        if (!is_measured(flight)) continue;
        flown.push_back(&flight);
        aircraft.push_back(flight.aircraft);
    }
    for (const auto& group : batch::group_aircraft(aircraft)) {
        std::vector<mechanical::MeasuredFlight> sorties;  // without samples
        for (const auto number : group.flights)
            for (const auto& measured : content.measured) {
                if (!mechanical::is_sortie_of(measured.samples.flight, flown[number]->name)) continue;
                auto& sortie = sorties.emplace_back();
                sortie.samples.flight = measured.samples.flight;
                sortie.only_hovers = measured.only_hovers;
            }
        for (const auto& exclusion : mechanical::exclude_hover(sorties, keep)) {
            std::erase_if(content.measured,
                          [&](const auto& measured) { return measured.samples.flight == exclusion.flight; });
            auto& flight = **std::ranges::find_if(
                flown, [&](const auto* of) { return mechanical::is_sortie_of(exclusion.flight, of->name); });
            flight.exclusions.push_back(to_string(exclusion));
            flight.is_fitted = is_measured(flight);
        }
    }
}

}  // namespace

std::string_view fitted_part(const ReportFlight& flight) {
    if (flight.exclusions.empty()) return "all";
    return flight.is_fitted && flight.unusable_power.empty() ? "in part" : "no";
}

BatchContent read_batch_content(const std::filesystem::path& out) {
    BatchContent content;
    content.fit = batch::read_batch_fit(out);
    const auto fit = content.fit.value_or(batch::BatchFit{});
    flight::LoadOptions load;
    load.excluded = fit.excluded;
    load.keep = fit.keep;
    for (auto& [record, series, phases, damage] : batch::read_stored_flights(out)) {
        if (fit.other_aircraft.contains(record.flight)) continue;
        const auto& rejected = damage.empty() ? reason_without_log(record) : damage;
        ReportFlight flight{record.flight, record.log, record.accepted ? "" : rejected};
        for (const auto& diagnostic : record.diagnostics)
            (diagnostic.severity == Severity::note ? flight.notes : flight.warnings).push_back(diagnostic.text);
        if (!damage.empty()) content.damaged.push_back(record.flight + ": " + damage);
        if (record.accepted) {
            flight.aircraft = aircraft_of(record);
            auto selection = batch::select_for_fit(record, load);
            const auto* copy = batch::original_of(record.flight, fit.copies);
            if (copy != nullptr) {
                selection.flights.clear();
                selection.exclusions.push_back({record.flight, std::nullopt, batch::duplicate_reason(*copy)});
            }
            for (const auto& exclusion : selection.exclusions) flight.exclusions.push_back(to_string(exclusion));
            std::move(selection.flights.begin(), selection.flights.end(), std::back_inserter(content.measured));
            flight.unusable_power = batch::exclusion_reason(record, load);
            if (copy != nullptr) flight.unusable_power = batch::duplicate_reason(*copy);
            flight.data = select_tracks(series);
            flight.phases = std::move(phases);
        }
        content.flights.push_back(std::move(flight));
    }
    leave_out_hover(fit.keep, content);
    std::ranges::stable_sort(content.flights, {}, [](const auto& flight) { return !flight.unusable_power.empty(); });
    for_each_in_parallel(content.flights.size(), [&](std::size_t i) {
        auto& flight = content.flights[i];
        if (flight.rejected.empty()) flight.facts = summarize_flight(flight);
    });
    return content;
}

std::vector<mechanical::MeasuredFlight> flights_with_power(const BatchContent& content) {
    auto flights = content.measured;
    for (const auto& logged : content.flights) {
        if (!logged.rejected.empty()) continue;
        for (auto& measured : mechanical::extract_flights(logged.data, logged.phases).flights) {
            const auto same = std::ranges::find_if(
                flights, [&](const auto& flight) { return flight.samples.flight == measured.samples.flight; });
            if (same != flights.end()) same->power = std::move(measured.power);
        }
    }
    return flights;
}

std::string aircraft_mix(const BatchContent& content) {
    if (content.fit) return "";
    std::vector<batch::FlightAircraft> flown;
    for (const auto& flight : content.flights)
        if (flight.rejected.empty() && flight.unusable_power.empty()) flown.push_back(flight.aircraft);
    const auto groups = batch::group_aircraft(flown);
    return groups.size() < 2 ? "" : list_aircraft(groups, flown);
}

FlightSummary summarize_flight(const ReportFlight& flight, std::optional<std::size_t> sortie) {
    const auto& data = flight.data;
    const flight::PowerStatistics power(data);
    const auto& airspeed = data.airspeed_m_per_s;
    FlightSummary facts;
    facts.start_clock_s = flight::start_clock_s(data.start_clock_s, flight.name);
    facts.date = date_of(facts.start_clock_s);
    facts.distance_m = 0.0;
    if (!airspeed.empty()) facts.air_distance_m = 0.0;
    if (power.has_power()) facts.energy_wh = facts.counter_wh = 0.0;
    flight::PerPhase<double> energy_wh;
    double cruise_m = 0.0;  // through the air
    for (std::size_t s = 0; s < flight.phases.sorties.size(); ++s) {
        if (sortie && s != *sortie) continue;
        const double start_s = flight.phases.sorties[s].phases.front().start.time_s;
        const double end_s = flight.phases.sorties[s].phases.back().end.time_s;
        facts.in_air_s += end_s - start_s;
        add(facts.distance_m, flown_m(data, start_s, end_s));
        if (const auto height_m = max_m(data.altitude_m, start_s, end_s))
            facts.height_m = std::max(*height_m, facts.height_m.value_or(*height_m));
        if (facts.air_distance_m)
            *facts.air_distance_m += flight::integrated(airspeed.time_s, airspeed.value, start_s, end_s);
        const auto whole = power.between(start_s, end_s);
        if (facts.energy_wh) *facts.energy_wh += whole.energy_wh;
        add(facts.counter_wh, whole.counter_energy_wh);
        for (const auto& span : flight.phases.sorties[s].phases) {
            energy_wh[span.phase] += power.between(span.start.time_s, span.end.time_s).energy_wh;
            facts.duration_s[span.phase] += span.duration_s();
            if (span.phase == flight::Phase::cruise && facts.air_distance_m)
                cruise_m += flight::integrated(airspeed.time_s, airspeed.value, span.start.time_s, span.end.time_s);
        }
    }
    for (const auto phase : flight::all_phases)
        if (power.has_power() && facts.duration_s[phase] > 0.0)
            facts.mean_power_w[phase] = units::joule_from_wh(energy_wh[phase]) / facts.duration_s[phase];
    if (cruise_m > 0.0) facts.cruise_airspeed_m_per_s = cruise_m / facts.duration_s[flight::Phase::cruise];
    return facts;
}

}  // namespace flightwatt::report

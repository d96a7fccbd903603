#include "base/error.h"
#include "base/units.h"
#include "flight/phase_statistics.h"
#include "live/prediction.h"
#include "mechanical/model_fit.h"
#include "mechanical/prediction.h"
#include "report/sections/sections.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr double moment_every_s = 60.0;

std::optional<mechanical::MechanicalModel> model_of_others(const BatchContent& content, const std::string& flight) {
    std::vector<mechanical::FlightSamples> others;
    for (const auto& measured : content.measured)
        if (measured.samples.flight != flight) others.push_back(measured.samples);
    try {
        auto model = fit_model(others, content.fit->options).model;
        for (const auto phase : {flight::Phase::cruise, flight::Phase::landing})
            if (!model.phases[phase].level_spread) return std::nullopt;
        return model;
    } catch (const NoResultError&) {
        return std::nullopt;
    }
}

/// Where the moment does not allow a prediction there is none.
std::optional<PredictedMoment> predict_at(const live::PredictionInput& basis, const flight::FlightSeries& series,
                                          double until_s) {
    try {
        const auto flown = mechanical::progress_at(truncate_series(series, until_s), until_s);
        live::Diagnostics remarks;
        const auto prediction = live::predict_energy(basis, flown, std::nullopt, remarks);
        return PredictedMoment{
            until_s - flown.lift_off_s,
            flown.energy_wh + prediction.remaining_energy.energy_wh,
            {flown.energy_wh + prediction.interval.low_wh, flown.energy_wh + prediction.interval.high_wh}};
    } catch (const NoResultError&) {
        return std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

PredictedFlight predicted(const ReportFlight& flight, live::PredictionInput basis) {
    const auto& phases = flight.phases.sorties.front().phases;
    const auto& cruise = *std::ranges::find(phases, flight::Phase::cruise, &flight::PhaseSpan::phase);
    basis.cruise_s = cruise.duration_s();
    basis.landing_s = phases.back().duration_s();
    PredictedFlight result;
    result.measured_wh = integrated_energy_wh(flight.series, phases.front().start.time_s, phases.back().end.time_s);
    const auto moments = static_cast<int>((cruise.duration_s() - 1.0) / moment_every_s);
    for (int minute = 1; minute <= moments; ++minute) {
        const auto moment = predict_at(basis, flight.series, cruise.start.time_s + moment_every_s * minute);
        if (moment) result.moments.push_back(*moment);
    }
    return result;
}

/// All three phases, once.
bool is_one_sortie(const ReportFlight& flight) {
    return flight.rejected.empty() && flight.unusable_power.empty() && flight.phases.sorties.size() == 1 &&
           flight.phases.sorties.front().phases.size() == flight::all_phases.size();
}

}  // namespace

std::map<std::string, PredictedFlight> predict_each_minute(const BatchContent& content, std::size_t max_flights) {
    std::map<std::string, PredictedFlight> flights;
    constexpr std::size_t min_flights = 3;
    if (!content.fit || content.measured.size() < min_flights || content.measured.size() > max_flights) return flights;
    for (const auto& flight : content.flights) {
        const auto is_this = [&](const auto& measured) { return measured.samples.flight == flight.name; };
        if (!is_one_sortie(flight) || std::ranges::none_of(content.measured, is_this)) continue;
        auto model = model_of_others(content, flight.name);
        if (!model) continue;
        live::PredictionInput basis;
        basis.model = std::move(*model);
        auto result = predicted(flight, std::move(basis));
        result.others = content.measured.size() - 1;
        if (!result.moments.empty()) flights.emplace(flight.name, std::move(result));
    }
    return flights;
}

TextTable predictions_table(const std::map<std::string, PredictedFlight>& flights) {
    TextTable table{{"flight", "measured [Wh]", "first minute [Wh]", "95 % [Wh]", "half way [Wh]", "95 % [Wh]",
                     "last minute [Wh]", "95 % [Wh]", "held [%]"},
                    {}};
    for (const auto& [name, flight] : flights) {
        const auto& moments = flight.moments;
        const auto held = std::ranges::count_if(moments, [measured_wh = flight.measured_wh](const auto& moment) {
            return moment.interval.contains(measured_wh);
        });
        std::vector<std::string> row{name, fixed(flight.measured_wh, 2)};
        for (const auto* moment : {&moments.front(), &moments[moments.size() / 2], &moments.back()}) {
            row.push_back(fixed(moment->energy_wh, 2));
            row.push_back(fmt::format("{:.2f} to {:.2f}", moment->interval.low_wh, moment->interval.high_wh));
        }
        row.push_back(fixed(units::percentage(static_cast<double>(held), static_cast<double>(moments.size())), 0));
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace flightwatt::report

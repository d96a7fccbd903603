#include "report/document/model_document.h"

#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "cli/output/physical_output.h"
#include "cli/output/prediction_output.h"
#include "mechanical/physical_fit.h"
#include "report/document/columns.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

/// The band ends at 0 W where the fit held the curve above it.
Json band_json(const mechanical::PhaseModel& phase, const std::vector<double>& time_s, std::vector<double> low_w,
               const std::vector<double>& high_w) {
    if (low_w.empty()) return nullptr;
    if (phase.not_negative)
        for (auto& low : low_w) low = std::max(low, 0.0);
    return {{"time_s", column_of(time_s)}, {"low_w", column_of(low_w)}, {"high_w", column_of(high_w)}};
}

Json curves_json(const ReportModel& model) {
    constexpr int intervals = 100;
    auto curves = Json::array();
    for (const auto phase : flight::all_phases) {
        const auto& fitted = model.model.phases[phase];
        std::vector<double> time_s;
        std::vector<double> power;
        for (int i = 0; i <= intervals; ++i) {
            time_s.push_back(fitted.duration_s * i / intervals);
            power.push_back(power_w(fitted.fourier, time_s.back()));
        }
        const auto& band = model.bands[phase];
        curves.push_back({{"phase", to_string(phase)},
                          {"time_s", column_of(time_s)},
                          {"power_w", column_of(power)},
                          {"band", band_json(fitted, band.time_s, band.low_95_w, band.high_95_w)},
                          {"flights", band_json(fitted, band.time_s, band.flights_low_w, band.flights_high_w)}});
    }
    return curves;
}

/// The name of a model for readers.
std::string words_of_model(const std::string& model) {
    static const std::map<std::string, std::string> words{{"constant_mean", "mean power"},
                                                          {"fourier", "Fourier series"},
                                                          {"by_phase", "chosen by phase"},
                                                          {"physical", "physical model"}};
    const auto found = words.find(model);
    return found == words.end() ? model : found->second;
}

Json errors_json(std::span<const mechanical::ValidatedFlight> flights) {
    auto errors = Json::array();
    for (const auto& model : model_names(flights)) {
        std::vector<std::string> names;
        std::vector<double> error_wh;
        std::vector<double> measured_wh;
        std::vector<double> predicted_wh;
        for (const auto& flight : flights) {
            const auto energy = predicted_energy(flight, model, std::nullopt);
            if (!energy) continue;
            names.push_back(flight.flight);
            measured_wh.push_back(energy->measured_wh);
            predicted_wh.push_back(energy->estimate.energy_wh);
            error_wh.push_back(predicted_wh.back() - measured_wh.back());
        }
        errors.push_back({{"title", words_of_model(model)},
                          {"flight", names},
                          {"error_wh", column_of(error_wh)},
                          {"measured_wh", column_of(measured_wh)},
                          {"predicted_wh", column_of(predicted_wh)}});
    }
    return errors;
}

/// The power of each bin as if it had been flown level and straight.
Json bins_json(const mechanical::PhysicalModel& model, std::span<const mechanical::BinnedFlight> flights) {
    using enum mechanical::PowerTerm;
    auto all = Json::array();
    for (const auto& flight : flights) {
        std::vector<double> start_s;
        std::vector<double> airspeed_m_per_s;
        std::vector<double> level_power_w;
        std::vector<double> climb_m_per_s;
        std::vector<double> power_w;
        for (const auto& bin : flight.bins) {
            start_s.push_back(bin.start_s);
            airspeed_m_per_s.push_back(bin.airspeed_m_per_s);
            climb_m_per_s.push_back(bin.values[climb]);
            power_w.push_back(bin.power_w);
            level_power_w.push_back(bin.power_w);
            for (const auto term : {climb, descent, turn})
                level_power_w.back() -= model.coefficients[term] * bin.values[term];
        }
        all.push_back({{"flight", flight.flight},
                       {"start_s", column_of(start_s)},
                       {"airspeed_m_per_s", column_of(airspeed_m_per_s)},
                       {"level_power_w", column_of(level_power_w)},
                       {"climb_m_per_s", column_of(climb_m_per_s)},
                       {"power_w", column_of(power_w)}});
    }
    return all;
}

/// Level flight between two airspeeds, with the 95 % band where it is known.
Json level_json(const mechanical::PhysicalModel& model, const Interval& range, bool flown) {
    constexpr int steps = 40;
    std::vector<double> airspeeds;
    std::vector<double> power_w;
    std::vector<double> low_w;
    std::vector<double> high_w;
    for (int i = 0; i <= steps; ++i) {
        const double airspeed = std::lerp(range.low, range.high, static_cast<double>(i) / steps);
        if (!(airspeed > 0.0)) continue;
        const auto terms = mechanical::term_values({airspeed}, model.load);
        const double reach_w = model.level_sd ? student_t_half_width(model.degrees_of_freedom) *
                                                    std::sqrt(coefficient_variance_w2(model, terms))
                                              : std::nan("");
        airspeeds.push_back(airspeed);
        power_w.push_back(sum_of_terms_w(model, terms));
        low_w.push_back(power_w.back() - reach_w);
        high_w.push_back(power_w.back() + reach_w);
    }
    return {{"airspeed_m_per_s", column_of(airspeeds)},
            {"power_w", column_of(power_w)},
            {"low_w", column_of(low_w)},
            {"high_w", column_of(high_w)},
            {"flown", flown}};
}

/// The best speeds; what is beyond the drawn airspeeds ends there.
Json best_json(const mechanical::SpeedToFly& speeds, const Interval& drawn) {
    auto all = Json::array();
    const auto inside = [&](double airspeed) { return std::clamp(airspeed, drawn.low, drawn.high); };
    for (const auto& best : speeds.best) {
        const double airspeed = best.airspeed_m_per_s.value_or(best.below_flown ? 0.0 : 2.0 * drawn.high);
        const double power_w = mechanical::power_w(speeds.model, {inside(airspeed)});
        all.push_back({{"purpose", best.purpose},
                       {"text", describe(best, speeds.model.airspeed_m_per_s)},
                       {"airspeed_m_per_s", airspeed == inside(airspeed) ? Json(airspeed) : Json()},
                       {"power_w", power_w},
                       {"low_m_per_s", inside(best.low_m_per_s.value_or(drawn.low))},
                       {"high_m_per_s", inside(best.high_m_per_s.value_or(drawn.high))}});
    }
    return all;
}

}  // namespace

Json model_json(const ReportModel& model) {
    const bool has_intervals = !model.bands[flight::Phase::cruise].time_s.empty();
    const auto text =
        fmt::format("Coefficients in W{}. xi is the angular frequency on a time axis of 28 units a phase.",
                    has_intervals ? ", with the 95 % intervals of the mean of these flights" : "");
    return {
        {"is_of_missions", model.is_of_missions},
        {"origin", model.origin},
        {"description", model.model.description},
        {"name", model.model.name},
        {"warnings", model_warnings(model.model)},
        {"notes", fit_notes(model.model)},
        {"curves", curves_json(model)},
        {"table_one",
         model.table_one ? printed_json(*model.table_one, "Coefficients of the model as the paper's Table I") : Json()},
        {"table_text", model.table_one ? text : ""}};
}

Json validation_json(const std::vector<mechanical::ValidatedFlight>& flights, bool synthetic, LatexTables& tables) {
    constexpr std::size_t few = 20;
    auto scores = cli::scores_table(flights);
    std::stable_partition(scores.rows.begin(), scores.rows.end(),
                          [](const auto& row) { return row.front() == "total"; });
    tables.add({std::move(scores), "Errors of the models on flights that they were not fitted to", "tab:validation"});
    return {
        {"text",
         "Leave-one-out: the model is fitted to all flights but one and predicts the energy of that one from its "
         "durations. Baselines: the mean power of each phase and, where airspeed was measured, power by airspeed and "
         "climb (physical)."},
        {"warning", synthetic ? "SYNTHETIC flights vary by their generator's model: these errors are not valid for "
                                "real flights."
                              : ""},
        {"note", flights.size() < few
                     ? fmt::format("Coverage of {} flights is coarse: each counts for {:.0f} percent.", flights.size(),
                                   units::percentage(1.0, static_cast<double>(flights.size())))
                     : ""},
        {"scores",
         record_json(cli::ValidationOutput{flights, std::min(flights.size(), mechanical::max_validation_folds)})},
        {"errors", errors_json(flights)}};
}

Json physical_json(std::span<const mechanical::MeasuredFlight> flights, LatexTables& tables) {
    std::vector<mechanical::BinnedFlight> binned;
    for (const auto& flight : flights)
        if (!flight.motion.bins.empty()) binned.push_back(flight.motion);
    mechanical::PhysicalFit fit;
    try {
        fit = mechanical::fit_physical_model(binned);
    } catch (const NoResultError&) {
        return nullptr;
    }
    tables.add({cli::constants_table(fit.model), "Constants of the physical model", "tab:physical"});
    tables.add({cli::trials_table(fit), "Terms that were tried, with their hold-out error", "tab:physical-terms"});
    constexpr double slower = 0.75;  // of the slowest airspeed flown
    const auto& flown = fit.model.airspeed_m_per_s;
    const Interval drawn{fit.speeds ? slower * flown.low : flown.low, flown.high};
    const auto& model = fit.speeds ? fit.speeds->model : fit.model;
    auto level = Json::array({level_json(model, flown, true)});
    if (fit.speeds) level.push_back(level_json(model, {drawn.low, flown.low}, false));
    return {{"fit", record_json(fit)},
            {"text",
             "Power as a sum of physical terms, fitted to the flights with airspeed and altitude, in bins of about "
             "30 s."},
            {"trials_text",
             fmt::format("Hold-out RMS error [W] of {}, without and with the term: a term is kept if it falls by 2.5 % "
                         "or more{}.",
                         fit.phases_decided ? "the mean power of phases" : "bins",
                         fit.phases_decided ? " and that of bins does not rise" : "")},
            {"speeds", fit.speeds ? cli::speed_lines(*fit.speeds) : std::vector<std::string>()},
            {"level", std::move(level)},
            {"bins", bins_json(fit.model, binned)},
            {"best", fit.speeds ? best_json(*fit.speeds, drawn) : Json::array()}};
}

}  // namespace flightwatt::report

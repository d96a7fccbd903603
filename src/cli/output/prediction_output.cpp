#include "cli/output/prediction_output.h"

#include "base/duration_text.h"
#include "base/units.h"
#include "cli/output/records.h"

#include <array>
#include <optional>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

using live::BatteryPrediction;

std::string landing_text(const battery::LandingForecast& forecast, const battery::LandingLimits& limits) {
    if (forecast.fails_after_s) {
        return fmt::format("the battery {} in {}", limits.cutoff_voltage_v > 0.0 ? "fails or is cut off" : "fails",
                           duration_text(*forecast.fails_after_s));
    }
    auto text = fmt::format("{:.1f} % and {:.2f} V at landing, ", forecast.soc_percent, forecast.voltage_v);
    if (!forecast.keeps_reserve)
        return text + fmt::format("short of the reserve of {:g} %", limits.reserve_soc_percent);
    text += fmt::format("{} of cruise left", duration_text(forecast.endurance_s));
    return limits.reserve_soc_percent > 0.0
               ? text + fmt::format(" to the reserve of {:g} %", limits.reserve_soc_percent)
               : text;
}

std::string battery_text(const std::optional<BatteryPrediction>& battery) {
    if (!battery) return "";
    return fmt::format(
        "battery    {:.1f} % now{}; {}\n"
        "           {}: {}\n",
        battery->expected.soc_now_percent,
        battery->initial_soc_is_current
            ? ""
            : fmt::format(", from {:.1f} % {}", battery->initial_soc_percent,
                          battery->initial_is_measured ? "by its voltage at rest" : "as given"),
        landing_text(battery->expected, battery->limits),
        battery->worst_uses_min_capacity ? "with the most energy and the least capacity of their 95 % intervals"
                                         : "at the high end of the energy's interval",
        landing_text(battery->worst, battery->limits));
}

/// Whether the model says what was to be expected so far: by motion only where the flight's was measured.
bool is_expected(const Prediction& prediction) {
    return !prediction.uses_physical_model || !prediction.flown.motion.bins.empty();
}

/// What was expected so far, and how the difference moves the rest.
std::string expectation_text(const Prediction& prediction) {
    if (!is_expected(prediction)) return "this flight's own level is not known";
    const double gain_percent = units::percentage(prediction.cruise.gain, 1.0);
    return fmt::format("expected {:.2f} W, ", prediction.cruise.expected_w) +
           (prediction.uses_physical_model ? fmt::format("this flight's own level {:+.1f} %", gain_percent)
                                           : fmt::format("of the difference {:.0f} % goes on", gain_percent));
}

Json json_of(const battery::LandingForecast& forecast) {
    return {{"soc_percent", forecast.soc_percent},
            {"voltage_v", forecast.voltage_v},
            {"seconds_left", forecast.endurance_s},
            {"keeps_reserve", forecast.keeps_reserve},
            {"fails_after_s", optional_json(forecast.fails_after_s)}};
}

/// The phases, and the whole flight.
constexpr std::array<std::optional<flight::Phase>, 4> validated_parts{flight::Phase::takeoff, flight::Phase::cruise,
                                                                      flight::Phase::landing, std::nullopt};

std::string name_of(const std::optional<flight::Phase>& part) { return part ? std::string(to_string(*part)) : "total"; }

/// Of each part and model.
Json score_records(const std::vector<mechanical::ValidatedFlight>& flights) {
    auto records = Json::array();
    for (const auto& part : validated_parts) {
        for (const auto& model : model_names(flights)) {
            const auto score = score_of(flights, model, part);
            if (!score) continue;
            const auto& coverage = score->coverage_95;
            records.push_back(
                {{"phase", name_of(part)},
                 {"model", model},
                 {"mean_absolute_error_wh", score->mean_absolute_error_wh},
                 {"mean_absolute_error_percent", optional_json(score->mean_absolute_error_percent)},
                 {"bias_wh", score->bias_wh},
                 {"coverage_95", optional_json(coverage)},
                 {"flights", score->flights},
                 {"coverage", coverage ? Json(fmt::format("{:.0f} %", units::percentage(*coverage, 1.0))) : Json()}});
        }
    }
    return records;
}

std::string comparison(const std::string& part, const std::string& challenger, const mechanical::ModelScore& ours,
                       const std::string& baseline, const mechanical::ModelScore& theirs) {
    const bool better = ours.mean_absolute_error_wh < theirs.mean_absolute_error_wh;
    return fmt::format("{}: {} {} {}: {:.3f} Wh against {:.3f} Wh\n", part, challenger,
                       better ? "beats" : "does not beat", baseline, ours.mean_absolute_error_wh,
                       theirs.mean_absolute_error_wh);
}

}  // namespace

std::string text_of(const Prediction& prediction) {
    const auto& [flown, began_in_air, on_path_s, is_sighted, remaining_s, by_motion, cruise, power_ahead, landing,
                 landing_s, rest, interval, battery] = prediction;
    return fmt::format(
               "flown      {:.3f} Wh from {} at {:.1f} s to {:.1f} s of the log ({})\n"
               "cruise     {:.3f} Wh in {} more: {:.2f} W; so far {:.2f} W, {}\n"
               "landing    {:.3f} Wh in {}, as in the model\n"
               "remaining  {:.3f} Wh, 95 % interval {:.3f} to {:.3f} Wh\n"
               "total      {:.3f} Wh\n",
               flown.energy_wh, began_in_air ? "the first message" : "lift-off", flown.lift_off_s, flown.until_s,
               duration_text(flown.until_s - flown.lift_off_s), cruise.energy.energy_wh, duration_text(remaining_s),
               cruise.remaining_mean_w, cruise.measured_w, expectation_text(prediction), landing.energy_wh,
               duration_text(landing_s), rest.energy_wh, interval.low_wh, interval.high_wh,
               flown.energy_wh + rest.energy_wh) +
           battery_text(battery);
}

Json json_of(const Prediction& prediction) {
    const auto& [flown, began_in_air, on_path_s, is_sighted, remaining_s, by_motion, cruise, power_ahead, landing,
                 landing_s, rest, interval, battery] = prediction;
    const auto expected_w = is_expected(prediction) ? std::optional(cruise.expected_w) : std::nullopt;
    const auto gain = is_expected(prediction) ? std::optional(cruise.gain) : std::nullopt;
    Json json{{"flown_energy_wh", flown.energy_wh},
              {"remaining_energy_wh", rest.energy_wh},
              {"interval_95_wh", {interval.low_wh, interval.high_wh}},
              {"total_energy_wh", flown.energy_wh + rest.energy_wh},
              {"lift_off_s", optional_json(began_in_air ? std::nullopt : std::optional(flown.lift_off_s))},
              {"until_s", flown.until_s},
              {"cruise",
               {{"remaining_s", remaining_s},
                {"energy_wh", cruise.energy.energy_wh},
                {"flown_mean_w", cruise.measured_w},
                {"expected_mean_w", optional_json(expected_w)},
                {"remaining_mean_w", cruise.remaining_mean_w},
                {by_motion ? "own_level" : "gain", optional_json(gain)}}},
              {"landing", {{"duration_s", landing_s}, {"energy_wh", landing.energy_wh}}}};
    if (on_path_s) json["cruise"]["path"] = {{"at_s", *on_path_s}, {"by_position", is_sighted}};
    if (battery) {
        json["battery"] = {{"initial_soc_percent", battery->initial_soc_percent},
                           {"soc_now_percent", battery->expected.soc_now_percent},
                           {"at_landing", json_of(battery->expected)},
                           {"at_landing_high_energy", json_of(battery->worst)}};
    }
    return json;
}

void warn_of(const StageCall& call, const live::Diagnostics& remarks) {
    for (const auto& warning : remarks.warnings) warn(call, warning);
    for (const auto& text : remarks.notes) note(call, text);
}

TextTable flights_table(const std::vector<mechanical::ValidatedFlight>& flights) {
    TextTable table{{"flight", "phase", "model", "measured Wh", "counter Wh", "predicted Wh", "error Wh", "error %",
                     "95 % low", "95 % high"},
                    {}};
    for (const auto& flight : flights) {
        for (const auto& part : validated_parts) {
            for (const auto& model : model_names(flights)) {
                const auto energy = predicted_energy(flight, model, part);
                if (!energy) continue;
                const auto& [measured_wh, estimate] = *energy;
                const double error_wh = estimate.energy_wh - measured_wh;
                const auto interval = interval_95(estimate);
                table.rows.push_back(
                    {flight.flight, name_of(part), model, fixed(measured_wh, 3),
                     fixed(part ? flight.counter_wh[*part] : std::nullopt, 3), fixed(estimate.energy_wh, 3),
                     fmt::format("{:+.3f}", error_wh),
                     part == flight::Phase::landing ? "-"
                                                    : fmt::format("{:+.1f}", units::percentage(error_wh, measured_wh)),
                     interval ? fixed(interval->low_wh, 3) : "-", interval ? fixed(interval->high_wh, 3) : "-"});
            }
        }
    }
    return table;
}

TextTable scores_table(const std::vector<mechanical::ValidatedFlight>& flights) {
    return table_of(score_records(flights), {"phase", "model", "flights", "mean_absolute_error_wh .3f: mean |error| Wh",
                                             "mean_absolute_error_percent .1f: mean |error| %", "bias_wh +.3f: bias Wh",
                                             "coverage: 95 % interval covers"});
}

std::string verdict(const std::vector<mechanical::ValidatedFlight>& flights, const std::string& challenger,
                    const std::string& baseline) {
    std::string text;
    for (const auto& part : validated_parts) {
        const auto ours = score_of(flights, challenger, part);
        const auto theirs = score_of(flights, baseline, part);
        if (!ours || !theirs) continue;
        if (ours->mean_absolute_error_wh == theirs->mean_absolute_error_wh) continue;
        text += comparison(name_of(part), challenger, *ours, baseline, *theirs);
    }
    return text;
}

std::string validation_text(const std::vector<mechanical::ValidatedFlight>& flights, bool in_flight,
                            const Screen& screen) {
    const ScreenTable shown{fmt::format("{} flights, each predicted by the others", flights.size()),
                            {"flight", "phase", "model", "error %", "measured Wh", "predicted Wh", "error Wh"}};
    auto text = screen_text(flights_table(flights), screen, shown) + "\n" +
                screen_text(scores_table(flights), screen, {"how well they predict", {}}) + "\n" +
                verdict(flights, "fourier", "constant_mean");
    if (in_flight) text += verdict(flights, "in_flight", "fourier");
    constexpr std::size_t few = 20;
    if (flights.size() < few) {
        text += fmt::format("coverage over {} flights means little: each counts for {:.0f} points\n", flights.size(),
                            units::percentage(1.0, static_cast<double>(flights.size())));
    }
    return text;
}

Json scores_json(const std::vector<mechanical::ValidatedFlight>& flights) {
    Json json{{"flights", flights.size()}};
    for (const auto& part : validated_parts) json[name_of(part)] = Json::object();
    for (auto record : score_records(flights)) {
        auto& entry = json[record["phase"].get<std::string>()][record["model"].get<std::string>()];
        for (const auto* not_of_json : {"phase", "model", "coverage"}) record.erase(not_of_json);
        entry = std::move(record);
    }
    return json;
}

}  // namespace flightwatt::cli

#include "cli/output/prediction_output.h"

#include "base/text.h"
#include "base/units.h"

#include <array>
#include <optional>
#include <tuple>

#include <fmt/format.h>

namespace flightwatt::battery {

Fields<LandingForecast> record_fields(const LandingForecast*) {
    using R = LandingForecast;
    return {field("soc_percent", &R::soc_percent, "at the end of the landing"),
            field("voltage_v", &R::voltage_v, "there, under the power of the landing"),
            field("endurance_s", &R::endurance_s, "further cruise until the reserve is reached"),
            field("keeps_reserve", &R::keeps_reserve, "lands with the mission's reserve"),
            field("fails_after_s", &R::fails_after_s, "from now until the battery fails; null: never")};
}

}  // namespace flightwatt::battery

namespace flightwatt::mechanical {

Fields<ModelScore> record_fields(const ModelScore*) {
    using R = ModelScore;
    return {field("flights", &R::flights, "flights that the model predicted", column{}),
            field("mean_absolute_error_wh", &R::mean_absolute_error_wh, "mean of |error|", column{"mean |error| Wh"}),
            field("mean_absolute_error_percent", &R::mean_absolute_error_percent, "of the measured energy",
                  column{"mean |error| %"}),
            field("mean_absolute_error_rest_percent", &R::mean_absolute_error_rest_percent,
                  "of the energy not flown yet; only of the whole"),
            field("bias_wh", &R::bias_wh, "mean of predicted less measured", column{"bias Wh", "+.3f"}),
            field("coverage_95", &R::coverage_95, "fraction of the flights within the 95 % interval",
                  column{"95 % interval covers", ".2f"})};
}

}  // namespace flightwatt::mechanical

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

std::string initial_text(const live::InitialCharge& initial) {
    if (!(initial.sd_percent > 0.0)) return "as given";
    return fmt::format("+-{:.0f} by its voltage at rest", normal_half_width() * initial.sd_percent);
}

/// What the lower forecast assumes.
std::string worst_text(const BatteryPrediction& battery) {
    const bool has_sd = battery.initial.sd_percent > 0.0;
    if (!has_sd && !battery.worst_uses_min_capacity) return "at the high end of the energy's interval";
    return fmt::format("with the most energy and the least {} of their 95 % intervals",
                       !has_sd                           ? "capacity"
                       : battery.worst_uses_min_capacity ? "capacity and charge"
                                                         : "charge");
}

std::string battery_text(const std::optional<BatteryPrediction>& battery) {
    if (!battery) return "";
    return fmt::format(
        "battery    {:.1f} % now{}; {}\n"
        "           {}: {}\n",
        battery->expected.soc_now_percent,
        battery->initial_soc_is_current
            ? ""
            : fmt::format(", from {:.1f} % {}", battery->initial.soc_percent, initial_text(battery->initial)),
        landing_text(battery->expected, battery->limits), worst_text(*battery),
        landing_text(battery->worst, battery->limits));
}

/// Whether the power so far is known from the model: of a physical one only with the flight's airspeed.
bool is_expected(const Prediction& prediction) {
    return !prediction.overtime_s && prediction.flown.cruise_s() > 0.0 &&
           (!prediction.uses_physical_model || !prediction.flown.motion.bins.empty());
}

std::string expectation_text(const Prediction& prediction) {
    if (!(prediction.flown.cruise_s() > 0.0)) return "not begun";
    return fmt::format("so far {:.2f} W, ", prediction.cruise.measured_w) +
           (is_expected(prediction) ? fmt::format("expected {:.2f} W", prediction.cruise.expected_w)
                                    : "no measured airspeed to compare with");
}

/// The phases, and the whole flight.
constexpr std::array<std::optional<flight::Phase>, 4> validated_parts{flight::Phase::takeoff, flight::Phase::cruise,
                                                                      flight::Phase::landing, std::nullopt};

std::string name_of(const std::optional<flight::Phase>& part) { return part ? std::string(to_string(*part)) : "total"; }

/// The score of a model in a phase or in total.
struct ScoreRow {
    std::string phase;
    std::string model;
    mechanical::ModelScore score;
};

Fields<ScoreRow> record_fields(const ScoreRow*) {
    using R = ScoreRow;
    return list_fields<R>(field("phase", &R::phase, "`takeoff`, `cruise`, `landing` or `total`", column{}),
                          field("model", &R::model, "name of the model", column{}), embedded(&R::score));
}

std::vector<ScoreRow> score_rows(const std::vector<mechanical::ValidatedFlight>& flights) {
    std::vector<ScoreRow> rows;
    for (const auto& part : validated_parts)
        for (const auto& model : model_names(flights))
            if (const auto score = score_of(flights, model, part)) rows.push_back({name_of(part), model, *score});
    return rows;
}

}  // namespace

std::string text_of(const Prediction& of) {
    const auto& [flown, cruise, landing, rest] = std::tie(of.flown, of.cruise, of.landing, of.remaining_energy);
    std::string cruise_text;
    if (!of.overtime_s)
        cruise_text = fmt::format("{:.3f} Wh in {} more: {:.2f} W; {}", cruise.energy.energy_wh,
                                  duration_text(of.remaining_s), cruise.remaining_mean_w, expectation_text(of));
    else if (of.remaining_s > 0.0)
        cruise_text = fmt::format("completed {} ago; way home {:.3f} Wh in {}", duration_text(*of.overtime_s),
                                  cruise.energy.energy_wh, duration_text(of.remaining_s));
    else
        cruise_text =
            fmt::format("completed {} ago; so far {:.2f} W", duration_text(*of.overtime_s), cruise.measured_w);
    const auto takeoff_text = of.takeoff_s > 0.0
                                  ? fmt::format("take-off   {:.3f} Wh in {} more, as the model's flights\n",
                                                of.takeoff.energy_wh, duration_text(of.takeoff_s))
                                  : std::string();
    return fmt::format(
               "flown      {:.3f} Wh from {} at {:.1f} s to {:.1f} s of the log ({})\n"
               "{}"
               "cruise     {}\n"
               "landing    {:.3f} Wh in {}{}\n"
               "remaining  {:.3f} Wh, 95 % interval {:.3f} to {:.3f} Wh\n"
               "total      {:.3f} Wh\n",
               flown.energy_wh, of.began_in_air ? "the first message" : "lift-off", flown.lift_off_s, flown.until_s,
               duration_text(flown.until_s - flown.lift_off_s), takeoff_text, cruise_text, landing.energy_wh,
               duration_text(of.landing_s),
               of.landing_sd_s > 0.0 ? fmt::format(" (1 sd: {})", duration_text(of.landing_sd_s)) : "", rest.energy_wh,
               of.interval.low, of.interval.high, flown.energy_wh + rest.energy_wh) +
           battery_text(of.battery);
}

void warn_of(const StageCall& call, const live::Remarks& remarks) {
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
                     interval ? fixed(interval->low, 3) : "-", interval ? fixed(interval->high, 3) : "-"});
            }
        }
    }
    return table;
}

TextTable scores_table(const std::vector<mechanical::ValidatedFlight>& flights) {
    return flightwatt::table_of(score_rows(flights));
}

std::string validation_text(const std::vector<mechanical::ValidatedFlight>& flights, const Screen& screen) {
    const ScreenTable shown{fmt::format("{} flights, each predicted by the others", flights.size()),
                            {"flight", "phase", "model", "error %", "measured Wh", "predicted Wh", "error Wh"}};
    auto text = screen_text(flights_table(flights), screen, shown) + "\n" +
                screen_text(scores_table(flights), screen, {"prediction errors", {}});
    constexpr std::size_t few = 20;
    if (flights.size() < few)
        text += fmt::format("\ncoverage of {} flights is uncertain: each counts for {:.0f} points\n", flights.size(),
                            units::percentage(1.0, static_cast<double>(flights.size())));
    return text;
}

Fields<ValidationOutput> record_fields(const ValidationOutput*) {
    using R = ValidationOutput;
    const auto of_part = [](const std::optional<flight::Phase>& part) {
        const auto scores = [part](const R& r) {
            Keyed<mechanical::ModelScore> all;
            for (const auto& model : model_names(r.flights))
                if (const auto score = score_of(r.flights, model, part)) all.emplace_back(model, *score);
            return all;
        };
        return field(name_of(part), scores, "scores by model");
    };
    return {field(
                "flights", [](const R& r) { return r.flights.size(); }, "number of flights"),
            of_part(flight::Phase::takeoff),
            of_part(flight::Phase::cruise),
            of_part(flight::Phase::landing),
            of_part(std::nullopt),
            field("folds", &R::folds, "groups of flights that were left out together")};
}

}  // namespace flightwatt::cli

namespace flightwatt::live {

Fields<BatteryPrediction> record_fields(const BatteryPrediction*) {
    using R = BatteryPrediction;
    return {field("initial_soc_percent", at(&R::initial, &InitialCharge::soc_percent), "at the beginning of the log"),
            field("initial_soc_sd_percent", at(&R::initial, &InitialCharge::sd_percent),
                  "its standard deviation; 0: not by the voltage at rest"),
            field("soc_now_percent", at(&R::expected, &battery::LandingForecast::soc_now_percent), "now"),
            field("at_landing", &R::expected, "as expected"),
            field("at_landing_high_energy", &R::worst,
                  "at the high end of the energy, and the low ends of capacity and initial charge")};
}

Fields<Prediction> record_fields(const Prediction*) {
    using R = Prediction;
    using Flown = decltype(R::flown);
    using Cruise = decltype(R::cruise);
    using Energy = mechanical::EnergyEstimate;
    const auto is_expected = [](const R& r) { return cli::is_expected(r); };
    const auto gain = [is_expected](bool physical) {
        return [=](const R& r) {
            return is_expected(r) && r.uses_physical_model == physical ? std::optional(r.cruise.gain) : std::nullopt;
        };
    };
    const auto expected_w = [=](const R& r) {
        return is_expected(r) ? std::optional(r.cruise.expected_w) : std::nullopt;
    };
    const auto lift_off_s = [](const R& r) {
        return r.began_in_air ? std::nullopt : std::optional(r.flown.lift_off_s);
    };
    const auto total = [](const R& r) { return r.flown.energy_wh + r.remaining_energy.energy_wh; };
    const auto flown_w = [](const R& r) {
        return r.flown.cruise_s() > 0.0 ? std::optional(r.cruise.measured_w) : std::nullopt;
    };
    const auto by_position = [](const R& r) { return r.on_path_s ? std::optional(r.is_from_position) : std::nullopt; };
    return {
        field("flown_energy_wh", at(&R::flown, &Flown::energy_wh), "measured so far"),
        field("remaining_energy_wh", at(&R::remaining_energy, &Energy::energy_wh), "predicted"),
        field("remaining_energy_wh_interval_95", &R::interval, "its prediction interval"),
        field("total_energy_wh", total, "measured and predicted"),
        field("lift_off_s", lift_off_s, "in the log's time; null: the record begins in the air"),
        field("until_s", at(&R::flown, &Flown::until_s), "time of the prediction, in the log's time"),
        object<R>("takeoff", "the rest of the take-off, until the height is held",
                  {field("remaining_s", &R::takeoff_s, "by the model's flights; 0: in cruise"),
                   field("energy_wh", at(&R::takeoff, &Energy::energy_wh), "of that time")}),
        object<R>("cruise", "the cruise",
                  {field("remaining_s", &R::remaining_s, "remaining time"),
                   field("overtime_s", &R::overtime_s, "beyond the mission's: lands now", optional_key{}),
                   field("energy_wh", at(&R::cruise, &Cruise::energy, &Energy::energy_wh), "of that time"),
                   field("flown_mean_w", flown_w, "measured so far; null: in take-off"),
                   field("expected_mean_w", expected_w, "by the model for the same time"),
                   field("remaining_mean_w", at(&R::cruise, &Cruise::remaining_mean_w), "predicted"),
                   field("gain", gain(false), "of the curve: fraction of the difference that is carried forward"),
                   field("own_level", gain(true), "of the physical model: relative deviation of this flight"),
                   field("path_at_s", &R::on_path_s, "position in the planned time of the path", optional_key{}),
                   field("path_by_position", by_position, "from position fixes; else from the time", optional_key{})}),
        object<R>("landing", "the landing",
                  {field("duration_s", &R::landing_s, "its duration"),
                   field("duration_sd_s", &R::landing_sd_s, "standard deviation of that; 0: stated"),
                   field("energy_wh", at(&R::landing, &Energy::energy_wh), "its energy")}),
        field("battery", &R::battery, "with `--battery`", optional_key{})};
}

}  // namespace flightwatt::live

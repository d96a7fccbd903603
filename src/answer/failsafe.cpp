#include "answer/failsafe.h"

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "battery/landing_forecast.h"
#include "mechanical/prediction.h"
#include "mechanical/speed_to_fly.h"
#include "mission/sampled_flights.h"
#include "path/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::answer {
namespace {

using mission::DrawnLoads;
using enum mission::Phase;

constexpr double full_percent = units::percent_per_whole;
constexpr std::uint64_t seed = 20;           // fixed: the same request has the same card
constexpr std::size_t drawn_flights = 2000;  // standard error of a chance of 5 %: 0.5 points
constexpr double whole_step = 1e-9;  // of a rounding up, for numbers that are whole but for the computer's error

double rounded_up(double value, double steps_per_unit = 1.0) {
    return std::ceil(value * steps_per_unit - whole_step) / steps_per_unit;
}

double settled_current_a(const battery::Battery& pack, double soc_percent, double power_w) {
    return limited_current_a(pack, power_w, {soc_percent, 0.0});
}

double loaded_voltage_v(const battery::Battery& pack, double soc_percent, double power_w) {
    const auto at = std::clamp(soc_percent, 0.0, full_percent);
    return terminal_voltage_v(pack, {at, 0.0}, settled_current_a(pack, at, power_w));
}

/// A drawn flight that is ready for forecasts.
struct Draw {
    DrawnLoads loads;
    battery::Battery settled_pack;
    double cruise_w = 0.0;
    double landing_w = 0.0;
};

/// The charge after loads from a charge in cruise; below 0 where the pack failed.
double soc_after(const Draw& draw, double soc_percent, std::span<const battery::ConstantLoad> ahead) {
    const auto& pack = draw.loads.battery;
    battery::BatteryState state{soc_percent, 0.0};
    if (pack.thevenin)
        state.rc_voltage_v =
            pack.thevenin->rc_resistance_ohm * settled_current_a(draw.settled_pack, soc_percent, draw.cruise_w);
    for (const auto& load : ahead) {
        const auto end = discharge_constant_load(pack, state, load, 0.0);
        if (end.failed_at_s()) return -1.0;
        state = end;
    }
    return state.soc_percent;
}

/// The loads of an action.
std::vector<battery::ConstantLoad> loads_of(const Draw& draw, bool is_return) {
    std::vector<battery::ConstantLoad> loads;
    if (is_return) loads.push_back({draw.cruise_w, draw.loads.duration_s[cruise]});
    if (draw.loads.duration_s[landing] > 0.0) loads.push_back({draw.landing_w, draw.loads.duration_s[landing]});
    return loads;
}

/// The least charge [%] that ends with `keep_percent`; above 100 where none does.
double needed_percent(const Draw& draw, bool is_return, double keep_percent) {
    constexpr double never = 1e3;
    constexpr int halvings = 16;  // to 0.002 points
    const auto loads = loads_of(draw, is_return);
    if (is_return && draw.loads.is_infeasible) return never;
    if (soc_after(draw, full_percent, loads) < keep_percent) return never;
    return last_true(full_percent, keep_percent, halvings,
                     [&](double percent) { return soc_after(draw, percent, loads) >= keep_percent; });
}

/// Draws of a mission, and what all of them share.
struct Fleet {
    mission::DrawnFlights drawn;
    std::vector<Draw> draws;
    bool chances_known = true;
    battery::Battery pack;  ///< as stated, settled
    double cruise_w = 0.0;  ///< of the mission
    double capacity_ah = 0.0;

    template <typename Holds>
    double share_of(const Holds& holds) const {
        double count = 0.0;
        for (std::size_t i = 0; i < draws.size(); ++i) count += holds(i) ? 1.0 : 0.0;
        return count / static_cast<double>(draws.size());
    }
    /// The chance that something holds; absent where it is unknown.
    template <typename Holds>
    std::optional<double> chance_of(const Holds& holds) const {
        return chances_known ? std::optional(share_of(holds)) : std::nullopt;
    }
    /// The true charge [%] of a draw when the count has used that much.
    double true_percent(std::size_t draw, double used_ah) const {
        return full_percent - units::percentage(used_ah, draws[draw].loads.battery.capacity_ah);
    }
};

VoltageThreshold voltage_threshold(const Fleet& fleet, double voltage_v, double used_ah,
                                   const std::vector<double>& needed_v) {
    constexpr double steps_per_v = 100.0;
    VoltageThreshold threshold{rounded_up(voltage_v, steps_per_v), {}, {}};
    const double early_ah = used_ah - units::amount_from_percent(fleet.capacity_ah, early_points);
    threshold.too_late = fleet.chance_of([&](std::size_t i) { return needed_v[i] > threshold.voltage_v; });
    threshold.too_early = fleet.chance_of([&](std::size_t i) {
        const auto& draw = fleet.draws[i];
        return early_ah > 0.0 && loaded_voltage_v(draw.settled_pack, fleet.true_percent(i, early_ah), draw.cruise_w) <
                                     threshold.voltage_v;
    });
    return threshold;
}

/// The threshold of an action, or none where the full pack does not suffice with that probability.
std::optional<FailsafeAction> make_action(const Fleet& fleet, bool is_return, double keep_percent, double probability) {
    constexpr double least_mah = 1.0;  // 0 switches failsafes off
    std::vector<double> needed;
    std::vector<double> usable_ah;  // when the action has to begin
    std::vector<double> needed_v;
    for (const auto& draw : fleet.draws) {
        needed.push_back(needed_percent(draw, is_return, keep_percent));
        usable_ah.push_back(units::amount_from_percent(draw.loads.battery.capacity_ah, full_percent - needed.back()));
        needed_v.push_back(needed.back() > full_percent
                               ? std::numeric_limits<double>::max()
                               : loaded_voltage_v(draw.settled_pack, needed.back(), draw.cruise_w));
    }
    const double usable = quantile_of(usable_ah, 1.0 - probability);
    const double capacity_mah = fleet.capacity_ah / units::milli;
    const double remaining_mah = rounded_up(std::max(least_mah, capacity_mah - usable / units::milli));
    if (remaining_mah > capacity_mah) return std::nullopt;
    FailsafeAction action;
    action.remaining_mah = static_cast<int>(std::lround(remaining_mah));
    action.used_mah = static_cast<int>(std::floor(capacity_mah - remaining_mah));
    action.soc_percent = static_cast<int>(std::lround(rounded_up(units::percentage(remaining_mah, capacity_mah))));
    const double used_ah = fleet.capacity_ah - remaining_mah * units::milli;
    const double soc_percent = units::percentage(remaining_mah, capacity_mah);
    action.current_a = settled_current_a(fleet.pack, soc_percent, fleet.cruise_w);
    action.too_late = fleet.chance_of([&](std::size_t i) { return usable_ah[i] < used_ah; });
    if (action.too_late) action.too_late_95 = share_of_new_flights_95(*action.too_late, fleet.drawn);
    if (!fleet.pack.thevenin) return action;
    action.voltage =
        voltage_threshold(fleet, loaded_voltage_v(fleet.pack, soc_percent, fleet.cruise_w), used_ah, needed_v);
    if (const double alone_v = quantile_of(needed_v, probability); alone_v < std::numeric_limits<double>::max() / 2.0)
        action.voltage_alone = voltage_threshold(fleet, alone_v, used_ah, needed_v);
    return action;
}

/// Why an action has no threshold: in how many of the drawn flights the full pack does not suffice `for_what`.
std::string shortfall(const Fleet& fleet, bool is_return, double keep_percent, const char* for_what) {
    const auto text = fmt::format("the full pack does not suffice {}", for_what);
    const double share = fleet.share_of(
        [&](std::size_t i) { return needed_percent(fleet.draws[i], is_return, keep_percent) > full_percent; });
    constexpr double nearly_all = 0.995;
    if (share >= nearly_all) return text;
    return fmt::format("in {:.2g} of 100 flights, drawn as uncertain as power and pack are known, {}",
                       units::percent_per_whole * share, text);
}

/// The way home, or why it is not known.
struct WayHome {
    std::optional<double> distance_m = {};
    path::PathElement leg = {};
    path::Wind wind = {};
    double airspeed_m_per_s = 0.0;
    double duration_s = 0.0;
    std::string missing = {};
};

WayHome way_home(const FailsafeRequest& request) {
    constexpr double least_m = 1.0;
    WayHome way;
    way.distance_m = request.home_distance_m ? request.home_distance_m : request.flown_distance_m;
    way.wind = request.wind;
    const double course_deg = request.home_course_deg.value_or(0.0);
    if (!request.home_course_deg) {
        way.wind.from_deg = course_deg;
        way.wind.direction_sd_deg = 0.0;  // no direction is worse
    }
    const auto& physical = request.model.physical;
    const double flown = physical ? physical->mean_airspeed_m_per_s : 0.0;
    const double usual = request.model.is_rotorcraft ? std::max(flown, least_return_m_per_s) : flown;
    way.leg.name = "the way home";
    way.leg.shape = path::Leg{std::max(way.distance_m.value_or(0.0), least_m), course_deg};
    way.leg.airspeed_m_per_s = request.airspeed_m_per_s.value_or(usual);
    way.leg.keeps_ground_speed = request.model.is_rotorcraft && !request.airspeed_m_per_s;
    if (!way.distance_m) {
        way.missing = "the distance to home is not known; a flight with GPS shows it, --home-distance states it";
        return way;
    }
    if (!(way.leg.airspeed_m_per_s > 0.0)) {
        way.missing = "the model has no airspeed; --airspeed states that of the way home";
        return way;
    }
    const auto home = compute_trajectory({{way.leg}}, way.wind, path::InfeasibleLegPolicy::crawl);
    way.airspeed_m_per_s = home.pieces.front().motion.airspeed_m_per_s;
    way.duration_s = home.duration_s;
    if (!home.infeasible_elements.empty())
        way.missing = fmt::format(
            "{:.1f} m/s of airspeed make no way home in a wind of {:.1f} m/s; --airspeed states a faster one",
            way.airspeed_m_per_s, way.wind.speed_m_per_s);
    else if (physical && !request.airspeed_m_per_s && way.airspeed_m_per_s > max_predicted_airspeed_m_per_s(*physical))
        way.missing =
            fmt::format("{:.1f} m/s of airspeed are beyond what its flights show; --airspeed states a slower way home",
                        way.airspeed_m_per_s);
    return way;
}

/// The flights' mean cruise power over a duration.
mechanical::ConstantPower measured_cruise(const mechanical::MechanicalModel& model, double duration_s) {
    const auto forecast = forecast_of(model, cruise);
    const auto& curve = model.phases[cruise];
    mechanical::ConstantPower power{mean_power_w(curve), std::nullopt, 0.0};
    if (!curve.level_spread) return power;
    const auto& spread = *curve.level_spread;
    const double between_w2 = std::pow(spread.between_flight_sd_w, 2) * (1.0 + forecast.weight_square_sum);
    const double drift_w2 = spread.drift_sd_w > 0.0 && spread.correlation_s > 0.0
                                ? mechanical::variance_of_mean_w2({spread.drift_sd_w, spread.correlation_s}, duration_s)
                                : 0.0;
    power.sd_w = std::sqrt(between_w2 + drift_w2);
    power.degrees_of_freedom = static_cast<double>(spread.flights - 1);
    if (between_w2 > 0.0) power.degrees_of_freedom *= std::pow((between_w2 + drift_w2) / between_w2, 2);
    return power;
}

/// A mission of the way home and the landing.
mission::MissionSetup return_mission(const FailsafeRequest& request, const WayHome& way) {
    mission::MissionSetup setup;
    setup.name = "return";
    setup.mechanical = request.model;
    setup.battery = request.battery;
    setup.duration_s[landing] = request.model.phases[landing].duration_s;
    if (way.missing.empty()) {
        auto model = request.model;
        if (model.physical) model.physical = mechanical::with_cost_of_airspeed(*std::move(model.physical));
        auto power = model.physical.value_or(mission::constant_cruise_power(model));
        if (model.physical) add_constant_power(power_beyond_straight_flight_w(model), power);
        set_cruise_path(setup, {{{way.leg}}, way.wind, std::move(power)});
        if (!model.physical) setup.cruise_level = measured_cruise(request.model, setup.duration_s[cruise]);
        return setup;
    }
    setup.duration_s[cruise] = request.model.phases[cruise].duration_s;
    setup.duration_is_stated[cruise] = true;
    setup.cruise_level = measured_cruise(request.model, setup.duration_s[cruise]);
    auto& curve = setup.mechanical->phases[cruise].fourier;
    curve.a0_w = setup.cruise_level->mean_w;
    curve.cos_w.clear();
    curve.sin_w.clear();
    return setup;
}

Fleet make_fleet(const FailsafeRequest& request, const WayHome& way) {
    auto setup = return_mission(request, way);
    Fleet fleet;
    fleet.drawn = draw_flights(setup, {drawn_flights, seed, 0});
    fleet.chances_known = fleet.drawn.variability_is_known;
    if (!fleet.chances_known) {
        for (const auto phase : {cruise, landing}) setup.uncertainty.level_sd_percent[phase] = assumed_level_sd_percent;
        setup.uncertainty.duration_sd_s[landing] = setup.duration_s[landing];
        fleet.drawn = draw_flights(setup, {drawn_flights, seed, 0});
    }
    for (const auto& loads : fleet.drawn.flights)
        fleet.draws.push_back({loads, settled(loads.battery), loads.power_w[cruise] + request.compute_w,
                               loads.power_w[landing] + request.compute_w});
    fleet.pack = settled(request.battery);
    fleet.capacity_ah = request.battery.capacity_ah;
    fleet.cruise_w =
        (setup.cruise_path ? mean_power_w(*setup.cruise_path) : setup.cruise_level->mean_w) + request.compute_w;
    return fleet;
}

/// Returns whether the critical action comes before the end of a return that began by the low action.
bool is_landed_short(const Fleet& fleet, std::size_t i, double used_ah, double critical_used_ah) {
    const auto& draw = fleet.draws[i];
    if (draw.loads.is_infeasible) return true;
    const std::array way{battery::ConstantLoad{draw.cruise_w, draw.loads.duration_s[cruise]}};
    const double start = fleet.true_percent(i, used_ah);
    return start <= 0.0 || soc_after(draw, start, way) < fleet.true_percent(i, critical_used_ah);
}

std::string wind_text(const FailsafeRequest& request, const path::Wind& wind) {
    if (wind.speed_m_per_s == 0.0 && wind.speed_sd_m_per_s == 0.0) return "calm, as no other is stated";
    auto text = fmt::format("{:g} m/s", wind.speed_m_per_s);
    if (wind.speed_sd_m_per_s > 0.0)
        text += fmt::format(" with a standard deviation of {:g} m/s", wind.speed_sd_m_per_s);
    if (request.wind_is_of_mission) text += ", as the mission states,";
    text += request.home_course_deg ? fmt::format(" from {:g} degrees", wind.from_deg) : " from ahead, the worst,";
    return text + " all the way home";
}

std::vector<GroundedPart> grounds_of(const FailsafeRequest& request, const WayHome& way, const Fleet& fleet,
                                     double reserve_percent) {
    std::vector<GroundedPart> grounds;
    const auto add = [&](Ground ground, std::string text) { grounds.push_back({ground, std::move(text)}); };
    const auto& phases = request.model.phases;
    const auto& physical = request.model.physical;
    const auto& payload = request.payload;
    const auto power_ground = !payload ? Ground::measured : payload->is_assumed ? Ground::assumption : Ground::physics;
    const std::string changes = payload ? ", changed by the payload" : "";
    if (way.missing.empty()) {
        add(request.home_distance_m ? Ground::assumption : Ground::measured,
            fmt::format("distance: {:.0f} m, {}", *way.distance_m,
                        request.home_distance_m ? "as stated" : "the largest from the start in the flights"));
        add(Ground::assumption, "wind: " + wind_text(request, way.wind));
        if (physical) {
            const bool is_flown = is_within_flown_range(*physical, {way.airspeed_m_per_s, 0.0, 1.0});
            add(std::max(Ground::physics, power_ground),
                fmt::format("power on the way home: {:.1f} W, by the physical model at {:.1f} m/s{}", fleet.cruise_w,
                            way.airspeed_m_per_s, is_flown ? "" : ", outside of the airspeeds flown"));
        } else {
            add(Ground::assumption, fmt::format("power on the way home: {:.1f} W, the mean cruise of the flights{}, "
                                                "whatever the airspeed; {:.1f} m/s over ground",
                                                fleet.cruise_w, changes, *way.distance_m / way.duration_s));
        }
    }
    add(power_ground,
        fmt::format("landing: {:.0f} s at {:.1f} W, the mean of the flights{}", phases[landing].duration_s,
                    mean_power_w(phases[landing]) + request.compute_w, changes));
    if (payload) add(power_ground, fmt::format("payload: {:g} kg, {}", payload->payload_kg, payload->text));
    if (request.compute_w > 0.0)
        add(Ground::assumption,
            fmt::format("computer: {:.1f} W in these powers, its mean in the mission", request.compute_w));
    add(Ground::assumption, fmt::format("reserve: {:g} %, {}; the critical action keeps {:g} %", reserve_percent,
                                        request.reserve_percent ? "as stated" : "as none is stated",
                                        critical_reserve_part * reserve_percent));
    if (fleet.chances_known)
        add(Ground::measured, "chances: drawn as the model's flights and the pack's intervals differ");
    else
        add(Ground::assumption, fmt::format("chances: unknown, as the model does not show how flights differ; the "
                                            "values assume a standard deviation of {:g} % of the power, "
                                            "and of the landing's whole duration",
                                            assumed_level_sd_percent));
    add(Ground::assumption, "pack: full at power-on, its charge counted by a calibrated sensor");
    return grounds;
}

std::string chance_text(const std::optional<double>& chance) {
    return chance ? fmt::format("{:.1f} %", units::percent_per_whole * *chance) : std::string("unknown");
}

std::string describe(const std::string& name, const FailsafeAction& action) {
    auto text = fmt::format("{} at {} % of charge: {} mAh left, {} mAh used; too late: {}", name, action.soc_percent,
                            action.remaining_mah, action.used_mah, chance_text(action.too_late));
    if (action.too_late_95)
        text += fmt::format(" of flights ({:.1f} to {:.1f} %)", units::percent_per_whole * action.too_late_95->low,
                            units::percent_per_whole * action.too_late_95->high);
    const auto add_voltage = [&](const std::string& use, const std::optional<VoltageThreshold>& voltage) {
        if (voltage)
            text += fmt::format("\n  {}: {:.2f} V; by itself too late: {}, {:g} points or more too early: {}", use,
                                voltage->voltage_v, chance_text(voltage->too_late), early_points,
                                chance_text(voltage->too_early));
    };
    add_voltage(fmt::format("voltage in addition to the count, at {:.1f} A", action.current_a), action.voltage);
    add_voltage("voltage without a count", action.voltage_alone);
    return text + "\n";
}

}  // namespace

std::string to_string(Ground ground) {
    constexpr std::array names{"measured", "physics", "assumption"};
    return names.at(static_cast<std::size_t>(ground));
}

FailsafeCard make_failsafe_card(const FailsafeRequest& request) {
    const double reserve_percent = request.reserve_percent.value_or(assumed_reserve_percent);
    if (!(request.probability >= 0.5 && request.probability < 1.0))
        throw UsageError(fmt::format("a probability of {:g}: expected 0.5 to below 1", request.probability));
    if (!(reserve_percent >= 0.0 && reserve_percent < full_percent))
        throw UsageError(fmt::format("a reserve of {:g} %: expected 0 to below 100 %", reserve_percent));
    const auto way = way_home(request);
    const auto fleet = make_fleet(request, way);
    FailsafeCard card;
    card.capacity_mah = fleet.capacity_ah / units::milli;
    card.reserve_percent = reserve_percent;
    card.probability = request.probability;
    card.chances_known = fleet.chances_known;
    const double critical_percent = critical_reserve_part * reserve_percent;
    const auto critical = make_action(fleet, false, critical_percent, request.probability);
    if (!critical) throw NoResultError(shortfall(fleet, false, critical_percent, "to land with half of the reserve"));
    card.critical = *critical;
    card.low_missing = way.missing;
    card.home_distance_m = way.distance_m;
    if (way.missing.empty()) {
        card.home_duration_s = way.duration_s;
        card.low = make_action(fleet, true, reserve_percent, request.probability);
        if (!card.low)
            card.low_missing = shortfall(fleet, true, reserve_percent, "to return from there with the reserve");
    }
    if (card.low) {
        const double used_ah = fleet.capacity_ah - card.low->remaining_mah * units::milli;
        const double critical_ah = fleet.capacity_ah - card.critical.remaining_mah * units::milli;
        card.lands_short =
            fleet.chance_of([&](std::size_t i) { return is_landed_short(fleet, i, used_ah, critical_ah); });
    }
    if (fleet.pack.thevenin) card.empty_voltage_v = loaded_voltage_v(fleet.pack, 0.0, fleet.cruise_w);
    card.grounds = grounds_of(request, way, fleet, reserve_percent);
    card.monitors = describe_monitors(request.battery);
    if (!card.monitors.empty())
        card.grounds.push_back(
            {request.battery.monitors.front().part > 0.0 ? Ground::measured : Ground::assumption, card.monitors});
    return card;
}

std::string describe(const FailsafeCard& card) {
    auto text = card.low ? describe("Return", *card.low) : fmt::format("Return: no value, {}\n", card.low_missing);
    text += describe("Land at once", card.critical);
    if (card.low)
        text += fmt::format("The return ends before home, by the critical action: {}\n", chance_text(card.lands_short));
    for (const auto& [ground, part] : card.grounds) text += fmt::format("{}: {}\n", to_string(ground), part);
    return text;
}

}  // namespace flightwatt::answer

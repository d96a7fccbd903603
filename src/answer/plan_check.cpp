#include "answer/plan_check.h"

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "mission/feasibility_limits.h"
#include "mission/mission_file.h"
#include "mission/new_mission_plan.h"
#include "mission/plan.h"
#include "mission/prepared_mission.h"
#include "mission/sampled_flights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::answer {
namespace {

using flight::Phase;

/// What differs from the flight that is asked for.
struct Change {
    std::optional<double> airspeed_m_per_s = {};
    std::optional<double> heading_deg = {};
    std::optional<double> spacing_m = {};
    std::optional<double> payload_kg = {};
    mission::MissionReadOptions reading = {};
};

/// Whether flights are drawn: not for one that fails as modelled, where only its success matters.
enum class Draws { none, if_kept, always };

/// A flown plan.
struct Flown {
    mission::MissionVariant mission;
    mission::Simulation simulation;
    std::optional<double> probability;
    Interval probability_95;

    const mission::MissionSummary& summary() const { return simulation.summary; }
};

class PlanFlight {
  public:
    explicit PlanFlight(const PlanQuestion& question) : question_(question) {}

    mission::MissionVariant mission(const Change& change = {}, PlanCheck* check = nullptr) const {
        auto fresh = question_.aircraft;
        auto plan = question_.plan;
        if (change.airspeed_m_per_s) plan.airspeed_m_per_s = change.airspeed_m_per_s;
        if (change.heading_deg) plan.heading_deg = change.heading_deg;
        if (change.spacing_m) plan.spacing_m = change.spacing_m;
        if (change.payload_kg) fresh.payload_kg = change.payload_kg;
        fly_plan(plan, fresh.mechanical, fresh);
        if (check != nullptr) check->chosen = fresh.flown->chosen;
        const auto file = plan.file.filename().string() + ".toml";  // in the working folder, and never written
        try {
            return mission::parse_mission(new_mission_toml(fresh), file, change.reading);
        } catch (const mission::UnknownPowerError& error) {
            throw mission::UnknownPowerError({plan.file.string()}, error.what(), error.hint());
        } catch (const InputError& error) {
            if (error.where().file != file) throw;
            throw InputError({plan.file.string()}, error.what(), error.hint());
        }
    }

    Flown fly(const Change& change = {}, Draws draws = Draws::always) const { return fly(mission(change), draws); }

    Flown fly(mission::MissionVariant mission, Draws draws = Draws::always) const {
        constexpr double most_rows = 20000.0;  // of its curve: plans of weeks are checked, too
        const auto prepared = prepare_mission(mission);
        const double row_s = std::max(1.0, mission::timeline_of(prepared.setup.duration_s).duration_s / most_rows);
        Flown flown{std::move(mission), simulate_prepared(prepared, {row_s}).simulation, {}, {}};
        if (draws == Draws::none || !has_uncertainty(prepared.setup)) return flown;
        if (draws == Draws::if_kept && !flown.summary().keeps_reserve) return flown;
        const auto drawn = sample_flights(prepared, {}, {question_.samples, question_.seed});
        if (!drawn.variability_is_known) return flown;
        flown.probability = 1.0 - drawn.probability_below_reserve;
        flown.probability_95 = {1.0 - drawn.probability_below_reserve_95.high,
                                1.0 - drawn.probability_below_reserve_95.low};
        return flown;
    }

    bool suffices(const Flown& flown) const {
        return flown.summary().keeps_reserve && flown.probability.value_or(1.0) >= question_.probability;
    }

    /// Whether the flight with a value suffices; one that cannot be flown does not.
    template <typename With>
    bool suffices(const With& with, double value) const {
        try {
            return suffices(with(value));
        } catch (const InputError&) {
            return false;
        }
    }

  private:
    const PlanQuestion& question_;
};

/// Charge left at landing, less than 0 the earlier the battery fails.
double left_percent(const mission::MissionSummary& summary) {
    if (summary.feasible) return *summary.final_soc_percent;
    return -units::percentage(summary.duration_s - powered_end_s(summary), summary.duration_s);
}

double soc_at(const mission::SocCurve& curve, double time_s) {
    const auto after = std::ranges::lower_bound(curve.rows, time_s, {}, &mission::SocRow::time_s);
    if (after == curve.rows.end()) return curve.rows.back().soc_percent;
    if (after == curve.rows.begin() || after->time_s == time_s) return after->soc_percent;
    const auto& before = *std::prev(after);
    const double part = (time_s - before.time_s) / (after->time_s - before.time_s);
    return std::lerp(before.soc_percent, after->soc_percent, part);
}

void add_legs(const Flown& flown, PlanCheck& check) {
    const auto& setup = setup_of(flown.mission);
    const double takeoff_s = setup.duration_s[Phase::takeoff];
    for (const auto& element : path_element_results(*setup.cruise_path->plan)) {
        const double start_s = takeoff_s + element.start_s;
        if (check.legs.empty() || check.legs.back().name != element.name) check.legs.push_back({element.name, start_s});
        auto& leg = check.legs.back();
        leg.duration_s += element.duration_s;
        leg.length_m += element.length_m.value_or(0.0);
        leg.energy_wh += units::wh_from_joule(element.mechanical_w * element.duration_s);
        leg.soc_percent = soc_at(flown.simulation.curve, start_s + element.duration_s);
        check.length_m = check.length_m.value_or(0.0) + element.length_m.value_or(0.0);
    }
}

void find_failure(const Flown& flown, PlanCheck& check) {
    const auto& summary = flown.summary();
    if (summary.keeps_reserve) return;
    const auto& rows = flown.simulation.curve.rows;
    const auto below =
        std::ranges::find_if(rows, [&](const auto& row) { return row.soc_percent < summary.reserve_soc_percent; });
    double time_s = powered_end_s(summary);
    if (below != rows.end()) time_s = std::min(time_s, below->time_s);
    check.fails_at_s = time_s;
    const auto leg =
        std::ranges::find_if(check.legs, [&](const auto& of) { return time_s < of.start_s + of.duration_s; });
    if (leg == check.legs.end())
        check.fails_at = "landing";
    else if (time_s < leg->start_s)
        check.fails_at = "take-off";
    else
        check.fails_at = leg->name;
}

/// Tries what would help, each alone.
class Remedies {
  public:
    Remedies(const PlanFlight& flight, const PlanQuestion& question, PlanCheck& check)
        : flight_(flight), question_(question), check_(check) {}

    void add_all(const std::optional<Flown>& flown) {
        add_airspeed(flown);
        add_heading(flown);
        if (!flown) return;
        add_spacing(*flown);
        add_part();
        add_pack(*flown);
        add_payload();
    }

  private:
    void add(const std::string& kind, double value, const std::string& text, const Flown& flown) {
        PlanRemedy remedy{
            kind, text, value, flown.summary().final_soc_percent, flown.probability, flight_.suffices(flown)};
        if (!flown.summary().feasible) remedy.final_soc_percent.reset();
        // A change that makes the answer uncertain is no certain help.
        const auto known = check_.flown ? check_.flown->uncertain : std::vector<std::string>();
        for (const auto& reason : flown.summary().uncertain) {
            if (flown.summary().uncertain.size() <= known.size() || std::ranges::count(known, reason) > 0) continue;
            remedy.text += fmt::format(" (uncertain: {})", reason);
            remedy.suffices = false;
        }
        check_.remedies.push_back(std::move(remedy));
    }

    /// Adds the value of the most charge left, if that is more than as planned.
    template <typename Values, typename ChangeTo, typename Text>
    void add_best(const std::string& kind, const Values& values, const ChangeTo& change_to, const Text& text,
                  const std::optional<Flown>& flown) {
        constexpr double noted_percent = 0.5;
        std::optional<double> best;
        double best_percent = flown ? left_percent(flown->summary()) + noted_percent : -1e9;
        for (const double value : values) {
            try {
                const double percent = left_percent(flight_.fly(change_to(value), Draws::none).summary());
                if (percent < best_percent) continue;
                best_percent = percent;
                best = value;
            } catch (const InputError&) {  // the wind forbids it, or it is beyond what the model knows
            }
        }
        if (best) add(kind, *best, text(*best), flight_.fly(change_to(*best)));
    }

    void add_airspeed(const std::optional<Flown>& flown) {
        const auto& physical = question_.aircraft.model.physical;
        if (!physical) return;
        constexpr int steps = 12;
        std::vector<double> speeds;
        const auto& [low, high] = physical->airspeed_m_per_s;
        for (int i = 0; i <= steps; ++i) speeds.push_back(std::round(10.0 * std::lerp(low, high, i / 12.0)) / 10.0);
        std::erase_if(
            speeds, [&, low = low, high = high](double speed) { return speed <= 0.0 || speed < low || speed > high; });
        add_best(
            "airspeed", speeds, [](double speed) { return Change{.airspeed_m_per_s = speed}; },
            [](double speed) { return fmt::format("an airspeed of {:.1f} m/s", speed); }, flown);
    }

    void add_heading(const std::optional<Flown>& flown) {
        if (!mission::is_area(question_.plan.file)) return;
        std::vector<double> headings;
        for (double deg = 0.0; deg < 180.0; deg += 15.0) headings.push_back(deg);
        add_best(
            "heading", headings, [](double deg) { return Change{.heading_deg = deg}; },
            [](double deg) { return fmt::format("lines on a course of {:.0f} degrees", deg); }, flown);
    }

    /// Lines as close as suffices.
    void add_spacing(const Flown& flown) {
        const auto& survey = setup_of(flown.mission).survey;
        if (!survey) return;
        double max_times = 16.0;  // of those that fit into the area
        const double own_m = survey->layout.strips.front().spacing_m;
        const auto with = [&](double times) {
            return flight_.fly(Change{.spacing_m = std::ceil(own_m * times)}, Draws::if_kept);
        };
        while (max_times > 1.0 && !flight_.suffices(with, max_times)) max_times /= std::numbers::sqrt2;
        if (max_times <= 1.0) return;
        const double times_less = greatest(1.0 / max_times, 1.0, [&](double less) { return with(1.0 / less); });
        const double spacing_m = std::ceil(own_m / times_less);
        add("spacing", spacing_m, fmt::format("lines {:g} m instead of {:g} m apart", spacing_m, own_m),
            with(1.0 / times_less));
    }

    /// The greatest value with which the flight suffices, between one that does and one that does not.
    template <typename With>
    double greatest(double low, double high, const With& with) const {
        constexpr int halvings = 8;
        return last_true(low, high, halvings, [&](double value) { return flight_.suffices(with, value); });
    }

    void add_part() {
        const auto with = [&](double part) {
            return flight_.fly(Change{.reading = {.path_times = part}}, Draws::if_kept);
        };
        const double part = greatest(0.0, 1.0, with);
        if (part > 0.0) add("part", part, describe_path_times(mission::setup_of(flight_.mission()), part), with(part));
    }

    void add_pack(const Flown& flown) {
        constexpr double max_times = 64.0;
        constexpr double steps_per_ah = 100.0;
        const auto& mission = std::get<mission::Mission>(flown.mission);
        const double own_ah = mission.setup.battery.capacity_ah;
        const auto with = [&](double capacity_ah) {
            return flight_.fly(with_capacity(mission, capacity_ah), Draws::if_kept);
        };
        double high = 2.0;
        while (high < max_times && !flight_.suffices(with(high * own_ah))) high *= 2.0;
        if (high >= max_times) return;
        const double times_less = greatest(1.0 / high, 2.0 / high, [&](double less) { return with(own_ah / less); });
        const double capacity_ah = std::ceil(own_ah / times_less * steps_per_ah) / steps_per_ah;
        add("pack", capacity_ah,
            fmt::format("a pack of {:.2f} Ah instead of {:.2f} Ah, as heavy and with as much resistance", capacity_ah,
                        own_ah),
            with(capacity_ah));
    }

    void add_payload() {
        const double payload_kg = question_.aircraft.payload_kg.value_or(0.0);
        if (!(payload_kg > 0.0)) return;
        const auto with = [&](double kg) { return flight_.fly(Change{.payload_kg = kg}, Draws::if_kept); };
        if (!flight_.suffices(with, 0.0))
            return add("payload", 0.0, "no payload", flight_.fly(Change{.payload_kg = 0.0}));
        constexpr double steps_per_kg = 1000.0;
        const double kg = std::floor(greatest(0.0, payload_kg, with) * steps_per_kg) / steps_per_kg;
        add("payload", kg, fmt::format("a payload of {:g} kg instead of {:g} kg", kg, payload_kg), with(kg));
    }

    const PlanFlight& flight_;
    const PlanQuestion& question_;
    PlanCheck& check_;
};

/// Flies the plan in its wind; without a result where the wind alone forbids it, or makes its power unknown, with the
/// reason.
std::optional<Flown> fly_in_wind(const PlanFlight& flight, const PlanQuestion& question, PlanCheck& check) {
    try {
        return flight.fly(flight.mission({}, &check));
    } catch (const InputError& error) {
        if (!question.aircraft.wind) throw;
        auto calm = question;
        calm.aircraft.wind.reset();
        PlanFlight(calm).mission();  // throws what is wrong without wind, too
        check.reason = error.what();
        if (dynamic_cast<const mission::UnknownPowerError*>(&error) != nullptr) check.fit = PlanFit::perhaps;
        return std::nullopt;
    }
}

}  // namespace

std::string to_string(PlanFit fit) { return fit == PlanFit::yes ? "yes" : fit == PlanFit::perhaps ? "perhaps" : "no"; }

PlanCheck check_plan(const PlanQuestion& question) {
    PlanCheck check;
    check.plan = question.plan.file.string();
    check.probability_required = question.probability;
    const PlanFlight flight(question);
    const auto flown = fly_in_wind(flight, question, check);
    if (flown) {
        check.flown = flown->summary();
        check.probability = flown->probability;
        if (flown->probability) check.probability_95 = flown->probability_95;
        check.notes = setup_of(flown->mission).notes;
        add_legs(*flown, check);
        find_failure(*flown, check);
        const bool is_known = flown->probability.has_value();
        auto reasons = check.flown->uncertain;
        if (!is_known)
            reasons.emplace_back("nothing shows how the power of flights differs: their probability is unknown");
        const bool is_sure = reasons.empty() && flight.suffices(*flown);
        check.fit = is_sure ? PlanFit::yes : check.flown->keeps_reserve ? PlanFit::perhaps : PlanFit::no;
        check.reason = fmt::format("{}", fmt::join(reasons, "; "));
    }
    const bool suffices = flown && flight.suffices(*flown);
    if (!suffices && (check.probability || !check.flown || !check.flown->keeps_reserve))
        Remedies(flight, question, check).add_all(flown);
    return check;
}

}  // namespace flightwatt::answer

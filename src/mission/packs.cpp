#include "mission/packs.h"

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "mission/file/takeoff_height.h"
#include "mission/plan.h"
#include "mission/planning/planner.h"
#include "mission/sampling/landing_distribution.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

constexpr auto way_to_path = "way to the path";

constexpr std::size_t most_flights = 1000;
constexpr double parts_tried = 200.0;  ///< of the cruise, after which it may be left; the best is then narrowed
constexpr double min_part_s = 1.0;     ///< that a pack has to fly
constexpr double same_s = 1e-3;
constexpr double search_step_s = 4.0;      ///< of integration
constexpr double rounding_percent = 1e-3;  ///< above the reserve, for that step
constexpr double balance_percent = 0.1;    ///< to which the flights' charge is balanced
constexpr double spare_percent = 0.05;     ///< most that a flight keeps above its reserve with the probability
constexpr int max_rounds = 10;             ///< until the margins of the flights are known

/// A part of the cruise, flown with a pack.
struct CruisePart : TimeInterval {
    std::size_t pack = 0;  ///< from 0
};

/// The schedule of a part of the cruise, which is flown in `cruise` of the flight's. What runs at its ends also runs on
/// the ways there and home, and what runs at the end of take-off and landing as long as those of the flight last.
Schedule schedule_of(const Schedule& whole, const PerPhase<double>& whole_s, const CruisePart& part,
                     const TimeInterval& cruise, const PerPhase<double>& flown_s) {
    Schedule schedule;
    for (const auto phase : all_phases) {
        const auto [start_s, end_s] = phase == Phase::cruise
                                          ? static_cast<TimeInterval>(part)
                                          : TimeInterval{0.0, std::min(whole_s[phase], flown_s[phase])};
        const auto flown = phase == Phase::cruise ? cruise : TimeInterval{start_s, end_s};
        const double pace = flown.duration_s() / (end_s - start_s);  // turns at the ends take more time, or less
        for (auto segment : clip_to_interval(whole, {phase, start_s, end_s})) {
            segment.start_s = segment.start_s == start_s ? 0.0 : flown.start_s + pace * (segment.start_s - start_s);
            segment.end_s = segment.end_s == end_s ? flown_s[phase] : flown.start_s + pace * (segment.end_s - start_s);
            schedule.push_back(std::move(segment));
        }
    }
    return schedule;
}

/// Adds the texts that are not among the others, with a prefix.
void add_others(const std::vector<std::string>& texts, const std::string& prefix, std::vector<std::string>& others) {
    for (const auto& text : texts)
        if (std::ranges::find(others, text) == others.end()) others.push_back(prefix + text);
}

/// Divides a mission. Positions are times [s] of the cruise flown at once.
class PackDivider {
  public:
    PackDivider(const MissionVariant& mission, const std::optional<double>& probability)
        : least_(with_minimum_energy_schedule(mission)),
          packs_(*least_.setup.packs),
          probability_(probability),
          end_s_(least_.setup.duration_s[Phase::cruise]) {
        if (probability) require_known_spread(least_.setup);
        if (!least_.setup.cruise_path) return;
        plan_ = least_.setup.cruise_path->plan.get();
        drawn_ = &drawn_path(*plan_);
        at_once_ = compute_trajectory(plan_->path, plan_->wind);
    }

    double end_s() const { return end_s_; }

    /// Where each flight leaves the cruise if it goes as far as it can, up to where no pack gets further.
    std::vector<double> farthest_ends_s() {
        margins_percent_.clear();
        return ends_s(most_flights, [&](std::size_t pack, double from_s) { return find_margin(pack, from_s); });
    }

    /// The same of as many flights, with the greatest charge that all of them can keep above the reserve.
    std::vector<double> balanced(const std::vector<double>& farthest_s) {
        auto best_s = farthest_s;
        for (int round = 0; round < max_rounds; ++round) {
            best_s = farthest_s;
            double low = rounding_percent;
            double high = 100.0;
            while (high - low > balance_percent) {
                const double margin = std::midpoint(low, high);
                auto tried_s = ends_s(farthest_s.size(), [&](std::size_t pack, double from_s) {
                    return farthest_s_of(pack, from_s, margin + margins_percent_[pack]);
                });
                const bool is_possible = !tried_s.empty() && tried_s.back() == end_s_;
                (is_possible ? low : high) = margin;
                if (is_possible) best_s = std::move(tried_s);
            }
            if (!probability_ || raise_margins(best_s)) return best_s;
        }
        return farthest_s;
    }

    PackFlight flight(const MissionVariant& mission, const CruisePart& part) const {
        PackFlight flight;
        flight.pack = part.pack + 1;
        flight.mission = mission;
        if (auto* scheduled = std::get_if<Mission>(&flight.mission))
            shorten(scheduled->setup, scheduled->schedule, part);
        else
            shorten(std::get<PlanningProblem>(flight.mission).setup, std::get<PlanningProblem>(flight.mission).fixed,
                    part);
        flight.cruise_from_s = part.start_s;
        flight.cruise_to_s = part.end_s;
        if (probability_) flight.margin_percent = margins_percent_[part.pack];
        flight.largest_to_s = farthest_s_of(part.pack, part.start_s, margins_percent_[part.pack]);
        if (plan_ == nullptr || part.end_s == end_s_) return flight;
        const auto position = drawn_position(part.end_s);
        flight.return_from =
            fmt::format("{}, {:.0f} %", drawn_->elements[position.element].name, units::percentage(position.part, 1.0));
        const auto place = local_position_at(*drawn_, position);
        flight.return_east_m = place.east_m;
        flight.return_north_m = place.north_m;
        return flight;
    }

  private:
    template <typename End>
    std::vector<double> ends_s(std::size_t most, const End& end_of) const {
        std::vector<double> ends_s;
        double from_s = 0.0;
        while (from_s < end_s_ && ends_s.size() < most) {
            const double to_s = end_of(ends_s.size(), from_s);
            if (to_s < std::min(from_s + min_part_s, end_s_)) break;
            ends_s.push_back(from_s = to_s);
        }
        return ends_s;
    }

    /// The position on the path as it is drawn: as much of an element as of the time that its parts take.
    path::PathPosition drawn_position(double time_s) const {
        const auto at = position_at(at_once_, time_s);
        const auto& flown = plan_->path.elements;
        if (at.element == flown.size()) return {drawn_->elements.size()};
        if (!plan_->turns) return at;
        double before_s = at.part * at_once_.element_s[at.element];
        double all_s = 0.0;
        for (std::size_t i = 0; i < flown.size(); ++i) {
            if (flown[i].drawn != flown[at.element].drawn) continue;
            all_s += at_once_.element_s[i];
            if (i < at.element) before_s += at_once_.element_s[i];
        }
        return {flown[at.element].drawn, before_s / all_s};
    }

    /// The way from home to a position of the path, or home from it. A height too large for it at the path's rates
    /// changes above home.
    std::vector<path::PathElement> ways(const path::PathPosition& position, bool is_home) const {
        const auto& elements = drawn_->elements;
        const double sign = is_home ? -1.0 : 1.0;
        const auto there = local_position_at(*drawn_, position) - packs_.home;
        path::PathElement way;
        way.name = is_home ? way_home : way_to_path;
        const auto& flown = elements[std::min(position.element, elements.size() - 1)];
        way.airspeed_m_per_s = flown.airspeed_m_per_s;
        way.keeps_ground_speed = flown.keeps_ground_speed;
        for (const auto& element : path_between(*drawn_, {}, position).elements)
            way.altitude_change_m += sign * element.altitude_change_m;
        const double course_deg = std::atan2(sign * there.east_m, sign * there.north_m) * units::degree_per_rad;
        const path::Leg leg{std::hypot(there.east_m, there.north_m), std::fmod(course_deg + 360.0, 360.0)};
        way.shape = leg;
        const double height_m = std::abs(way.altitude_change_m);
        const auto rate = way.altitude_change_m > 0.0 ? plan_->rates.climb_m_per_s : plan_->rates.descent_m_per_s;
        if (!rate || *rate >= way.airspeed_m_per_s) return {way};
        const double speed =
            ground_speed_m_per_s(way, *rate, leg.course_deg, plan_->wind).value_or(way.airspeed_m_per_s);
        constexpr double same_height_m = 1e-3;
        if (height_m < same_height_m || height_m / *rate * speed <= leg.length_m) return {way};
        auto above_home = way;
        above_home.shape = path::Hold{height_m / *rate, std::nullopt, way.keeps_ground_speed};
        above_home.climb_rate_m_per_s = rate;
        way.altitude_change_m = 0.0;
        return is_home ? std::vector{way, above_home} : std::vector{above_home, way};
    }

    /// Makes setup and schedule those of a part.
    void shorten(MissionSetup& setup, Schedule& schedule, const CruisePart& part) const {
        setup.packs.reset();
        setup.name += fmt::format(", pack {}", part.pack + 1);
        if (part.pack < packs_.batteries.size()) setup.battery = packs_.batteries[part.pack];
        setup.duration_s[Phase::cruise] = part.duration_s();
        setup.duration_is_stated[Phase::cruise] = true;
        const auto cruise = make_path(setup, part);
        if (plan_ != nullptr) set_ends(setup);
        schedule = schedule_of(schedule, least_.setup.duration_s, part, cruise, setup.duration_s);
    }

    /// Makes take-off and landing those of the heights at which the path of a part begins and ends.
    static void set_ends(MissionSetup& setup) {
        const auto ends = takeoff_and_landing(setup);
        setup.duration_s = ends.duration_s;
        add_others(ends.uncertain, "", setup.uncertain);
    }

    /// Makes the path of a part; the times of the flight's cruise between which the part is flown.
    TimeInterval make_path(MissionSetup& setup, const CruisePart& part) const {
        if (plan_ == nullptr) return {0.0, part.duration_s()};
        const auto from = drawn_position(part.start_s);
        const auto to = drawn_position(part.end_s);
        auto plan = *plan_;
        plan.path = path_between(*drawn_, from, to);
        auto& elements = plan.path.elements;
        if (part.start_s > 0.0) {
            const auto there = ways(from, false);
            elements.insert(elements.begin(), there.begin(), there.end());
            if (plan.origin) plan.origin->start = plan.origin->start + packs_.home;
        }
        if (part.end_s < end_s_) std::ranges::move(ways(to, true), std::back_inserter(elements));
        if (plan.turns) {
            plan.drawn = plan.path;
            plan.path = as_flown(plan, plan.drawn);
        }
        const auto flown = compute_trajectory(plan.path, plan.wind);
        TimeInterval cruise{0.0, flown.duration_s};
        for (std::size_t i = 0; i < plan.path.elements.size(); ++i) {
            if (plan.path.elements[i].name == way_to_path) cruise.start_s += flown.element_s[i];
            if (plan.path.elements[i].name == way_home) cruise.end_s -= flown.element_s[i];
        }
        set_cruise_path(setup, std::move(plan));
        return cruise;
    }

    /// A part as it is flown with the least energy demand.
    Mission least(const CruisePart& part) const {
        auto mission = least_;
        shorten(mission.setup, mission.schedule, part);
        return mission;
    }

    /// Whether a part lands with so much more than the reserve, with the least energy demand.
    bool lands(const CruisePart& part, double margin_percent) const {
        try {
            const auto mission = least(part);
            const double output_s = std::max(mission.setup.duration_s[Phase::cruise], search_step_s);
            const auto summary = simulate(mission, {output_s, search_step_s}).summary;
            return summary.feasible && *summary.final_soc_percent >= summary.reserve_soc_percent + margin_percent;
        } catch (const InputError&) {  // the wind forbids a way, or it is too short for the change of height
            return false;
        }
    }

    LandingDistribution landings(const CruisePart& part) const {
        const auto mission = least(part);
        return draw_landings_until_known(mission, collect_uncertainty(mission.setup), *probability_);
    }

    /// The farthest position of a pack, and into `margins_percent_` what it has to keep above the reserve.
    double find_margin(std::size_t pack, double from_s) {
        auto& margin = margins_percent_.emplace_back(rounding_percent);
        auto farthest_s = farthest_s_of(pack, from_s, margin);
        if (!probability_ || farthest_s == from_s) return farthest_s;
        MarginSearch search(margin);
        double best_s = from_s;
        for (int round = 0; round < max_rounds && !search.has_converged(); ++round) {
            farthest_s = farthest_s_of(pack, from_s, search.margin_percent());
            if (farthest_s == from_s) {
                search.mark_infeasible();
                continue;
            }
            const auto drawn = landings({{from_s, farthest_s}, pack});
            const double spare = drawn.spare_percent(*probability_);
            if (spare >= 0.0 && farthest_s > best_s) {
                best_s = farthest_s;
                margin = std::max(rounding_percent, drawn.nominal_percent - drawn.quantile_percent(*probability_));
            }
            if (spare >= 0.0 && (spare < spare_percent || farthest_s == end_s_)) break;
            search.add_result(spare, spare_percent / 2.0);
        }
        return best_s;
    }

    /// Raises the margins of flights that miss the reserve with the probability too often; true if no flight does.
    bool raise_margins(const std::vector<double>& ends_s) {
        bool all_keep = true;
        CruisePart part;
        for (const double end_s : ends_s) {
            part.end_s = end_s;
            const double spare = landings(part).spare_percent(*probability_);
            if (spare < 0.0) margins_percent_[part.pack] += spare_percent - spare;
            all_keep = all_keep && spare >= 0.0;
            part = {{end_s, end_s}, part.pack + 1};
        }
        return all_keep;
    }

    /// The farthest position that a pack returns from with that margin; without any, `from_s`. The way home may become
    /// shorter: positions all along the cruise are tried.
    double farthest_s_of(std::size_t pack, double from_s, double margin_percent) const {
        const double step_s = std::max(min_part_s, end_s_ / parts_tried);
        double best_s = from_s;
        double beyond_s = end_s_;
        for (double to_s = end_s_; to_s > from_s + same_s && best_s == from_s; to_s -= step_s) {
            if (lands({{from_s, to_s}, pack}, margin_percent))
                best_s = to_s;
            else
                beyond_s = to_s;
        }
        if (best_s == end_s_) return best_s;
        while (beyond_s - best_s > same_s) {
            const double middle_s = std::midpoint(best_s, beyond_s);
            (lands({{from_s, middle_s}, pack}, margin_percent) ? best_s : beyond_s) = middle_s;
        }
        return best_s;
    }

    Mission least_;
    const Packs& packs_;
    std::optional<double> probability_;
    double end_s_ = 0.0;
    const path::PlannedPath* plan_ = nullptr;
    const path::FlightPath* drawn_ = nullptr;
    path::PathTrajectory at_once_;
    std::vector<double> margins_percent_;  ///< of each pack above the reserve as stated
};

/// Returns the row of a pack that rests on the ground, with the charge of `row` and without power.
SocRow row_on_ground(const MissionVariant& mission, const SocRow& row, double time_s) {
    SocRow rests{.time_s = time_s, .phase = row.phase, .soc_percent = row.soc_percent};
    rests.terminal_voltage_v = battery::terminal_voltage_v(setup_of(mission).battery, {row.soc_percent, 0.0}, 0.0);
    return rests;
}

/// Adds a flight that was simulated to the others.
void add(PackFlight& flight, PackFlights& all) {
    const auto& [curve, summary] = flight.flown.simulation;
    auto& total = all.total;
    const double pause_s = flight.pack > 1 ? all.setup.packs->change_s : 0.0;
    flight.start_s = total.duration_s + pause_s;
    const double in_air_s = total.duration_s - all.on_ground_s;
    all.on_ground_s += pause_s;
    all.suffice = all.suffice && summary.keeps_reserve;
    add_others(setup_of(flight.mission).uncertain, fmt::format("pack {}: ", flight.pack), total.uncertain);
    total.duration_s = flight.start_s + summary.duration_s;
    total.mechanical_energy_wh += summary.mechanical_energy_wh;
    total.compute_energy_wh += summary.compute_energy_wh;
    total.energy_wh += summary.energy_wh;
    total.final_soc_percent =
        std::min(total.final_soc_percent.value_or(100.0), summary.final_soc_percent.value_or(0.0));
    if (summary.utility)
        total.utility = (total.utility.value_or(0.0) * in_air_s + *summary.utility * summary.duration_s) /
                        (in_air_s + summary.duration_s);
    if (pause_s > 0.0) {
        const auto& landed = all.flights[all.flights.size() - 2].mission;
        all.curve.rows.push_back(row_on_ground(landed, all.curve.rows.back(), flight.start_s - pause_s));
        all.curve.rows.push_back(row_on_ground(flight.mission, curve.rows.front(), flight.start_s));
    }
    for (auto row : curve.rows) {
        row.time_s += flight.start_s;
        all.curve.rows.push_back(row);
    }
}

}  // namespace

PackFlights fly_packs(const MissionVariant& mission, const SimulationOptions& steps,
                      const std::optional<double>& probability) {
    PackFlights all;
    all.setup = setup_of(mission);
    const auto& packs = *all.setup.packs;
    all.probability = probability;
    PackDivider divider(mission, probability);
    auto ends_s = divider.farthest_ends_s();
    if (!ends_s.empty() && ends_s.back() == divider.end_s()) all.needed = ends_s.size();
    all.suffice = all.needed && *all.needed <= packs.count;
    all.total.mission = all.setup.name;
    all.total.reserve_soc_percent = all.setup.reserve_soc_percent;
    all.total.power_model = all.setup.power_model;
    all.total.uncertain = all.setup.uncertain;
    ends_s.resize(std::min(ends_s.size(), packs.count));
    if (all.suffice) ends_s = divider.balanced(ends_s);
    CruisePart part;
    for (const double end_s : ends_s) {
        part.end_s = end_s;
        auto& flight = all.flights.emplace_back(divider.flight(mission, part));
        flight.flown = simulate_prepared(prepare_mission(flight.mission, probability), steps);
        add(flight, all);
        part = {{end_s, end_s}, part.pack + 1};
    }
    all.total.feasible = all.total.keeps_reserve = all.suffice;
    return all;
}

std::string describe(const PackFlights& all) {
    const auto text = fmt::format("{}: {} of {} packs", all.setup.name, all.flights.size(), all.setup.packs->count);
    if (all.suffice)
        return fmt::format(
            "{}, {} with {} on the ground; {:.3f} Wh; each flight lands with {:.2f} % of its charge or "
            "more, reserve {:.2f} %",
            text, duration_text(all.total.duration_s), duration_text(all.on_ground_s), all.total.energy_wh,
            *all.total.final_soc_percent, all.setup.reserve_soc_percent);
    const double flown_s = all.flights.empty() ? 0.0 : all.flights.back().cruise_to_s;
    return fmt::format("{} fly {} of {} of the cruise with the reserve; {}", text, duration_text(flown_s),
                       duration_text(all.setup.duration_s[Phase::cruise]),
                       all.needed ? fmt::format("{} packs would do", *all.needed)
                       : all.setup.packs->batteries.size() > 1
                           ? std::string("the next pack gets no further and lands with it; another order may do")
                           : std::string("no number of packs would do: none gets further and lands with it"));
}

}  // namespace flightwatt::mission

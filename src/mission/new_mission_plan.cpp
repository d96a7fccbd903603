#include "mission/new_mission_plan.h"

#include "base/error.h"

#include <set>

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

/// "12 to 16 m/s".
std::string range_text(const std::set<double>& speeds) {
    const double low = *speeds.begin();
    const double high = *speeds.rbegin();
    return low == high ? fmt::format("{} m/s", low) : fmt::format("{} to {} m/s", low, high);
}

/// Chooses the airspeed of a new path.
void choose_airspeed(const PlanToFly& plan, NewMission& fresh) {
    const auto& planned = fresh.flown->speed;
    const auto& own = fresh.flown->own_m_per_s;
    fresh.airspeed_m_per_s = plan.airspeed_m_per_s;
    if (fresh.airspeed_m_per_s) {
        if (own.empty()) return;
        fresh.flown->keys.emplace_back("one_airspeed = true");
        fresh.flown->chosen.push_back(fmt::format("one_airspeed = true: {} m/s instead of the plan's {}",
                                                  *fresh.airspeed_m_per_s, range_text(own)));
        return;
    }
    const auto& [low, high] = fresh.model.physical->airspeed_m_per_s;
    const bool is_flown = planned && planned->m_per_s >= low && planned->m_per_s <= high;
    const auto flown =
        fmt::format("airspeed_m_per_s = {:.1f}, as the model's flights", new_airspeed_m_per_s(fresh.model));
    auto& chosen = fresh.flown->chosen;
    if (!own.empty())
        chosen.push_back(
            fmt::format("the plan changes its airspeed to {}; --airspeed states one for all of it", range_text(own)));
    if (!planned) {
        chosen.push_back(flown);
    } else if (planned->is_default && !is_flown) {
        chosen.push_back(fmt::format("{}, which did not fly the {} m/s of {}; --airspeed states another", flown,
                                     planned->m_per_s, planned->source));
    } else {
        fresh.airspeed_m_per_s = planned->m_per_s;
        chosen.push_back(
            fmt::format("airspeed_m_per_s = {}, {}; --airspeed states another", planned->m_per_s, planned->source));
    }
}

}  // namespace

void fly_plan(const PlanToFly& plan, const std::string& model_file, NewMission& fresh) {
    if (!fresh.model.physical && !plan.airspeed_m_per_s)
        throw InputError({model_file}, "has no [physical] part, which predicts the power along a plan",
                         "give the ground speed that its flights flew, --airspeed M_PER_S: their mean power in calm "
                         "air is then assumed; or make a model of flights that measured their airspeed");
    fresh.flown = path_of_plan(plan, plan.airspeed_m_per_s.value_or(new_airspeed_m_per_s(fresh.model)),
                               fresh.model.is_rotorcraft);
    choose_airspeed(plan, fresh);
}

}  // namespace flightwatt::mission

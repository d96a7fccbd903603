#include "mission/new_mission_plan.h"

#include "base/error.h"

#include <fmt/format.h>

namespace flightwatt::mission {
namespace {

/// Chooses the airspeed of a new path.
void choose_airspeed(const PlanToFly& plan, NewMission& fresh) {
    const auto& planned = fresh.flown->speed;
    fresh.airspeed_m_per_s = plan.airspeed_m_per_s;
    if (fresh.airspeed_m_per_s) return;
    const auto& [low, high] = fresh.model.physical->airspeed_m_per_s;
    const bool is_flown = planned && planned->m_per_s >= low && planned->m_per_s <= high;
    const auto flown =
        fmt::format("airspeed_m_per_s = {:.1f}, as the model's flights", new_airspeed_m_per_s(fresh.model));
    auto& chosen = fresh.flown->chosen;
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

#pragma once

#include <vector>

namespace flightwatt::mission {

/// What a planner may choose for one component.
struct ComponentChoices {
    std::vector<std::vector<double>> levels;  ///< of each parameter; every combination may be chosen
    bool may_be_off = false;
};

/// How a mission's schedule may be planned.
struct PlanSettings {
    double slot_s = 10.0;  ///< QoS may change at its multiples, counted from each phase's begin
    double dwell_s = 0.0;  ///< a configuration once chosen stays at least so long
    std::vector<ComponentChoices> choices;  ///< one a component
};

}  // namespace flightwatt::mission

#include "cli/output/failsafe_output.h"

namespace flightwatt::answer {

Fields<VoltageThreshold> record_fields(const VoltageThreshold*) {
    using R = VoltageThreshold;
    return {
        field("voltage_v", &R::voltage_v, "of the pack under cruise current, rounded up"),
        field("probability_too_late", &R::too_late, "null: unknown"),
        field("probability_too_early", &R::too_early, "10 points of charge or more before the count; null: unknown")};
}

Fields<FailsafeAction> record_fields(const FailsafeAction*) {
    using R = FailsafeAction;
    return {field("soc_percent", &R::soc_percent, "charge at which it acts, rounded up"),
            field("used_mah", &R::used_mah, "charge used since the full pack"),
            field("remaining_mah", &R::remaining_mah, "capacity less that, rounded up"),
            field("current_a", &R::current_a, "in cruise, at this charge"),
            field("probability_too_late", &R::too_late, "of the count of charge; null: unknown"),
            field("probability_too_late_interval_95", &R::too_late_95, "in new flights"),
            field("voltage", &R::voltage, "at this charge; null: constant voltage"),
            field("voltage_alone", &R::voltage_alone, "early enough with the probability, without a count of charge")};
}

Fields<GroundedPart> record_fields(const GroundedPart*) {
    using R = GroundedPart;
    return {field("ground", &R::ground, "measured, physics or assumption"), field("text", &R::text, "the part")};
}

Fields<FailsafeCard> record_fields(const FailsafeCard*) {
    using R = FailsafeCard;
    return {field("capacity_mah", &R::capacity_mah, "of the pack"),
            field("reserve_percent", &R::reserve_percent, "to be left at landing"),
            field("probability", &R::probability, "with which an action is early enough"),
            field("probability_is_known", &R::chances_known, "false: nothing shows how the power of flights differs"),
            field("home_distance_m", &R::home_distance_m, "farthest place; null: no value"),
            field("home_duration_s", &R::home_duration_s, "of the way home, as planned"),
            field("low", &R::low, "return in time; null: no value"),
            field("low_missing", &R::low_missing, "why there is no value; empty: there is"),
            field("critical", &R::critical, "land at once, and keep half of the reserve"),
            field("probability_landed_short", &R::lands_short, "that the critical action ends a return; null: unknown"),
            field("empty_voltage_v", &R::empty_voltage_v, "of the empty pack under cruise current"),
            field("rests_on", &R::grounds, "what the values rest on")};
}

}  // namespace flightwatt::answer

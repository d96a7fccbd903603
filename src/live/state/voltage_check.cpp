#include "live/state/voltage_check.h"

#include "base/statistics.h"
#include "base/units.h"
#include "battery/landing_forecast.h"
#include "flight/flight_data.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::live {

std::optional<VoltageCheck> check_voltage(const battery::Battery& battery, const battery::DischargeRecord& record,
                                          double initial_soc_percent) {
    if (!battery.thevenin || record.time_s.empty()) return std::nullopt;
    const auto settled_a = rc_branch_current_a(record, battery.thevenin->rc_time_constant_s);
    std::vector<double> off_v;
    std::vector<double> rest_v;
    std::vector<double> loads_a;
    for (std::size_t i = record.time_s.size(); i-- > 0 && record.time_s[i] >= record.time_s.back() - watched_s;) {
        if (!record.used[i]) continue;
        const double lost_v =
            battery.resistance_ohm * record.current_a[i] + battery.thevenin->rc_resistance_ohm * settled_a[i];
        rest_v.push_back(record.voltage_v[i] + lost_v);
        loads_a.push_back(record.current_a[i]);
        const auto soc = soc_at(battery, record, initial_soc_percent, record.time_s[i]);
        off_v.push_back(rest_v.back() - open_circuit_voltage_v(battery, std::clamp(*soc, 0.0, 100.0)));
    }
    if (off_v.size() < enough_samples) return std::nullopt;
    const double now_v = median(std::move(rest_v));
    const auto& scatter = battery.intervals.resistance_scatter;
    const double explained_v = scatter ? normal_half_width() * scatter->sd_ohm * median(std::move(loads_a)) : 0.0;
    return VoltageCheck{median(std::move(off_v)), explained_v, battery::resting_soc_percent(battery, now_v),
                        battery::resting_soc_sd_percent(battery, now_v)};
}

std::string voltage_warning(double counted_percent, double by_voltage_percent) {
    return fmt::format(
        "the voltage shows {:.0f} % of charge where {:.0f} % were counted: the prediction is by the voltage; land "
        "early, and check cells and label of the pack",
        by_voltage_percent, counted_percent);
}

std::optional<double> soc_at(const battery::Battery& battery, const battery::DischargeRecord& record,
                             double initial_soc_percent, double time_s) {
    const auto after = flight::first_after(record.time_s, time_s);
    if (after == 0) return std::nullopt;
    return initial_soc_percent - units::percentage(record.charge_ah[after - 1], battery.capacity_ah);
}

}  // namespace flightwatt::live

#pragma once

#include "battery/identification.h"
#include "report/figure.h"

#include <span>
#include <string>

namespace flightwatt::report {

/// Terminal voltage over time, measured and modelled, a panel a flight: the model predicts it from the
/// current and the resting voltage alone. `records` is not empty.
Figure voltage_figure(const battery::Battery& battery, std::span<const battery::DischargeRecord> records,
                      const std::string& id);

/// The open-circuit voltage over the state of charge with the 95 % intervals of its knots, and from where on
/// the chart of LiPo cells stands in.
Figure open_circuit_figure(const battery::BatteryIdentification& identified, const std::string& id);

}  // namespace flightwatt::report

#pragma once

namespace flightwatt::battery {

/// The open-circuit voltage that lithium-polymer packs are commonly said to have, a cell: 4.20 V full, 3.84 V
/// half, 3.27 V empty (the voltage chart that sellers of packs print, e.g.
/// blog.ampow.com/lipo-voltage-chart). Packs differ from it by some 30 mV; it stands in only for what no
/// flight has shown.
inline constexpr double lipo_chart_uncertainty_v = 0.03;

/// [V] a cell at a state of charge, 0 to 100.
double lipo_chart_voltage_v(double soc_percent);

/// The inverse; 0 below and 100 above the chart.
double lipo_chart_soc_percent(double cell_voltage_v);

/// How many cells a pack has that rests at this voltage, if it is charged: at most 4.25 V a cell.
int lipo_cells(double resting_voltage_v);

}  // namespace flightwatt::battery

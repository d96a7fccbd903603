#include "battery/lipo_chart.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flightwatt::battery {
namespace {

constexpr double chart_step_percent = 5.0;
constexpr double greatest_cell_voltage_v = 4.25;
/// From 0 to 100 % in steps of 5.
constexpr std::array cell_voltage_v{3.27, 3.61, 3.69, 3.71, 3.73, 3.75, 3.77, 3.79, 3.80, 3.82, 3.84,
                                    3.85, 3.87, 3.91, 3.95, 3.98, 4.02, 4.08, 4.11, 4.15, 4.20};

}  // namespace

double lipo_chart_voltage_v(double soc_percent) {
    const double place = std::clamp(soc_percent / chart_step_percent, 0.0, cell_voltage_v.size() - 1.0);
    const auto below = std::min(static_cast<std::size_t>(place), cell_voltage_v.size() - 2);
    return std::lerp(cell_voltage_v.at(below), cell_voltage_v.at(below + 1),
                     place - static_cast<double>(below));
}

double lipo_chart_soc_percent(double cell_voltage) {
    if (cell_voltage <= cell_voltage_v.front()) return 0.0;
    const auto* const above = std::upper_bound(cell_voltage_v.begin(), cell_voltage_v.end(), cell_voltage);
    if (above == cell_voltage_v.end()) return 100.0;
    const auto i = static_cast<double>(above - cell_voltage_v.begin());
    return chart_step_percent * (i - 1.0 + (cell_voltage - above[-1]) / (above[0] - above[-1]));
}

int lipo_cells(double resting_voltage_v) {
    return static_cast<int>(std::max(1.0, std::ceil(resting_voltage_v / greatest_cell_voltage_v)));
}

}  // namespace flightwatt::battery

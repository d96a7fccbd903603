#pragma once

#include "mechanical/physical_model.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// The airspeed that is best for a purpose (docs/methods.md, Eq. 39a).
struct BestSpeed {
    std::string purpose;  ///< "best endurance"
    std::string unit;     ///< of the cost: "W", "Wh/km" or "Wh"
    /// Absent where the cost still falls at 0.4 times the slowest or 1.6 times the fastest airspeed flown.
    std::optional<double> airspeed_m_per_s;
    std::optional<double> low_m_per_s;   ///< of the 95 % interval; absent: no bound
    std::optional<double> high_m_per_s;  ///< same
    std::optional<double> cost;          ///< at that airspeed
    bool below_flown = false;            ///< slower than the range flown: extrapolated
    bool above_flown = false;
};

/// The terms of a cost at an airspeed; std::nullopt where it cannot be flown.
using CostTerms = std::function<std::optional<TermValues>(double airspeed_m_per_s)>;

/// Level legs that would determine the induced drag, or narrow its interval, and half of that [W m/s].
struct SpeedTest {
    std::vector<double> airspeed_m_per_s;  ///< of the legs, slower than flown
    double leg_s = 0.0;
    int flights = 0;  ///< each with all legs, until the interval excludes 0; at most 20
    double induced_now = 0.0;
    double induced_after = 0.0;   ///< with the legs
    BestSpeed endurance_after{};  ///< if the legs confirm the coefficients
};

struct SpeedToFly {
    PhysicalModel model;            ///< speed_model
    std::vector<BestSpeed> best;    ///< endurance, range in calm air, range in a headwind if one is given
    std::optional<SpeedTest> test;  ///< absent where the flights determine the induced drag, and of a single flight
};

/// The model with its speed terms in place of its own; std::nullopt without drag and induced drag.
std::optional<PhysicalModel> speed_model(PhysicalModel model);

/// Returns the model with its speed terms in place of its own, where its own have no cost of airspeed and the flights show
/// one: a drag above 0 by its 95 % interval, with an induced drag of at least 0; else the model as it is.
PhysicalModel with_cost_of_airspeed(PhysicalModel model);

/// The airspeed of least cost by a speed_model, with Fieller's interval (of a single flight: none).
BestSpeed best_speed(const PhysicalModel& model, const std::string& purpose, const std::string& unit,
                     const CostTerms& cost);

/// For a headwind [m/s] that is not 0 (below: tailwind) a third speed is added. std::nullopt as speed_model.
std::optional<SpeedToFly> speed_to_fly(const PhysicalModel& model, double headwind_m_per_s = 0.0);

/// "12.1 m/s (95 %: 11.0 to 13.2 m/s), 38.1 W"; '*' marks speeds outside of the flown range.
std::string describe(const BestSpeed& best, const Interval& flown_m_per_s);

/// The flight to fly, with the intervals before and after.
std::string describe(const SpeedTest& test);

}  // namespace flightwatt::mechanical

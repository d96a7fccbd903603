#pragma once

#include "flight/flight_series.h"
#include "mechanical/covariate.h"

#include <cstddef>
#include <optional>

namespace flightwatt::mechanical {

/// A flight in the air, at one moment of its cruise; all times are the log's own seconds.
struct FlownSoFar {
    double lift_off_s = 0.0;
    double cruise_start_s = 0.0;
    double until_s = 0.0;
    double energy_wh = 0.0;  ///< measured from lift-off until now
    double cruise_energy_wh = 0.0;
    std::optional<double> airspeed_cubed_m3_per_s3;  ///< mean over the cruise so far
    Covariates covariates;                           ///< covariates_of what was known
    double cruise_s() const { return until_s - cruise_start_s; }
};

/// The moment that is asked for: since lift-off or, if not given, on the log's clock.
struct Moment {
    std::optional<double> since_lift_off_s;
    double log_time_s = 0.0;
};

/// What a ground station knew at the moment: lift-off, too, is found in what came before it alone, so the
/// answer is the same whether the log goes on or ends there. `sortie` counts from 0. Throws NoAnswerError
/// where by then the aircraft has not taken off, has not held its height for 30 s, or has landed, or the
/// log ends more than 60 s before; what segment throws.
FlownSoFar flown_so_far(const flight::FlightSeries& series, const Moment& moment, std::size_t sortie = 0);

}  // namespace flightwatt::mechanical

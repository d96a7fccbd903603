#pragma once

#include "base/statistics.h"
#include "mechanical/flight_progress.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/physical_model.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// An independent cause of uncertainty: its variance and the degrees of freedom that the variance rests on.
struct VarianceTerm {
    double variance_wh2 = 0.0;
    double degrees_of_freedom = 0.0;
};

/// An energy that is predicted. Without `uncertainty_known` there is no interval: one flight alone does not
/// tell how flights differ.
struct EnergyEstimate {
    double energy_wh = 0.0;
    bool uncertainty_known = true;
    double variance_wh2 = 0.0;
    /// Sum over the shares of variance^2 / degrees_of_freedom.
    double satterthwaite_sum = 0.0;
};

void add_variance(EnergyEstimate& estimate, const VarianceTerm& share);

/// Both together, as if they were independent.
EnergyEstimate sum_of(const EnergyEstimate& a, const EnergyEstimate& b);

struct EnergyInterval {
    double low_wh = 0.0;
    double high_wh = 0.0;
    bool contains(double energy_wh) const { return low_wh <= energy_wh && energy_wh <= high_wh; }
};

/// 95 % predictive interval: Student's t with Welch and Satterthwaite's degrees of freedom. A low
/// end below 0 becomes 0: a drone takes no energy back. std::nullopt without known uncertainty.
std::optional<EnergyInterval> interval_95(const EnergyEstimate& estimate);

/// A phase of the model as a prediction needs it.
struct WeightedPhase {
    PhaseModel model;
    double weight_square_sum = 1.0;  ///< of the flights' weights: the average's variance, in flights'
};

/// The phase of a model with the weights of its flights (all alike where it does not say).
WeightedPhase forecast_of(const MechanicalModel& model, flight::Phase phase);

/// The mean power of a phase, over the flights that count.
struct MeanPower {
    double mean_w = 0.0;  ///< of the flights' mean powers, by their weights
    std::optional<Interval>
        interval;  ///< 95 %, of the mean of all flights like these; of a single flight of its own mean
    std::size_t flights = 0;
    std::size_t samples = 0;  ///< of all flights that have the phase
};

/// By Student's t: of two flights or more of how they differ (VarianceComponents); of a single one of the residual of
/// its curve over its effective samples, which only an analysis of errors tells. A low end below 0 is 0. std::nullopt
/// for a model whose flights have no mean power.
std::optional<MeanPower> mean_power(const MechanicalModel& model, flight::Phase phase);

/// Energy of a phase that will take `duration_s`, before the flight: the stretched curve's integral. Its
/// interval holds the spread of the flights' mean powers (which contains what a flight drifts in a phase)
/// and that of their average (docs/methods.md, Eq. 16).
EnergyEstimate predict_before_flight(const WeightedPhase& phase, double duration_s);

/// Of a phase with a constant power.
EnergyEstimate energy_of(const ConstantPower& power, double duration_s);

/// The same from `flown_s` on, without regard to what was measured until then.
EnergyEstimate predict_remaining_before_flight(const WeightedPhase& phase, double flown_s, double remaining_s);

/// Where the cruise level is expected before this flight's own power is looked at.
enum class CruisePrior {
    curve,    ///< the model's Fourier curve
    constant  ///< the curve's mean, for flights whose power has no shape in common
};

/// The rest of a cruise in flight.
struct RemainingCruise {
    EnergyEstimate energy;
    double gain = 0.0;        ///< 0: the model alone counts, 1: the difference seen so far goes on in full
                              /// < (predict_remaining_physical: the part of the flight's power by which it is off the
                              /// model)
    double expected_w = 0.0;  ///< mean power so far, as the model expected it
    double measured_w = 0.0;  ///< and as it was measured
    double remaining_mean_w = 0.0;
};

/// Shrinks between model and flight (docs/methods.md, Eqs. 19 and 20): the difference between measured and
/// expected mean power so far goes on as far as the flights' levels differ more than power drifts within one.
/// Throws NoResultError if the model has no spread.
RemainingCruise predict_remaining_cruise(const WeightedPhase& cruise, const FlightProgress& flown, double remaining_s,
                                         CruisePrior source);

/// Energy of `duration_s` whose motion is known (means of the terms), before the flight: sum_of_terms_w, not below
/// 0, and prediction_uncertainty it.
EnergyEstimate predict_physical(const PhysicalModel& model, const TermValues& mean_values, double duration_s);

/// The rest of a cruise whose motion is known, in flight (predict_posterior_power); of each motion that may lie ahead.
/// Throws NoResultError if the model rests on a single flight.
std::vector<RemainingCruise> predict_remaining_physical(const PhysicalModel& model, const FlightProgress& flown,
                                                        std::span<const MotionAhead> ahead);
RemainingCruise predict_remaining_physical(const PhysicalModel& model, const FlightProgress& flown,
                                           const MotionAhead& ahead);

}  // namespace flightwatt::mechanical

#pragma once

#include "base/statistics.h"
#include "mechanical/flight_progress.h"
#include "mechanical/mechanical_model.h"
#include "mechanical/physical_model.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// A predicted energy. Without `uncertainty_known` there is no interval: a single flight has no variability.
struct EnergyEstimate {
    double energy_wh = 0.0;
    bool uncertainty_known = true;
    double variance_wh2 = 0.0;
    double satterthwaite_sum = 0.0;  ///< of variance^2 / degrees_of_freedom over the causes
};

/// Adds an independent cause of uncertainty: its variance, and the degrees of freedom that the variance rests on.
void add_variance(EnergyEstimate& estimate, double variance_wh2, double degrees_of_freedom);

/// Both together, as if they were independent.
EnergyEstimate sum_of(const EnergyEstimate& a, const EnergyEstimate& b);

/// 95 % predictive interval [Wh]: Student's t with Welch and Satterthwaite's degrees of freedom. A low end below 0
/// becomes 0: a drone does not regenerate energy. std::nullopt without known uncertainty.
std::optional<Interval> interval_95(const EnergyEstimate& estimate);

/// A phase of the model as a prediction needs it.
struct WeightedPhase {
    PhaseModel model;
    double weight_square_sum = 1.0;  ///< of the flights' weights: variance of the average, relative to a flight's
};

/// The phase of a model with the weights of its flights (equal where the model has none).
WeightedPhase forecast_of(const MechanicalModel& model, flight::Phase phase);

/// The mean power of a phase, over the flights that count.
struct MeanPower {
    double mean_w = 0.0;               ///< of the flights' mean powers, by their weights
    std::optional<Interval> interval;  ///< 95 %, of the mean of all flights like these; absent of a single flight
    std::size_t flights = 0;
    std::size_t samples = 0;  ///< of all flights that have the phase
};

/// The interval is Student's t over two flights or more (VarianceComponents). A low end below 0 is 0. std::nullopt for a
/// model without the flights' mean powers.
std::optional<MeanPower> mean_power(const MechanicalModel& model, flight::Phase phase);

/// Energy of a phase of `duration_s`, before the flight: the time-scaled curve's integral. Its interval includes the
/// variability of the flights' mean powers and that of their average (docs/methods.md, Eq. 16).
EnergyEstimate predict_before_flight(const WeightedPhase& phase, double duration_s);

/// Of a phase with a constant power, such as predicted_power.
EnergyEstimate energy_of(const ConstantPower& power, double duration_s);

/// The same from `flown_s` on, without the measurements until then.
EnergyEstimate predict_remaining_before_flight(const WeightedPhase& phase, double flown_s, double remaining_s);

/// Prior mean of the cruise power.
enum class CruisePrior {
    curve,    ///< the model's Fourier curve
    constant  ///< the curve's mean, for flights whose power has no shape in common
};

/// The rest of a cruise in flight.
struct RemainingCruise {
    EnergyEstimate energy;
    double gain = 0.0;  ///< weight of the difference so far, 0 to 1; of predict_remaining_physical the flight's level
    double expected_w = 0.0;  ///< mean power so far, by the model
    double measured_w = 0.0;  ///< measured mean power so far
    double remaining_mean_w = 0.0;
    double beyond_w = 0.0;  ///< what a longer cruise takes more: the mean of the curve less that of its end
};

/// Correlations between flights of the phases' mean powers; 0 of two flights or fewer. Shrunk as if three more flights
/// had shown none (docs/methods.md, Eq. 20a).
using PhaseCorrelations = flight::PerPhase<flight::PerPhase<double>>;
PhaseCorrelations correlate_phases(std::span<const flight::PerPhase<std::optional<double>>> mean_powers_w);

/// The same of a model's flights; none where its file does not state their mean powers.
PhaseCorrelations correlate_phases(const MechanicalModel& model);

/// The sum over phases whose errors have these correlations.
EnergyEstimate sum_of(const flight::PerPhase<std::optional<EnergyEstimate>>& phases,
                      const PhaseCorrelations& correlations);

/// The duration of a phase of a flight to come.
struct DurationEstimate {
    double mean_s = 0.0;
    double sd_s = 0.0;                                                    ///< 0: it is known
    double degrees_of_freedom = std::numeric_limits<double>::infinity();  ///< of its Student t; infinite: normal
};

/// Estimates how far the duration of a phase differs from `planned_s`: as those of the model's flights do, in
/// proportion. Without two flights that have the phase, the sd is 0.
DurationEstimate estimate_duration(const MechanicalModel& model, flight::Phase phase, double planned_s);

/// Estimates the same for a phase ahead of a flight whose take-off took `takeoff_s`, by the regression on the take-offs
/// of the model's flights: who climbs for longer descends for longer (docs/methods.md, Eq. 20b). The correlation is
/// shrunk as correlate_phases does it.
DurationEstimate estimate_duration_after_takeoff(const MechanicalModel& model, flight::Phase phase, double planned_s,
                                                 double takeoff_s);

/// The rest of a flight, phase by phase; a phase without time left is empty.
struct RemainingFlight {
    flight::PerPhase<RemainingCruise> phases;
    EnergyEstimate total;
};

/// Bayes' rule for normal errors (docs/methods.md, Eqs. 19 to 20a): what was measured of every phase updates the
/// phases ahead by the covariances between flights. `model` has the phases with time flown or left. Throws
/// NoResultError if one of them has no variability.
RemainingFlight predict_remaining_flight(const flight::PerPhase<std::optional<WeightedPhase>>& model,
                                         const PhaseCorrelations& correlations,
                                         const flight::PerPhase<FlownPhase>& flown,
                                         const flight::PerPhase<double>& remaining_s, CruisePrior prior);

/// The rest of a cruise with known motion, in flight (predict_posterior_power), for each possible motion ahead. Throws
/// NoResultError if the model is of a single flight.
std::vector<RemainingCruise> predict_remaining_physical(const PhysicalModel& model, const FlightProgress& flown,
                                                        std::span<const MotionAhead> ahead);
RemainingCruise predict_remaining_physical(const PhysicalModel& model, const FlightProgress& flown,
                                           const MotionAhead& ahead);

}  // namespace flightwatt::mechanical

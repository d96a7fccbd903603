#pragma once

#include "mechanical/mechanical_model.h"
#include "mechanical/prediction/drift.h"
#include "mechanical/prediction/energy_estimate.h"
#include "mechanical/prediction/flight_progress.h"

namespace flightwatt::mechanical {

/// A phase of the model as a prediction needs it.
struct PhaseForecast {
    PhaseModel model;
    double weight_square_sum = 1.0;  ///< of the flights' weights: the average's variance, in flights'
};

/// The phase of a model with the weights of its flights (all alike where it does not say).
PhaseForecast forecast_of(const MechanicalModel& model, flight::Phase phase);

/// Energy of a phase that will take `duration_s`, before the flight: the stretched curve's integral. Its
/// interval holds the spread of the flights' mean powers (which contains what a flight drifts in a phase)
/// and that of their average: s^2 (1 + sum of w^2), n - 1 degrees of freedom.
EnergyEstimate predict_before_flight(const PhaseForecast& phase, double duration_s);

/// The same from `flown_s` on, without regard to what was measured until then.
EnergyEstimate predict_rest_before_flight(const PhaseForecast& phase, double flown_s, double remaining_s);

/// Where the cruise level is expected before this flight's own power is looked at.
enum class LevelSource {
    curve,     ///< the model's Fourier curve
    constant,  ///< the curve's mean, for flights whose power has no shape in common
    airspeed,  ///< the model's airspeed law at the airspeed measured so far, even over the time
    covariate  ///< the model's level law at what is known of its covariate, even over the time
};

/// The rest of a cruise in flight.
struct RestPrediction {
    EnergyEstimate energy;
    double gain = 0.0;        ///< 0: the model alone counts, 1: the difference seen so far goes on in full
    double expected_w = 0.0;  ///< mean power so far, as the model expected it
    double flown_w = 0.0;     ///< and as it was measured
    double remaining_mean_w = 0.0;
};

/// Shrinks between model and flight. With x and y the mean power so far and in what remains, less what the
/// model expects, variance B^2 of the flights' levels and the drift's V(T), C(u, R) within one:
///     var x = B^2 + V(u),  var y = B^2 + V(R),  cov = B^2 + C(u, R),  gain = cov / var x
///     y = gain x +- t sqrt(level share + drift share + gain share + shape share)
/// The error y - gain x has the variance (q the sum of the squared weights: the model is itself an average)
///     level share = (1 + q) (1 - gain)^2 B^2
///     drift share = (1 + q) (V(R) - 2 gain C(u, R) + gain^2 V(u))
/// whose sum is (1 + q) (var y - gain cov). They are split by what they rest on (the derivatives by B^2 and
/// by the drift's variance), so that Welch and Satterthwaite's degrees of freedom are right: most of the
/// error is drift where flights differ much, and a low estimate of the drift must not borrow the level's
/// freedom. Each has n - 1. B^2 and the drift are estimated from the same few flights, so the gain is
/// uncertain too: gain share = (1 + q) var x var gain, by the delta method. A level that is even over the
/// time adds the shape share, the square of what the model's curve would add. B^2 is the sample variance of
/// the flights' mean powers, from which the drift's part in them is not subtracted: between two or three
/// flights that difference is mostly noise and often 0, and then the interval would be far too narrow. Throws
/// NoAnswerError if the model has no spread or, for LevelSource::airspeed and covariate, no law, or the
/// flight did not measure what it asks for.
RestPrediction predict_rest(const PhaseForecast& cruise, const FlightProgress& flown, double remaining_s,
                            LevelSource source);

}  // namespace flightwatt::mechanical

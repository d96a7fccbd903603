#pragma once

#include "base/statistics.h"
#include "mechanical/mechanical_model.h"

#include <optional>
#include <string>
#include <vector>

namespace flightwatt::mechanical {

/// An estimate and, where its file has one, its 95 % interval.
struct Estimate {
    double value = 0.0;
    std::optional<Interval> interval;
};

/// The 95 % interval of b - a from theirs, which need not be symmetric, as of independent estimates (Eq. 42, Zou 2007):
/// too wide where both models contain the same flights. std::nullopt where one has none.
std::optional<Interval> interval_of_difference(const Estimate& a, const Estimate& b);

/// The cause of a difference's interval.
enum class DifferenceBasis {
    noise,    ///< noise of the samples of these flights
    flights,  ///< variability between flights of the same aircraft
    none      ///< no interval: the files have none
};
std::string to_string(DifferenceBasis basis);

/// One quantity in two models.
struct Difference {
    std::string part;              ///< the phase as files call it, or "physical"
    std::string quantity;          ///< with its unit as suffix: "a0_w"; of the physical model the term
    std::string unit;              ///< "W"
    std::optional<Estimate> a, b;  ///< absent where the model lacks it
    DifferenceBasis basis = DifferenceBasis::none;
    std::optional<Interval> interval = {};  ///< of b - a
    std::optional<double> at_s = {};        ///< of a curve: where in a's phase
};

/// b - a; std::nullopt where one lacks it.
std::optional<double> difference_of(const Difference& difference);

/// Whether its interval excludes 0; std::nullopt without one.
std::optional<bool> is_significant(const Difference& difference);

/// Coefficients, duration, mean power, energy and the maximum difference of the curves of each phase; then the terms of
/// the physical models (docs/methods.md, Two models).
std::vector<Difference> model_difference(const MechanicalModel& a, const MechanicalModel& b);

}  // namespace flightwatt::mechanical

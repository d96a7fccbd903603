#pragma once

#include "mechanical/mechanical_model.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace flightwatt::mechanical {

/// How many evenly spread points show every swing of the series over `duration_s`: 16 a period of its highest
/// harmonic, and at least 1000.
std::size_t points_of_curve(const FourierModel& model, double duration_s);

/// f [W] at the middles of `points` equal parts of the phase.
std::vector<double> curve_w(const FourierModel& model, double duration_s, std::size_t points);

/// The root mean square of the difference between two phases' curves [W], each over its own duration: the
/// curves are compared at equal parts of the phase, whatever the seconds.
double curve_rms_difference_w(const PhaseModel& a, const PhaseModel& b);

/// The series of `order` and that frequency which is nearest (least squares) to `power_w` at the parts `tau` of
/// a phase; std::nullopt if the frequency is too low for these to determine one.
std::optional<FourierModel> nearest_series(std::span<const double> tau, std::span<const double> power_w,
                                           int order, double omega_rad_per_s, double duration_s);

}  // namespace flightwatt::mechanical

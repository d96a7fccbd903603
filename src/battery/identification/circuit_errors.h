#pragma once

#include "battery/battery.h"
#include "battery/identification/circuit_fit.h"

#include <span>
#include <vector>

namespace flightwatt::battery {

/// 95 % intervals of a fitted circuit.
struct CircuitErrors {
    Interval resistance_ohm;
    Interval rc_resistance_ohm;   ///< not below 0
    Interval rc_time_constant_s;  ///< symmetric in the logarithm
    /// Half the knots' intervals over 1.96: what a normal distribution of the same interval has.
    std::vector<double> open_circuit_standard_error_v;
    std::size_t blocks = 0;  ///< of time, that the intervals rest on
    double block_s = 0.0;
};

/// Residuals of neighbouring samples are alike (the true curve is no polygon, the sensor rounds), so samples
/// do not count as independent, blocks of time do: the jackknife leaves each of about 30 blocks out of the
/// linearised fit (which is the sandwich estimator CR3; Bell and McCaffrey 2002, MacKinnon, Nielsen and Webb
/// 2023) and takes Student's t of the blocks less the parameters. From three records on it is done with whole
/// records too, and the wider interval counts: packs and days differ. Two errors that residuals do not show
/// come on top: rounding of a voltage that stands still, and how far a curve of twice the segments moves the
/// parameter.
CircuitErrors circuit_errors(std::span<const AlignedRecord> records, const CircuitFit& fit);

}  // namespace flightwatt::battery

#pragma once

#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/flight_data.h"
#include "flight/flight_phases.h"
#include "flight/power_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// An on-board counter of energy or charge, and how far the integral of the measurements in flight differs from it.
struct OnBoardCounter {
    const char* name;
    std::vector<double> value = {};              ///< at the times of the power samples; empty if not logged
    double resolution = 0.0;                     ///< the decimal place to which its values are rounded
    std::optional<double> closure_percent = {};  ///< integral over counter in flight, less 100 %
    double rounding_percent = 0.0;               ///< part of closure_percent that the counter's rounding explains
};

/// Throttle above which it counts as open [%].
inline constexpr double open_throttle_percent = 30.0;
/// Difference of an integral from its counter above which it is a fault [%].
inline constexpr double max_counter_difference_percent = 10.0;

/// Input of the rules: power and related tracks on the clock of the power samples (empty if not logged), and values
/// derived from them.
struct PowerRecord {
    /// Whether the aircraft flies or rests at a sample.
    enum class State { flight, rest, neither };

    std::vector<double> time_s;
    std::vector<double> power_w;
    std::vector<double> voltage_v;
    std::vector<double> current_a;
    OnBoardCounter energy_wh{"energy"};
    OnBoardCounter charge_ah{"charge"};
    std::vector<double> throttle_percent;
    std::vector<double> altitude_m;
    std::vector<double> altitude_time_s;  ///< the altitude's own clock
    bool is_sum_of_circuits = false;      ///< the power is the sum of circuits with voltages of their own
    std::string power_source;             ///< "ENERGY.power"
    std::vector<Sortie> sorties;
    TimeInterval part = FlightPhases{}.part;  ///< see there
    std::vector<IndexSpan> in_flight;         ///< indices of the samples of each sortie
    double energy_j = 0.0;                    ///< in flight
    double duration_s = 0.0;                  ///< in flight

    // Derived from the members above by derive_facts().
    std::vector<SampleGap> gaps;  ///< of the power samples
    std::optional<IdleCurrent>
        at_rest;  ///< current with the motor off; without a throttle at rest outside of the sorties
    std::vector<std::optional<IdleCurrent>>
        rests;                           ///< the same before the first sortie, after it, ... and after the last
    std::vector<State> states;           ///< of each sample; `rest` only with the motor off
    std::vector<double> step_s;          ///< weight of each sample: half of both intervals, at most a gap's length
    std::vector<double> usual_w;         ///< median at the same throttle in flight; NaN if unknown
    std::vector<double> smooth_w;        ///< running median of the power over 11 samples
    std::vector<double> smooth_percent;  ///< running median of the throttle over 11 samples
    std::size_t update_samples = 1;      ///< median number of samples for which the current (or power) is the same
    bool is_clipped = false;             ///< the highest current is reached again and again: the sensor's limit
    double powerless_w = 0.0;            ///< highest power that counts as zero, with an open throttle
    double power_sum_w = 0.0;            ///< sum over the samples in flight; the values below are of these too
    double mean_a = 0.0;
    double max_a = 0.0;
    double min_v = std::numeric_limits<double>::quiet_NaN();
    double max_v = std::numeric_limits<double>::quiet_NaN();

    bool is_flown(std::size_t i) const { return states[i] == State::flight; }
    /// Whether a sample is outside of the sorties, and of those that were left out.
    bool is_outside(std::size_t i) const { return !is_flown(i) && time_s[i] >= part.start_s && time_s[i] < part.end_s; }
    bool is_at_rest(std::size_t i) const { return states[i] == State::rest; }
    bool has_current() const { return !current_a.empty(); }
    bool has_throttle() const { return !throttle_percent.empty(); }
    bool has_open_throttle(std::size_t i) const {
        return has_throttle() && throttle_percent[i] > open_throttle_percent;
    }
    double rest_percent() const {  ///< current at rest, of the mean in flight
        return units::percentage(std::abs(at_rest->mean_a), std::max(std::abs(mean_a), 1e-9));
    }
    bool is_counted() const { return energy_wh.closure_percent || charge_ah.closure_percent; }
    std::array<const OnBoardCounter*, 2> counters() const { return {&energy_wh, &charge_ah}; }
};

/// Returns the record of a flight with all derived values.
PowerRecord make_power_record(const FlightData& data, const FlightPhases& phases, const SegmentationOptions& options);

/// Sets the derived values of a record. `resting` are the indices of the samples at rest with the motor off (without a
/// throttle: at rest outside of the sorties).
void derive_facts(PowerRecord& record, const std::vector<std::size_t>& resting);

/// Returns the change of a counter between two times, in its unit.
double counter_change(const PowerRecord& record, const OnBoardCounter& counter, double start_s, double end_s);

/// Returns the gaps of samples within sorties or at their edges.
std::vector<SampleGap> find_flight_gaps(const std::vector<double>& time_s, const std::vector<Sortie>& sorties);

}  // namespace flightwatt::flight

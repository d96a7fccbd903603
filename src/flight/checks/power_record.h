#pragma once

#include "base/units.h"
#include "flight/checks/runs.h"
#include "flight/flight_phases.h"
#include "flight/power_check.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace flightwatt::flight {

/// An on-board counter, and how far what was measured in flight is away from it.
struct OnBoardCounter {
    const char* name;
    std::vector<double> value = {};  ///< at the times of the power samples; empty if not logged
    double resolution = 0.0;         ///< the decimal place that it is rounded to
    std::optional<double> closure_percent = {};
    double rounding_percent = 0.0;  ///< what the rounding may add to that

    bool is_beyond(double limit_percent) const {
        return closure_percent && std::abs(*closure_percent) > limit_percent + rounding_percent;
    }
};

/// A throttle above this is open [%].
inline constexpr double open_throttle_percent = 30.0;

/// What the power's sensor and counters say, on the clock of the power samples, as the rules ask for it. Empty where
/// not logged.
struct PowerRecord {
    enum class Place { flight, rest, neither };

    std::vector<double> time_s;
    std::vector<double> power_w;
    std::vector<double> voltage_v;
    std::vector<double> current_a;
    OnBoardCounter energy_wh{"energy"};
    OnBoardCounter charge_ah{"charge"};
    std::vector<double> throttle_percent;
    std::vector<double> altitude_m;
    std::vector<double> altitude_time_s;  ///< the altitude's own clock
    bool is_sum_of_circuits = false;      ///< with voltages of their own
    std::string power_source;             ///< "ENERGY.power"
    std::vector<Sortie> sorties;
    std::vector<IndexSpan> in_flight;  ///< the samples of each sortie
    double energy_j = 0.0;             ///< in flight
    double duration_s = 0.0;

    // By add_facts(), from all above.
    std::vector<SampleGap> gaps;                    ///< of the power samples
    std::optional<IdleCurrent> at_rest;             ///< also where no throttle tells that the motor is off
    std::vector<std::optional<IdleCurrent>> rests;  ///< the same before the first sortie, after it, ... the last
    std::vector<Place> places;                      ///< of each sample; at rest is only what has its motor off
    std::vector<double> step_s;   ///< for which each sample counts: half of both intervals, a gap's length at most
    std::vector<double> usual_w;  ///< the median at the same throttle in flight; NaN where it is not known
    double powerless_w = 0.0;     ///< no more is hardly anything, with an open throttle
    double power_sum_w = 0.0;     ///< of the samples in flight, as all below
    double mean_a = 0.0;
    double max_a = 0.0;
    double min_v = std::numeric_limits<double>::quiet_NaN();
    double max_v = std::numeric_limits<double>::quiet_NaN();

    bool is_flown(std::size_t i) const { return places[i] == Place::flight; }
    bool is_at_rest(std::size_t i) const { return places[i] == Place::rest; }
    bool has_current() const { return !current_a.empty(); }
    bool has_throttle() const { return !throttle_percent.empty(); }
    bool is_open(std::size_t i) const { return has_throttle() && throttle_percent[i] > open_throttle_percent; }
    double rest_percent() const {  ///< the current at rest, of the mean in flight
        return units::percentage(std::abs(at_rest->mean_a), std::max(std::abs(mean_a), 1e-9));
    }
    bool is_counted() const { return energy_wh.closure_percent || charge_ah.closure_percent; }
    std::array<const OnBoardCounter*, 2> counters() const { return {&energy_wh, &charge_ah}; }
};

PowerRecord make_power_record(const SelectedTracks& tracks, const FlightPhases& phases,
                              const SegmentationOptions& options);

/// `resting`: the indices of the samples at rest on the ground with the motor off (where no throttle tells that of the
/// motor, at rest outside of the sorties).
void add_facts(PowerRecord& record, const std::vector<std::size_t>& resting);

/// What a counter counted between two times.
double counted(const PowerRecord& record, const OnBoardCounter& counter, double start_s, double end_s);

/// The gaps within, or at the edges of, sorties.
std::vector<SampleGap> gaps_in(const std::vector<double>& time_s, const std::vector<Sortie>& sorties);

}  // namespace flightwatt::flight

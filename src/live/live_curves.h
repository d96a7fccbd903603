#pragma once

#include "live/live_flight.h"

#include <cstddef>
#include <vector>

namespace flightwatt::live {

/// A quantity over the telemetry's time.
struct TimeCurve {
    std::vector<double> time_s;
    std::vector<double> value;
};

/// A quantity as it was, in bounded memory: where it is full, every second point is kept, and from then on every second
/// one is taken.
class CurveHistory {
  public:
    static constexpr std::size_t max_points = 2000;

    /// `time_s` rises; what does not begins anew.
    void add(double time_s, double value);
    const TimeCurve& curve() const { return curve_; }

  private:
    TimeCurve curve_;
    std::size_t stride_ = 1;
    std::size_t added_ = 0;
};

/// The state of charge ahead as it is predicted, from now to the landing or to where the battery fails, in up to about
/// a hundred points; empty where there is no prediction with a battery.
TimeCurve soc_ahead(const LiveState& state, const PredictionInput& basis);

}  // namespace flightwatt::live

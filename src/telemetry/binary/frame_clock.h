#pragma once

#include <cstdint>

namespace flightwatt::telemetry {

/// The time of card frames, which starts anew after 119.3 h. It is taken to have done so where a time is before the
/// last one and, counted across the end of the range, less than an hour behind it: a damaged time or a clock that was
/// set back does not count as one.
class FrameClock {
  public:
    double time_s(std::uint32_t time_100us) {
        constexpr std::uint32_t hour = 36'000'000;
        auto round = round_;
        if (time_100us < last_ && time_100us - last_ < hour) {
            round = ++round_;
            last_ = time_100us;
        } else if (time_100us > last_ && last_ - time_100us < hour && round_ > 0) {
            --round;  // a frame from before, late
        } else {
            last_ = time_100us;
        }
        constexpr double ticks_per_s = 10'000.0;
        return static_cast<double>(round << 32 | time_100us) / ticks_per_s;
    }

  private:
    std::uint64_t round_ = 0;
    std::uint32_t last_ = 0;
};

}  // namespace flightwatt::telemetry

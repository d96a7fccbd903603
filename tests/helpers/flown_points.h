#pragma once

#include "helpers/sample_columns.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace flightwatt::test {

/// A made-up flight is points in time, linear between them.
struct Point {
    double time_s;
    double altitude_m;
    double throttle_percent;
};

inline SampleColumns columns_of(const std::vector<Point>& points, double interval_s = 1.1) {
    SampleColumns series;
    std::size_t next = 1;
    for (double t = points.front().time_s; t <= points.back().time_s; t += interval_s) {
        while (points[next].time_s < t) ++next;
        const auto& a = points[next - 1];
        const auto& b = points[next];
        const double part = (t - a.time_s) / (b.time_s - a.time_s);
        series.time_s.push_back(t);
        series.altitude_m.push_back(std::lerp(a.altitude_m, b.altitude_m, part));
        series.throttle_percent.push_back(std::lerp(a.throttle_percent, b.throttle_percent, part));
        series.power_w.push_back(series.throttle_percent.back());
    }
    return series;
}

inline flight::FlightSeries series_of(const std::vector<Point>& points) { return series_of(columns_of(points)); }

/// Ground, take-off at `begin_s`, 300 s at 100 m, landing.
inline std::vector<Point> sortie(double begin_s, double ground_m = 0.0) {
    const double top = ground_m + 100.0;
    return {{begin_s - 40, ground_m, 0}, {begin_s - 2, ground_m, 0},  {begin_s - 1, ground_m, 90},
            {begin_s, ground_m, 90},     {begin_s + 30, top, 90},     {begin_s + 31, top, 60},
            {begin_s + 330, top, 60},    {begin_s + 331, top - 2, 0}, {begin_s + 370, ground_m, 0},
            {begin_s + 420, ground_m, 0}};
}

}  // namespace flightwatt::test

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::test {

/// A moment of a flight that tables of other programs show.
struct Moment {
    double t_s;
    double volt;
    double ampere;
    double height_m;
    double charge_mah;  ///< drawn since the beginning
    std::string clock;  ///< HH:MM:SS, across midnight
    int day;
};

/// A flight of 200 s, from 30 s to 230 s at 5 Hz, to 60 m and back; 16 V, 20 A in the air.
inline std::vector<Moment> table_flight() {
    std::vector<Moment> moments;
    double charge_mah = 0.0;
    for (int i = 0; i <= 5 * 260; ++i) {
        const double t_s = i / 5.0;
        const bool flies = t_s >= 30.0 && t_s <= 230.0;
        const double height_m = t_s < 30.0 || t_s > 230.0 ? 0.0
                                : t_s < 50.0              ? 3.0 * (t_s - 30.0)
                                : t_s < 200.0             ? 60.0 + 0.5 * (i % 2)
                                                          : 2.0 * (230.0 - t_s);
        const int second = (23 * 60 + 58) * 60 + static_cast<int>(t_s);
        const auto clock =
            fmt::format("{:02}:{:02}:{:02}.{:03}", second / 3600 % 24, second / 60 % 60, second % 60, i % 5 * 200);
        const double ampere = flies ? 20.0 + 0.1 * (i % 7) : 0.3 + 0.01 * (i % 2);
        moments.push_back(
            {t_s, 16.0 + 0.01 * (i % 3), ampere, height_m, charge_mah, clock, second < 24 * 3600 ? 2 : 3});
        charge_mah += ampere / 5.0 / 3.6;
    }
    return moments;
}

/// Its energy from 30 to 230 s [Wh].
inline double table_flight_wh() {
    double energy_j = 0.0;
    for (const auto& at : table_flight())
        if (at.t_s >= 30.0 && at.t_s < 230.0) energy_j += at.volt * at.ampere / 5.0;
    return energy_j / 3600.0;
}

/// A table of it: a header, and what `row` makes of each moment.
template <typename Row>
std::string flight_table(const std::string& header, const Row& row) {
    auto text = header + "\n";
    for (const auto& at : table_flight()) text += row(at) + "\n";
    return text;
}

}  // namespace flightwatt::test

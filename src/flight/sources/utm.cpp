#include "flight/sources/utm.h"

#include "base/units.h"

#include <cmath>
#include <limits>

namespace flightwatt::flight {

Position position_of_utm(double east_m, double north_m, double zone) {
    if (!(zone >= 1.0 && zone <= 60.0) || !std::isfinite(east_m) || !std::isfinite(north_m)) {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        return {unknown, unknown};
    }
    constexpr double equator_m = 6378137.0;
    constexpr double flattening = 1.0 / 298.257223563;
    constexpr double scale = 0.9996;
    constexpr double false_east_m = 500e3;
    constexpr double n = flattening / (2.0 - flattening);
    constexpr double meridian_m = equator_m / (1.0 + n) * (1.0 + n * n / 4.0 + n * n * n * n / 64.0);
    constexpr double beta[] = {n / 2.0 - 2.0 / 3.0 * n * n + 37.0 / 96.0 * n * n * n,
                               n * n / 48.0 + n * n * n / 15.0, 17.0 / 480.0 * n * n * n};
    constexpr double delta[] = {2.0 * n - 2.0 / 3.0 * n * n - 2.0 * n * n * n,
                                7.0 / 3.0 * n * n - 8.0 / 5.0 * n * n * n, 56.0 / 15.0 * n * n * n};
    const double xi = north_m / (scale * meridian_m);
    const double eta = (east_m - false_east_m) / (scale * meridian_m);
    double xi_0 = xi;
    double eta_0 = eta;
    for (int j = 1; j <= 3; ++j) {
        xi_0 -= beta[j - 1] * std::sin(2 * j * xi) * std::cosh(2 * j * eta);
        eta_0 -= beta[j - 1] * std::cos(2 * j * xi) * std::sinh(2 * j * eta);
    }
    const double conformal = std::asin(std::sin(xi_0) / std::cosh(eta_0));
    double latitude = conformal;
    for (int j = 1; j <= 3; ++j) latitude += delta[j - 1] * std::sin(2 * j * conformal);
    const double from_meridian = std::atan2(std::sinh(eta_0), std::cos(xi_0));
    constexpr double degree_per_zone = 6.0;
    constexpr double first_meridian_deg = -183.0;
    return {latitude * units::degree_per_rad,
            first_meridian_deg + degree_per_zone * zone + from_meridian * units::degree_per_rad};
}

}  // namespace flightwatt::flight

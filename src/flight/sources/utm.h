#pragma once

namespace flightwatt::flight {

struct Position {
    double latitude_deg = 0.0;
    double longitude_deg = 0.0;
};

/// The position on WGS 84 of UTM coordinates as Paparazzi logs them: the north has no false origin, so it is
/// negative in the south. NaN where one of them is NaN or the zone is none of 1 to 60. Krueger's series to
/// the third order (Karney, Transverse Mercator with an accuracy of a few nanometers, J. Geodesy 85, 2011):
/// better than a millimetre.
Position position_of_utm(double east_m, double north_m, double zone);

}  // namespace flightwatt::flight

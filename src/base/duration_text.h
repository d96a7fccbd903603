#pragma once

#include <string>

namespace flightwatt {

/// A duration for people: "12.3 s", from a minute on in whole seconds "28 min 32 s", from an hour on in whole minutes
/// "1 h 3 min". Parts that are 0 are left out: "28 min". Not finite: "-".
std::string duration_text(double seconds);

}  // namespace flightwatt

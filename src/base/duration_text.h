#pragma once

#include <string>

namespace flightwatt {

/// A duration for people: "27.5 s", from a minute on in whole seconds "28 min 32 s", "1 h 2 min 5 s"; last parts that
/// are 0 are left out: "28 min". Values that are not finite, or beyond 1e9 s, are in seconds.
std::string duration_text(double duration_s);

}  // namespace flightwatt

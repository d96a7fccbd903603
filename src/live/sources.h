#pragma once

#include "live/source.h"

#include <memory>
#include <string_view>

namespace flightwatt::live {

/// The Ivy bus that `bus` names ("127.255.255.255:2010"): what aircraft say, and what a log player says of them. Times
/// are a replay's own, else of arrival (seconds since the bus was opened, times `clock_factor`). Throws UsageError for
/// no bus, InputError where it cannot be opened.
std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor = 1.0);

}  // namespace flightwatt::live

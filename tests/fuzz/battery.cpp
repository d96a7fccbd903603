// A battery.

#include "battery/battery.h"

#include "battery/battery_toml.h"
#include "fuzz/fuzz_target.h"

void flightwatt::fuzz::run(std::string_view bytes) { battery::read_battery(as_file(bytes, "fuzz.toml")); }

// A power profile: CSV of ours or of powprofiler.

#include "compute/profile_reader.h"
#include "fuzz/fuzz_target.h"

void flightwatt::fuzz::run(std::string_view bytes) { compute::read_power_profile(as_file(bytes, "fuzz.csv")); }

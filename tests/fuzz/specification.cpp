// A specification of what to profile.

#include "compute/profile_specification.h"
#include "fuzz/fuzz_target.h"

void flightwatt::fuzz::run(std::string_view bytes) { compute::parse_profile_specification(bytes, "fuzz.toml"); }

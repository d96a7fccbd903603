// A .cfg of powprofiler, as a profile.

#include "compute/profile_reader.h"
#include "fuzz/fuzz_target.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    const auto file = as_file(bytes, "fuzz.cfg");
    compute::read_power_profile(file, {{"fps"}, {}, {"fuzz"}});
}

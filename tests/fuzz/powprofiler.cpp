// A .cfg of powprofiler, as a specification and as a profile.

#include "base/error.h"
#include "compute/profile_reader.h"
#include "compute/profile_specification.h"
#include "fuzz/fuzz_target.h"

void flightwatt::fuzz::run(std::string_view bytes) {
    const auto file = as_file(bytes, "fuzz.cfg");
    try {
        compute::read_profile_specification(file);
    } catch (const InputError&) {
    }
    compute::read_power_profile(file, {{"fps"}, {}, {"fuzz"}});
}

#pragma once

#include "base/toml_reader.h"
#include "compute/sensors/power_sampler.h"

#include <filesystem>

namespace flightwatt::compute {

/// The [sampler] of a profile's specification (profile_specification.h), or what it is by default; `folder`
/// is what its paths are relative to. Throws InputError.
SamplerSettings read_sampler_settings(const TomlTable& root, const std::filesystem::path& folder);

}  // namespace flightwatt::compute

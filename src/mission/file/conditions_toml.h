#pragma once

#include "base/toml_reader.h"
#include "mechanical/mechanical_model.h"

#include <optional>

namespace flightwatt::mission {

/// Reads a mission's [conditions], one key: the covariate that the model's cruise level follows, such as
/// airspeed_m_per_s = 14. Shifts the model's cruise so that its mean over the model's own duration is the
/// level law's power there, and returns that power with its spread. Throws InputError for a model without a
/// law, another covariate, and a value beyond what the flights of the law showed: what is planned can be
/// changed, and a power that nothing supports should not look like a result.
mechanical::ConstantPower apply_conditions(const TomlTable& conditions,
                                           std::optional<mechanical::MechanicalModel>& mechanical);

}  // namespace flightwatt::mission

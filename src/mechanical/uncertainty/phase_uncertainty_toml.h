#pragma once

#include "base/toml_reader.h"
#include "mechanical/uncertainty/phase_uncertainty.h"

#include <cstddef>
#include <string>

/// The optional tables [PHASE.errors] and [PHASE.spread] of a model file.
namespace flightwatt::mechanical {

/// Throw InputError with its place for a missing or unknown key, a standard error, condition or correlation
/// that cannot be, other numbers of errors than the phase has coefficients (`order`), envelopes of unequal
/// length or upside down.
PhaseErrors read_errors(const TomlTable& table, std::size_t order);
PhaseSpread read_spread(const TomlTable& table);

/// The table's keys and values, without its heading.
std::string to_toml(const PhaseErrors& errors);
std::string to_toml(const PhaseSpread& spread);

}  // namespace flightwatt::mechanical

#pragma once

#include "cli/stage.h"
#include "mechanical/model_fit.h"

#include <optional>

namespace flightwatt::cli {

/// Whether a stage can choose the order by itself ("--order auto").
enum class AutoOrder { refused, accepted };

/// The options of a fit, which several stages share.
void add_fit_options(boost::program_options::options_description& options, AutoOrder automatic = AutoOrder::refused);

/// --order as a number; std::nullopt for "auto" where that is accepted. Throws UsageError for another text.
std::optional<int> read_order(const StageCall& call, AutoOrder automatic);

/// What the user gave of them. Where the order is to be chosen it is left at the default. Throws UsageError
/// for options that make no sense or exclude each other.
mechanical::ModelFitOptions read_fit_options(const StageCall& call, AutoOrder automatic = AutoOrder::refused);

}  // namespace flightwatt::cli

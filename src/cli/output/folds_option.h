#pragma once

#include "cli/stage.h"

#include <cstddef>

namespace flightwatt::cli {

/// --folds N: into how many groups flights are parted that are left out together.
void add_folds_option(boost::program_options::options_description& options, std::size_t usual);

/// Says so where flights are not left out alone.
void note_folds(const StageCall& call, std::size_t flights, std::size_t folds);

}  // namespace flightwatt::cli

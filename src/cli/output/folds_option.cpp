#include "cli/output/folds_option.h"

#include "cli/numeric_options.h"

#include <string>

#include <fmt/format.h>

namespace flightwatt::cli {

void add_folds_option(boost::program_options::options_description& options, std::size_t usual) {
    options.add_options()("folds", value("N")->default_value(std::to_string(usual)),
                          "leave more flights than N out in N groups, not each alone: the time then grows with the "
                          "flights, not with their square");
}

void note_folds(const StageCall& call, std::size_t flights, std::size_t folds) {
    if (flights <= folds) return;
    note(call,
         fmt::format("{0} flights are left out in {1} groups, not each alone, which --folds {0} does", flights, folds));
}

}  // namespace flightwatt::cli

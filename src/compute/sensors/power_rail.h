#pragma once

#include <functional>
#include <string>
#include <vector>

namespace flightwatt::compute {

/// A supply line of a board, and how its power now is read [W]. `read` throws InputError naming the file.
struct PowerRail {
    std::string name;    ///< the board's name for it, "VDD_IN"
    std::string source;  ///< the files
    std::function<double()> read;
};

/// Which of the rails (by name) add up to the power of the board: those `wanted`; else the one that is known
/// to carry everything (VDD_IN, POM_5V_IN, ...); else all but those that are fed by another rail. Returns
/// indices. Throws NoAnswerError for one wanted that is not there, listing those that are.
std::vector<std::size_t> rails_of_total(const std::vector<std::string>& names,
                                        const std::vector<std::string>& wanted);

}  // namespace flightwatt::compute

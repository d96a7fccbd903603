#pragma once

#include <cstddef>
#include <functional>

namespace flightwatt::cli {

/// What the standard output can show.
struct TerminalAbility {
    bool draws = false;   ///< a terminal that shows Unicode
    bool colors = false;  ///< and wants colours (no-color.org)
    std::size_t columns = 80;
};

/// The value of an environment variable, or nullptr.
using Environment = std::function<const char*(const char* name)>;

/// What a terminal of so many columns can show, after TERM (not "dumb"), the locale (LC_ALL, LC_CTYPE, LANG:
/// UTF-8) and NO_COLOR.
TerminalAbility ability_of(bool is_terminal, std::size_t columns, const Environment& environment);

/// The same of the standard output of this program.
TerminalAbility standard_output_ability();

}  // namespace flightwatt::cli

#include "cli/terminal.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

std::string_view value_of(const Environment& environment, const char* name) {
    const char* value = environment(name);
    return value == nullptr ? std::string_view() : std::string_view(value);
}

/// The first of the three that is set decides, as in setlocale.
bool is_utf8(const Environment& environment) {
    for (const auto* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
        std::string locale(value_of(environment, name));
        if (locale.empty()) continue;
        std::transform(locale.begin(), locale.end(), locale.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        return locale.ends_with("utf-8") || locale.ends_with("utf8");
    }
    return false;
}

}  // namespace

TerminalAbility ability_of(bool is_terminal, std::size_t columns, const Environment& environment) {
    TerminalAbility ability;
    if (columns > 0) ability.columns = columns;
    const auto kind = value_of(environment, "TERM");
    ability.draws = is_terminal && !kind.empty() && kind != "dumb" && is_utf8(environment);
    ability.colors = ability.draws && value_of(environment, "NO_COLOR").empty();
    return ability;
}

TerminalAbility standard_output_ability() {
    winsize size{};
    const bool known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0;
    return ability_of(::isatty(STDOUT_FILENO) != 0, known ? size.ws_col : 0,
                      [](const char* name) { return std::getenv(name); });
}

}  // namespace flightwatt::cli

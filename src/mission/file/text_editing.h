#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <toml++/toml.h>

namespace flightwatt::mission {

/// Without a byte order mark, and with the line ends of Unix.
std::string normalise_text(std::string_view text);

/// The text of a mission file that says what `wanted` says, with its comments, its order and its numbers as they were
/// written: without its plan, policy and schedule and the comments directly above and in them, with other names of
/// files, and with a format if it had none. `read` is what `text`, a plain one, says. std::nullopt for a text that is
/// written in a way that this does not follow; what it gives was read again and says what `wanted` says.
std::optional<std::string> edit_keeping_comments(std::string_view text, const toml::table& read,
                                                 const toml::table& wanted);

}  // namespace flightwatt::mission

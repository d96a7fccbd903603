#pragma once

#include "record/json_type.h"

#include <string>
#include <string_view>

namespace flightwatt::report {

/// Returns a document as plain HTML that is read without scripts: answers, missions, flights and facts. The front end
/// replaces it.
std::string plain_answers(const Json& document);

/// Escapes text for HTML, with spaces for control characters.
std::string html_escaped(std::string_view text);

}  // namespace flightwatt::report

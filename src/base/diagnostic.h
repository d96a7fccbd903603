#pragma once

#include <compare>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt {

/// A note is harmless; a warning makes a number uncertain; an error keeps a flight out of the result.
enum class Severity { note, warning, error };

/// "note", "warning" or "error".
std::string_view to_string(Severity severity);

/// The severity of that name. Throws std::out_of_range for another text.
Severity severity_from(std::string_view name);

/// A finding for the user.
struct Diagnostic {
    Severity severity = Severity::warning;
    std::string kind = {};  ///< a few stable words, the heading of its group: "gaps in the power"; empty: no group
    std::string text = {};
    std::string flight = {};                              ///< empty: of no flight
    auto operator<=>(const Diagnostic&) const = default;  // NOLINT(modernize-use-nullptr): it takes the 0 of "< 0"
};
using Diagnostics = std::vector<Diagnostic>;

/// Appends each text as a finding of the flight.
void append(Diagnostics& diagnostics, Severity severity, const std::string& kind, const std::string& flight,
            const std::vector<std::string>& texts);

/// The first words of a reason, which others share: up to a colon, parentheses, or a word with a digit, such as a number
/// or the name of a log. "has no flight" of "has no flight in 48 s; no motion".
std::string kind_of_reason(const std::string& reason);

/// The texts of the findings of at least this severity.
std::vector<std::string> texts_of(const Diagnostics& diagnostics, Severity least = Severity::note);

/// The findings, each once, in groups of one severity and kind: errors first, notes last, and otherwise in the order of
/// the first of each group. One without a kind is a group of its own.
std::vector<Diagnostics> grouped(const Diagnostics& diagnostics);

}  // namespace flightwatt

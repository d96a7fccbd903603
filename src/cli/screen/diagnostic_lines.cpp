#include "cli/screen/diagnostic_lines.h"

#include "base/text.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::cli {
namespace {

/// The flights of a group, each once.
std::vector<std::string> flights_of(const Diagnostics& group) {
    std::vector<std::string> flights;
    std::set<std::string_view> known{""};
    for (const auto& diagnostic : group)
        if (known.insert(diagnostic.flight).second) flights.push_back(diagnostic.flight);
    return flights;
}

/// "warning: FLIGHT: ..."; an error begins with its place, as errors of compilers do.
std::string line_of(const Diagnostic& diagnostic) {
    const auto& [severity, kind, text, flight] = diagnostic;
    if (flight.empty()) return fmt::format("{}: {}", to_string(severity), text);
    return severity == Severity::error ? fmt::format("{}: error: {}", flight, text)
                                       : fmt::format("{}: {}: {}", to_string(severity), flight, text);
}

/// "5 logs (a, b, c and 2 more)".
std::string counted(const std::vector<std::string>& flights) {
    constexpr std::size_t max_named = 3;
    const auto named = std::min(flights.size(), max_named);
    const auto more = flights.size() - named;
    return fmt::format("{} logs ({}{})", flights.size(), fmt::join(flights.begin(), flights.begin() + named, ", "),
                       more > 0 ? fmt::format(" and {} more", more) : "");
}

std::string line_of_group(const Diagnostics& group) {
    const auto& first = group.front();
    const auto flights = flights_of(group);
    if (flights.size() > 1)
        return fmt::format("{}: {}: {}, the first: {}", to_string(first.severity), first.kind, counted(flights),
                           first.text);
    const auto more = group.size() - 1;
    return line_of(first) + (more > 0 ? fmt::format(" (and {} more)", more) : "");
}

}  // namespace

std::vector<std::string> diagnostic_lines(const Diagnostics& diagnostics, bool with_notes) {
    constexpr std::size_t max_errors = 5;
    std::vector<std::string> lines;
    const bool lists_all = with_notes || flights_of(diagnostics).size() < 2;
    for (const auto& group : grouped(diagnostics)) {
        const auto severity = group.front().severity;
        if (severity == Severity::note && !with_notes) continue;
        if (lists_all || (severity == Severity::error && group.size() <= max_errors))
            std::ranges::transform(group, std::back_inserter(lines), line_of);
        else
            lines.push_back(line_of_group(group));
    }
    return lines;
}

std::string notes_line(const Diagnostics& diagnostics) {
    std::vector<std::string> kinds;
    for (const auto& group : grouped(diagnostics)) {
        const auto& first = group.front();
        if (first.severity != Severity::note) continue;
        const auto logs = flights_of(group).size();
        kinds.push_back((first.kind.empty() ? first.text : first.kind) +
                        (logs > 1 ? fmt::format(" ({} logs)", logs) : ""));
    }
    return kinds.empty() ? "" : fmt::format("notes: {}; --notes lists them", fmt::join(kinds, ", "));
}

}  // namespace flightwatt::cli

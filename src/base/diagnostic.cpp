#include "base/diagnostic.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace flightwatt {
namespace {

constexpr std::array<std::string_view, 3> severity_names{"note", "warning", "error"};

}  // namespace

std::string_view to_string(Severity severity) { return severity_names.at(static_cast<std::size_t>(severity)); }

Severity severity_from(std::string_view name) {
    const auto found = std::ranges::find(severity_names, name);
    if (found == severity_names.end()) throw std::out_of_range("no severity: " + std::string(name));
    return static_cast<Severity>(found - severity_names.begin());
}

void append(Diagnostics& diagnostics, Severity severity, const std::string& kind, const std::string& flight,
            const std::vector<std::string>& texts) {
    for (const auto& text : texts) diagnostics.push_back({severity, kind, text, flight});
}

std::string kind_of_reason(const std::string& reason) {
    const std::set<std::string> joins{"", "a", "as", "at", "by", "in", "its", "of", "than", "the", "to"};
    auto kind = reason.substr(0, reason.find_first_of(":;,("));
    if (const auto digit = kind.find_first_of("0123456789"); digit != std::string::npos)
        kind.resize(kind.rfind(' ', digit) + 1);  // before "48", and before the name "f_2"
    for (auto last = kind.size(); last != std::string::npos && joins.contains(kind.substr(last));) {
        kind.resize(last);
        while (kind.ends_with(' ')) kind.pop_back();
        last = kind.rfind(' ');
        last += last == std::string::npos ? 0 : 1;
    }
    return kind;
}

std::vector<std::string> texts_of(const Diagnostics& diagnostics, Severity least) {
    std::vector<std::string> texts;
    for (const auto& diagnostic : diagnostics)
        if (diagnostic.severity >= least) texts.push_back(diagnostic.text);
    return texts;
}

std::vector<Diagnostics> grouped(const Diagnostics& diagnostics) {
    std::vector<Diagnostics> groups;
    std::map<std::pair<Severity, std::string>, std::size_t> numbers;
    std::set<Diagnostic> known;
    for (const auto& diagnostic : diagnostics) {
        if (!known.insert(diagnostic).second) continue;
        const auto next = groups.size();
        const auto number = diagnostic.kind.empty()
                                ? next
                                : numbers.emplace(std::pair(diagnostic.severity, diagnostic.kind), next).first->second;
        if (number == next) groups.emplace_back();
        groups[number].push_back(diagnostic);
    }
    std::ranges::stable_sort(groups, std::greater{}, [](const Diagnostics& group) { return group.front().severity; });
    return groups;
}

}  // namespace flightwatt

#include "base/toml_reader.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace flightwatt {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const auto substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row.back();
}

/// The shortest name that contains the word, one that begins with it before others; empty if none does.
std::string name_with_part(std::string_view word, const std::vector<std::string>& known) {
    constexpr std::size_t min_part = 3;
    if (word.size() < min_part) return {};
    const auto rank = [&](const std::string& name) { return std::pair(!name.starts_with(word), name.size()); };
    const std::string* best = nullptr;
    for (const auto& name : known)
        if (name.find(word) != std::string::npos && (best == nullptr || rank(name) < rank(*best))) best = &name;
    return best == nullptr ? "" : *best;
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
    constexpr std::size_t max_word = 100;
    std::string nearest;
    if (word.size() > max_word) return nearest;
    if (nearest = name_with_part(word, known); !nearest.empty()) return nearest;
    std::size_t best = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const auto& candidate : known) {
        if (candidate.size() > max_word) continue;
        const auto distance = edit_distance(word, candidate);
        if (distance < best) {
            best = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

}  // namespace flightwatt

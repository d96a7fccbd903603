#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::flight {

/// The phases of a sortie that are modelled; what lies between sorties is ground.
enum class Phase { takeoff, cruise, landing };

inline constexpr std::array all_phases{Phase::takeoff, Phase::cruise, Phase::landing};

constexpr std::string_view to_string(Phase phase) {
    constexpr std::array<std::string_view, 3> names{"takeoff", "cruise", "landing"};
    return names[static_cast<std::size_t>(phase)];
}

/// The phase of that name; std::nullopt if there is none.
constexpr std::optional<Phase> phase_from(std::string_view name) {
    for (const auto phase : all_phases) {
        if (to_string(phase) == name) return phase;
    }
    return std::nullopt;
}

/// One value for each phase, indexed by Phase.
template <typename T>
struct PerPhase {
    std::array<T, 3> values{};
    T& operator[](Phase phase) { return values[static_cast<std::size_t>(phase)]; }
    const T& operator[](Phase phase) const { return values[static_cast<std::size_t>(phase)]; }
};

}  // namespace flightwatt::flight

#pragma once

#include "telemetry/text/line_scanner.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::telemetry {

/// A small hash set of message names. Words are compared eight bytes at a time, so the text must be readable
/// for eight bytes from a word's begin.
class MessageNameSet {
  public:
    static constexpr std::uint8_t none = 0xFF;

    /// `name` gets the next index, from 0 on.
    void add(const std::string& name) {
        const auto padded = name + std::string(sizeof(std::uint64_t), '\0');
        const auto key = key_of({padded.data(), name.size()});
        auto slot = slot_of(key);
        while (slots_[slot].index != none) slot = (slot + 1) % slots_.size();
        slots_[slot] = {key, static_cast<std::uint8_t>(names_.size())};
        names_.push_back(name);
    }

    /// The index of `name` among the wanted ones; none if it is not wanted.
    std::uint8_t find(std::string_view name) const {
        const auto key = key_of(name);
        for (auto slot = slot_of(key); slots_[slot].index != none; slot = (slot + 1) % slots_.size()) {
            if (slots_[slot].key != key) continue;
            if (name.size() <= 2 * sizeof(std::uint64_t) || names_[slots_[slot].index] == name)
                return slots_[slot].index;
        }
        return none;
    }

  private:
    /// Tells names of up to 16 bytes apart: the first eight bytes, the last eight (0 for names that have no
    /// more), and the size.
    struct Key {
        std::uint64_t head = 0;
        std::uint64_t tail = 0;
        std::size_t size = 0;
        bool operator==(const Key&) const = default;
    };
    struct Slot {
        Key key;
        std::uint8_t index = none;
    };
    static Key key_of(std::string_view name) {
        constexpr std::size_t eight = sizeof(std::uint64_t);
        return {first_bytes(name), name.size() > eight ? first_bytes(name.substr(name.size() - eight)) : 0,
                name.size()};
    }
    static std::size_t slot_of(const Key& key) { return ((key.head + key.size) * 0x9E3779B97F4A7C15u) >> 56; }

    std::vector<std::string> names_;
    std::array<Slot, 256> slots_{};
};

}  // namespace flightwatt::telemetry

#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt {

/// A small hash set of message names. Looking a name up reads its first eight bytes at once, so the text
/// must be readable for eight bytes from the name's begin.
class WantedMessages {
  public:
    explicit WantedMessages(const std::vector<std::string>& names) : names_(names) {
        slots_.fill(none);
        for (std::size_t i = 0; i < names_.size(); ++i) {
            std::array<char, 8> padded{};
            std::memcpy(padded.data(), names_[i].data(), std::min<std::size_t>(names_[i].size(), 8));
            auto slot = slot_of(key_of(padded.data(), names_[i].size()));
            while (slots_[slot] != none) slot = (slot + 1) % slots_.size();
            slots_[slot] = static_cast<std::uint8_t>(i);
        }
    }

    static constexpr std::uint8_t none = 0xFF;

    /// The index of `name` among the wanted ones; none if it is not wanted.
    std::uint8_t find(std::string_view name) const {
        auto slot = slot_of(key_of(name.data(), name.size()));
        while (slots_[slot] != none) {
            if (names_[slots_[slot]] == name) return slots_[slot];
            slot = (slot + 1) % slots_.size();
        }
        return none;
    }

  private:
    static std::uint64_t key_of(const char* text, std::size_t size) {
        std::uint64_t key = 0;
        std::memcpy(&key, text, sizeof key);
        if (size < sizeof key) key &= (std::uint64_t{1} << (8 * size)) - 1;
        return key + size;
    }
    static std::size_t slot_of(std::uint64_t key) { return (key * 0x9E3779B97F4A7C15u) >> 56; }

    std::vector<std::string> names_;
    std::array<std::uint8_t, 256> slots_{};
};

}  // namespace flightwatt

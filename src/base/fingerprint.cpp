#include "base/fingerprint.h"

#include <cstring>

#include <fmt/format.h>

namespace flightwatt {

void Fingerprint::add(std::string_view content) {
    constexpr std::uint64_t prime = 0x100000001B3u;
    const auto mix = [&](std::uint64_t word) {
        state_ = (state_ ^ word) * prime;
        state_ ^= state_ >> 32;  // words differ in all bytes, FNV's multiplication only carries upwards
    };
    mix(content.size());
    while (content.size() >= sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, content.data(), sizeof word);
        mix(word);
        content.remove_prefix(sizeof word);
    }
    for (const char c : content) mix(static_cast<unsigned char>(c));
}

std::string Fingerprint::hex() const { return fmt::format("{:016x}", state_); }

}  // namespace flightwatt

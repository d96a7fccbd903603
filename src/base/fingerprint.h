#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace flightwatt {

/// A 64-bit FNV-1a hash, eight bytes at a time: detects changed content. Not for security.
class Fingerprint {
  public:
    void add(std::string_view content);
    std::uint64_t value() const { return state_; }
    std::string hex() const;

  private:
    std::uint64_t state_ = 0xCBF29CE484222325u;
};

}  // namespace flightwatt

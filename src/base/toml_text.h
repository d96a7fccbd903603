#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Values as TOML spells them.
namespace flightwatt {

/// A basic string, quoted and escaped; bytes that are not UTF-8 become U+FFFD.
std::string toml_string(std::string_view text);

/// The shortest text that reads back as the same double, and as a float rather than an integer.
std::string toml_real(double value);
std::string toml_reals(const std::vector<double>& values);
std::string toml_strings(const std::vector<std::string>& texts);

}  // namespace flightwatt

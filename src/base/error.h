#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt {

/// Where in a file something was found. Lines and columns count from 1; 0 means unknown.
struct Location {
    std::string file;
    std::size_t line = 0;
    std::size_t column = 0;
};

/// "file:line:column", without the parts that are unknown.
std::string to_string(const Location& where);

/// `text`, without its middle if it has more than 2000 bytes, for quotes from files in errors.
std::string truncated(std::string_view text);

/// "a, b, c", and of more than a dozen "... and 34 more".
std::string short_list(const std::vector<std::string>& names);

/// An input that cannot be used (exit code 3). The message states what was found and expected, the hint how to fix it.
/// Both are clipped.
class InputError : public std::runtime_error {
  public:
    InputError(Location where, const std::string& message, const std::string& hint = "");
    const Location& where() const { return where_; }
    const std::string& hint() const { return hint_; }

  private:
    Location where_;
    std::string hint_;
};

/// Options that do not fit together or do not exist (exit code 2).
class UsageError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Sound input that has no usable answer: not converged, undeliverable, infeasible (exit code 4).
class NoResultError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A result that could not be written (exit code 1).
class OutputError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace flightwatt

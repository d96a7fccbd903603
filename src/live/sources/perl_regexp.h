#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::live {

/// A regular expression as Ivy's agents subscribe with: Perl's.
class PerlRegexp {
  public:
    /// std::nullopt: it is none.
    static std::optional<PerlRegexp> compile(const std::string& expression);

    /// The groups of the first match in `text`, which they point into, empty for one that took no part. std::nullopt:
    /// it does not match, or trying would take too long.
    std::optional<std::vector<std::string_view>> groups_in(std::string_view text) const;

  private:
    explicit PerlRegexp(std::shared_ptr<void> code) : code_(std::move(code)) {}

    std::shared_ptr<void> code_;
};

}  // namespace flightwatt::live

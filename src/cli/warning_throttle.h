#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace flightwatt::cli {

/// Warnings of something that goes on, each said when it first holds, and again when its numbers have changed so much
/// that somebody wants to know: one has doubled or halved, or come from or gone to 0, and half a minute has passed.
class WarningThrottle {
  public:
    static constexpr std::size_t max_kinds = 200;
    static constexpr double again_after_s = 30.0;

    /// Those that hold `now` and are to be said at that time.
    std::vector<std::string> due(const std::vector<std::string>& now, double time_s);
    /// At the end: those whose numbers are others than those last said.
    std::vector<std::string> final_updates(const std::vector<std::string>& now);

  private:
    struct Said {
        std::string text;
        std::vector<double> numbers;
        double time_s = 0.0;
    };
    std::map<std::string, Said> said_;  ///< by their texts without numbers
};

}  // namespace flightwatt::cli

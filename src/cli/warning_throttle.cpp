#include "cli/warning_throttle.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <system_error>
#include <utility>

namespace flightwatt::cli {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The text without its numbers, which are appended to `numbers`.
std::string without_numbers(const std::string& text, std::vector<double>& numbers) {
    std::string kind;
    for (const char* at = text.data(); at != text.data() + text.size();) {
        double number = 0.0;
        const auto [end, error] = std::from_chars(at, text.data() + text.size(), number, std::chars_format::fixed);
        if (!is_digit(*at) || error != std::errc()) {
            kind += *at++;
            continue;
        }
        numbers.push_back(number);
        at = end;
    }
    return kind;
}

bool differs_much(double now, double then) {
    constexpr double much = 2.0;
    const double least = std::min(std::abs(now), std::abs(then));
    return now != then && std::max(std::abs(now), std::abs(then)) >= much * least;
}

}  // namespace

std::vector<std::string> WarningThrottle::due(const std::vector<std::string>& now, double time_s) {
    std::vector<std::string> to_say;
    for (const auto& text : now) {
        std::vector<double> numbers;
        auto kind = without_numbers(text, numbers);
        const auto known = said_.find(kind);
        if (known == said_.end()) {
            if (said_.size() >= max_kinds) continue;
            said_.emplace(std::move(kind), Said{text, std::move(numbers), time_s});
            to_say.push_back(text);
            continue;
        }
        auto& then = known->second;
        const bool is_soon = std::abs(time_s - then.time_s) < again_after_s;  // a clock may begin anew
        if (is_soon || std::ranges::equal(numbers, then.numbers, std::not_fn(differs_much))) continue;
        then = {text, std::move(numbers), time_s};
        to_say.push_back(text);
    }
    return to_say;
}

std::vector<std::string> WarningThrottle::final_updates(const std::vector<std::string>& now) {
    std::vector<std::string> to_say;
    for (const auto& text : now) {
        std::vector<double> numbers;
        const auto known = said_.find(without_numbers(text, numbers));
        if (known == said_.end() || known->second.text == text) continue;
        known->second.text = text;
        to_say.push_back(text);
    }
    return to_say;
}

}  // namespace flightwatt::cli

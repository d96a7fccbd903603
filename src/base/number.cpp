#include "base/number.h"

#include <limits>

namespace flightwatt::detail {

double number_or_nan_general(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, status] = std::from_chars(text.data(), end, value);
    if (status != std::errc{} || stop != end || !std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
    return value;
}

}  // namespace flightwatt::detail

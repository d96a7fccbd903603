#include "live/sources/perl_regexp.h"

#include <cstdint>
#include <utility>

#define PCRE2_CODE_UNIT_WIDTH 8
#include <pcre2.h>

namespace flightwatt::live {

std::optional<PerlRegexp> PerlRegexp::compile(const std::string& expression) {
    int error = 0;
    PCRE2_SIZE where = 0;
    auto* code =
        ::pcre2_compile(reinterpret_cast<PCRE2_SPTR>(expression.data()), expression.size(), 0, &error, &where, nullptr);
    if (code == nullptr) return std::nullopt;
    return PerlRegexp({code, [](void* pointer) { ::pcre2_code_free(static_cast<pcre2_code*>(pointer)); }});
}

std::optional<std::vector<std::string_view>> PerlRegexp::groups_in(std::string_view text) const {
    const auto* code = static_cast<const pcre2_code*>(code_.get());
    const std::unique_ptr<pcre2_match_data, decltype(&::pcre2_match_data_free)> match(
        ::pcre2_match_data_create_from_pattern(code, nullptr), &::pcre2_match_data_free);
    if (!match) return std::nullopt;
    const int found =
        ::pcre2_match(code, reinterpret_cast<PCRE2_SPTR>(text.data()), text.size(), 0, 0, match.get(), nullptr);
    if (found < 1) return std::nullopt;
    std::uint32_t groups = 0;
    ::pcre2_pattern_info(code, PCRE2_INFO_CAPTURECOUNT, &groups);
    const auto* bounds = ::pcre2_get_ovector_pointer(match.get());
    std::vector<std::string_view> parts;
    for (std::size_t i = 1; i <= groups; ++i) {
        const auto begin = bounds[2 * i], end = bounds[2 * i + 1];
        parts.push_back(begin == PCRE2_UNSET || end < begin ? std::string_view() : text.substr(begin, end - begin));
    }
    return parts;
}

}  // namespace flightwatt::live

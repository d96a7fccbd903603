// Included ahead of every file of the program: what of C++20 the library of clang 19 lacks, numbers from text.
#pragma once

#include <charconv>
#include <fast_float/fast_float.h>

namespace std {

inline from_chars_result from_chars(const char* first, const char* last, double& value,
                                    chars_format format = chars_format::general) {
    const auto known = format == chars_format::scientific ? fast_float::chars_format::scientific
                       : format == chars_format::fixed    ? fast_float::chars_format::fixed
                                                          : fast_float::chars_format::general;
    const auto [end, error] = fast_float::from_chars(first, last, value, known);
    return {end, error};
}

}  // namespace std

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Texts in UTF-8. Names of files may be any bytes.
namespace flightwatt {

struct Utf8Character {
    char32_t code = U'\uFFFD';  ///< where the bytes are no character
    std::size_t bytes = 1;
};

/// The character that a text begins with, which is not empty. Bytes that begin a character and do not complete it are
/// one U+FFFD; so is each other byte that is none.
Utf8Character first_character(std::string_view text);

/// The text with U+FFFD for what is not UTF-8.
std::string valid_utf8(std::string_view text);

/// Whether a character that began before goes on with this byte.
inline bool continues_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

/// How many characters a text has.
std::size_t character_count(std::string_view text);

}  // namespace flightwatt

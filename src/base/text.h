#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Texts in UTF-8, and values as TOML spells them. Names of files may be any bytes.
namespace flightwatt {

struct Utf8Character {
    char32_t code = U'\uFFFD';  ///< where the bytes are no character
    std::size_t bytes = 1;
};

/// The character that a text begins with, which is not empty. Bytes that begin a character and do not complete it are
/// one U+FFFD; so is each other invalid byte.
Utf8Character first_character(std::string_view text);

/// The text with U+FFFD for invalid UTF-8.
std::string valid_utf8(std::string_view text);

/// Whether the byte continues a character.
inline bool continues_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

/// How many characters a text has.
std::size_t character_count(std::string_view text);

/// A basic string, quoted and escaped; bytes that are not UTF-8 become U+FFFD.
std::string toml_string(std::string_view text);

/// The shortest text that reads back as the same double, and as a float rather than an integer.
std::string toml_real(double value);
std::string toml_reals(const std::vector<double>& values);
std::string toml_strings(const std::vector<std::string>& texts);

/// A key as people write it: quoted only if it has to be.
std::string toml_key(const std::string& name);

/// "{ a = 1, b = 2 }" of "a = 1" and "b = 2"; "{}" for an empty list.
std::string toml_inline_table(const std::vector<std::string>& pairs);

/// Removes the next word and the blank that ends it from the front of `rest`, and returns the word. Two blanks enclose
/// an empty word; a blank at the end starts none.
inline std::string_view take_word(std::string_view& rest, char separator = ' ') {
    const auto word = rest.substr(0, rest.find(separator));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    return word;
}

/// Splits a text at any of the separators, and returns the parts that are not empty.
std::vector<std::string> split(const std::string& text, const char* separators);

/// Returns the text without the byte order mark that it may begin with, as spreadsheets write it.
std::string_view without_byte_order_mark(std::string_view text);

/// Returns the line of a position in a text, counted from 1.
std::size_t line_of_offset(std::string_view text, std::size_t offset);

/// `text` with blanks for control characters: diagnostics stay on one line, whatever a file (or its name) put
/// into them.
std::string one_line(std::string_view text);

/// A duration for people: "27.5 s", from a minute on in whole seconds "28 min 32 s", "1 h 2 min 5 s"; last parts that
/// are 0 are left out: "28 min". Values that are not finite, or beyond 1e9 s, are in seconds.
std::string duration_text(double duration_s);

}  // namespace flightwatt

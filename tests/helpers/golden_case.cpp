#include "helpers/golden_case.h"

#include "base/atomic_file.h"
#include "base/error.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <stdexcept>

namespace flightwatt::test {
namespace {

constexpr double relative_tolerance = 1e-6;
/// From so many digits on the last one may be rounded the other way; fewer are not at the mercy of one ulp.
constexpr std::size_t digits_with_rounding = 4;

const std::string command_section = "--- command";
const std::string exit_section = "--- exit";
const std::string stdout_section = "--- stdout";
const std::string stderr_section = "--- stderr";
const std::string exact_line = "--- compare exactly";

bool is_section(std::string_view line) {
    return line == command_section || line == exit_section || line == stdout_section || line == stderr_section ||
           line == exact_line;
}

/// Lines with their line feed.
std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const auto end = std::min(text.find('\n'), text.size() - 1) + 1;
        lines.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return lines;
}

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_sign(char c) { return c == '+' || c == '-'; }

/// A piece of a line: a number, blanks, a word or one other character.
struct Token {
    std::string_view text;
    std::optional<double> number;  ///< with a decimal point or an exponent; not of whole numbers
    bool blank = false;
};

/// End of the word that begins at `from`, with the exponent's sign if it is a number.
std::size_t end_of_word(std::string_view line, std::size_t from) {
    auto end = from;
    while (end < line.size() && in_word(line[end])) ++end;
    const auto word = line.substr(from, end - from);
    const bool mantissa = word.size() > 1 && (word.back() == 'e' || word.back() == 'E') &&
                          word.find_first_not_of("0123456789.") == word.size() - 1;
    if (mantissa && end + 1 < line.size() && is_sign(line[end]) && is_digit(line[end + 1])) {
        ++end;
        while (end < line.size() && in_word(line[end])) ++end;
    }
    while (end > from + 1 && line[end - 1] == '.') --end;  // the full stop of a sentence
    return end;
}

std::optional<double> fractional_number(std::string_view text) {
    if (text.find_first_of(".eE") == std::string_view::npos) return std::nullopt;
    if (text.front() == '+') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
    return whole ? std::optional(value) : std::nullopt;
}

std::vector<Token> tokens_of(std::string_view line) {
    std::vector<Token> tokens;
    for (std::size_t at = 0; at < line.size();) {
        auto end = at + 1;
        const bool after_word = at > 0 && in_word(line[at - 1]);
        if (line[at] == ' ') {
            while (end < line.size() && line[end] == ' ') ++end;
        } else if (in_word(line[at])) {
            end = end_of_word(line, at);
        } else if (is_sign(line[at]) && !after_word && end < line.size() && is_digit(line[end])) {
            end = end_of_word(line, end);
        }
        const auto text = line.substr(at, end - at);
        tokens.push_back({text, fractional_number(text), text.front() == ' '});
        at = end;
    }
    return tokens;
}

/// Significant digits and the value of one unit in the last of them.
struct Print {
    std::size_t digits = 0;
    double unit = 0.0;
};

Print print_of(std::string_view text) {
    const auto exponent_at = std::min(text.find_first_of("eE"), text.size());
    const auto mantissa = text.substr(0, exponent_at);
    Print print;
    int decimals = 0;
    bool point = false;
    for (const char c : mantissa) {
        if (c == '.') point = true;
        if (!is_digit(c)) continue;
        if (c != '0' || print.digits > 0) ++print.digits;
        if (point) ++decimals;
    }
    const int exponent = exponent_at < text.size() ? std::stoi(std::string(text.substr(exponent_at + 1))) : 0;
    print.unit = std::pow(10.0, exponent - decimals);
    return print;
}

bool close(const Token& actual, const Token& expected) {
    const auto printed = print_of(actual.text);
    const auto wanted = print_of(expected.text);
    double tolerance = relative_tolerance * std::abs(*expected.number);
    if (std::min(printed.digits, wanted.digits) >= digits_with_rounding) {
        constexpr double slack = 1.0 + 1e-6;  // the difference of two decimals is not exact
        tolerance = std::max(tolerance, slack * std::min(printed.unit, wanted.unit));
    }
    return std::abs(*actual.number - *expected.number) <= tolerance;
}

bool same_length(const Token& a, const Token& b) { return a.text.size() == b.text.size(); }

/// The expected line where all that differs are close numbers; otherwise the actual one with those replaced.
std::string line_with_expected_numbers(std::string_view actual_line, std::string_view expected_line) {
    const auto actual = tokens_of(actual_line);
    const auto expected = tokens_of(expected_line);
    std::string text;
    const auto longer = [&](std::size_t i) {
        return i < actual.size() && i < expected.size() && actual[i].number && expected[i].number &&
               close(actual[i], expected[i]) && !same_length(actual[i], expected[i]);
    };
    for (std::size_t i = 0; i < actual.size(); ++i) {
        bool adopt = i < expected.size() && actual[i].number && expected[i].number && close(actual[i], expected[i]);
        if (i < expected.size() && actual[i].blank && expected[i].blank) {
            for (const auto neighbour : {i + 1, i == 0 ? actual.size() : i - 1}) {
                adopt = adopt || (longer(neighbour) && actual[i].text.size() + actual[neighbour].text.size() ==
                                                           expected[i].text.size() + expected[neighbour].text.size());
            }
        }
        text += adopt ? expected[i].text : actual[i].text;
    }
    return text;
}

void append_section(std::string& text, const std::string& section, const std::string& body) {
    if (body.empty()) return;
    if (body.back() != '\n') throw std::invalid_argument(section + " does not end with a line feed");
    for (const auto line : lines_of(body)) {
        if (is_section(line.substr(0, line.size() - 1)))
            throw std::invalid_argument(section + " holds the line of a section");
    }
    text += section + "\n" + body;
}

}  // namespace

GoldenCase read_golden_case(const std::filesystem::path& path) {
    const auto text = read_file(path);
    GoldenCase golden;
    std::set<std::string> seen;
    std::string* body = nullptr;
    std::size_t number = 0;
    for (const auto raw : lines_of(text)) {
        ++number;
        const std::string line(raw.substr(0, raw.find('\n')));
        if (!is_section(line)) {
            if (body == nullptr) throw InputError({path.string(), number, 1}, "expected '" + command_section + "'");
            body->append(raw);
            continue;
        }
        if (!seen.insert(line).second) throw InputError({path.string(), number, 1}, line + " is given twice");
        if (line == exact_line) golden.exact = true;
        if (line == command_section) body = &golden.command;
        if (line == exit_section) body = &golden.expected.exit_code;
        if (line == stdout_section) body = &golden.expected.stdout_text;
        if (line == stderr_section) body = &golden.expected.stderr_text;
    }
    if (golden.command.empty()) throw InputError({path.string(), number, 1}, "has no '" + command_section + "'");
    auto& code = golden.expected.exit_code;
    if (!code.empty() && code.back() == '\n') code.pop_back();
    return golden;
}

std::string to_text(const GoldenCase& golden) {
    std::string text = golden.exact ? exact_line + "\n" : "";
    append_section(text, command_section, golden.command);
    append_section(text, exit_section, golden.expected.exit_code + "\n");
    append_section(text, stdout_section, golden.expected.stdout_text);
    append_section(text, stderr_section, golden.expected.stderr_text);
    return text;
}

std::string with_expected_numbers(std::string_view actual, std::string_view expected) {
    const auto lines = lines_of(actual);
    const auto expected_lines = lines_of(expected);
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        text +=
            i < expected_lines.size() ? line_with_expected_numbers(lines[i], expected_lines[i]) : std::string(lines[i]);
    }
    return text;
}

std::vector<std::string> differing_parts(const GoldenCase& golden, const Outcome& outcome) {
    const auto differs = [&](const std::string& actual, const std::string& expected) {
        return (golden.exact ? actual : with_expected_numbers(actual, expected)) != expected;
    };
    std::vector<std::string> parts;
    if (outcome.exit_code != golden.expected.exit_code) parts.emplace_back("exit");
    if (differs(outcome.stdout_text, golden.expected.stdout_text)) parts.emplace_back("stdout");
    if (differs(outcome.stderr_text, golden.expected.stderr_text)) parts.emplace_back("stderr");
    return parts;
}

}  // namespace flightwatt::test

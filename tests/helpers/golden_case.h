#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::test {

/// What a program printed and returned.
struct Outcome {
    std::string exit_code;  ///< "3", or "killed"
    std::string stdout_text;
    std::string stderr_text;
};

/// A case of tests/cli/golden: NAME.case with the sections "--- command" (for sh), "--- exit", "--- stdout" and
/// "--- stderr", each on a line of its own; an empty section is not written. The line "--- compare exactly" before
/// the command asks for a comparison of every byte.
struct GoldenCase {
    std::string command;
    bool exact = false;
    Outcome expected;
};

/// Throws InputError (with the line) at a section that is unknown, given twice or missing.
GoldenCase read_golden_case(const std::filesystem::path& path);

/// The file's text. Throws std::invalid_argument where an output does not end with a line feed or holds a line
/// that would be read as a section.
std::string to_text(const GoldenCase& golden);

/// `actual` with the expected text in place of each number that is close to the one expected, so that the two are
/// equal if nothing else differs. Numbers are paired in order within lines, and lines by their number.
///
/// Close: both have a decimal point or an exponent and differ by at most 1e-6 of the expected one or, where both are
/// printed with four significant digits or more, by one unit in the last digit. Whole numbers (counts, lines, exit
/// codes), numbers within a word ("a0", "0.2.0", "5s") and all other text must be the same. The blanks around a
/// close number may differ by as many as its length does.
std::string with_expected_numbers(std::string_view actual, std::string_view expected);

/// Names of the parts ("stdout") of an outcome that are not as expected.
std::vector<std::string> differing_parts(const GoldenCase& golden, const Outcome& outcome);

}  // namespace flightwatt::test

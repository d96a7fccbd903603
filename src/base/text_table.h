#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt {

/// A small table for people: the same cells as aligned text, Markdown, CSV or LaTeX.
struct TextTable {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;  ///< each as long as the header
};

/// A table with its caption, and its label in LaTeX ("tab:flights").
struct CaptionedTable {
    TextTable table;
    std::string caption;
    std::string label;
};

/// A number with `decimals` decimals, for a cell; '-' if unknown.
std::string fixed(const std::optional<double>& number, int decimals);

/// Rows of cells, each of which may have several lines, in columns padded to their widest line (counted in code points)
/// and two blanks apart; those of `right` are right-aligned.
std::string aligned_text(const std::vector<std::vector<std::string>>& rows, const std::vector<bool>& right);

/// The table as aligned_text, without controls; columns of numbers, or '-', are right-aligned.
std::string to_text(TextTable table);
std::string to_markdown(TextTable table);
std::string to_csv(const TextTable& table);

/// Text with TeX's special characters escaped, "^3" as a superscript; characters beyond ASCII and Latin become '?'.
std::string latex_escaped(std::string_view text);

/// A number as mathematical mode takes it: 1.5 \times 10^{-5} for "1.5e-05".
std::string latex_number(std::string_view number);

/// A table environment with the rules of the package booktabs. Columns that are all numbers, intervals ("0.5 to 2") or
/// '-' stand to the right.
std::string to_latex(const TextTable& table, std::string_view caption, std::string_view label);

}  // namespace flightwatt

#pragma once

#include <optional>
#include <string>
#include <vector>

namespace flightwatt {

/// A small table for people: the same cells as aligned text, Markdown or CSV.
struct TextTable {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;  ///< each as long as the header
};

/// A number with so many decimals, for a cell; '-' for what is not known.
std::string fixed(const std::optional<double>& number, int decimals);

/// Columns padded to their widest cell (counted in code points) and two blanks apart; a column whose cells
/// are all numbers, or '-', stands to the right.
std::string to_text(const TextTable& table);
std::string to_markdown(const TextTable& table);
std::string to_csv(const TextTable& table);

}  // namespace flightwatt

#pragma once

#include "base/text_table.h"
#include "report/figure.h"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::report {

/// `text` as HTML text or attribute value: valid UTF-8, without markup or control characters.
std::string html_escaped(std::string_view text);

struct HtmlTableOptions {
    std::string caption;  ///< said to those who do not see the table
    bool sortable = false;
    std::vector<std::string> links = {};  ///< of the rows' first cells; none where empty
    /// Columns that a screen without room for all leaves out first, in this order, and names; then others from the
    /// right.
    std::vector<std::string> minor = {};
};

/// A table; columns that are not all numbers (or '-') stand to the left.
std::string table_html(const TextTable& table, const HtmlTableOptions& options);

/// A figure with its caption and its specification, or another form of it, which the page's script draws.
std::string figure_html(const Figure& figure);
std::string figure_html(const Figure& figure, const VegaJson& spec);

/// What tells a section and its figures from those of the page's other folders; empty where it shows one folder.
struct SectionScope {
    std::string folder = {};
    std::string id_ending = {};  ///< "-2"

    std::string id(std::string_view of_one) const { return std::string(of_one) + id_ending; }
    std::string title(std::string_view of_one) const {
        return std::string(of_one) + (folder.empty() ? "" : " (" + folder + ")");
    }
};

/// Called as long work goes on, from any thread: how much of it is done, of how much.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

/// A part of the page. Its figures and tables stand in its HTML already; they are kept to be written as files.
struct Section {
    std::string id;
    std::string title;
    std::string html = {};
    std::vector<Figure> figures = {};
    std::vector<CaptionedTable> tables = {};
};

/// Puts a figure at the end of a section.
void add_figure(Section& section, Figure figure);

/// Puts a table at the end of a section, under its caption.
void add_table(Section& section, CaptionedTable table, bool sortable = false);

/// A paragraph of plain text.
std::string paragraph(std::string_view text, std::string_view css_class = "");

/// A list of plain texts; empty for none.
std::string list_html(const std::vector<std::string>& lines);

}  // namespace flightwatt::report

#pragma once

#include "base/text_table.h"
#include "report/figure.h"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::report {

/// Returns `text` as HTML text or attribute value: valid UTF-8, without markup or control characters.
std::string html_escaped(std::string_view text);

/// Options of a table.
struct HtmlTableOptions {
    bool sortable = false;                ///< a click on a heading sorts the rows
    std::vector<std::string> links = {};  ///< links of the rows' first cells; empty: no link
};

/// Returns a table with a caption for screen readers; columns of numbers (or '-') are right-aligned.
std::string table_html(const TextTable& table, std::string_view caption, const HtmlTableOptions& options = {});

/// Receives the progress of long work, from any thread.
using Progress = std::function<void(std::size_t done, std::size_t all)>;

/// The place of a section on the page.
enum class SectionPlace {
    page,    ///< in the page, with its title as heading
    front,   ///< on the first screen, with a heading of its own
    folded,  ///< below "How certain is this?", which is closed at first
};

/// A section of the page. Its HTML contains the figures and tables; figures and LaTeX can also be written as files.
struct Section {
    std::string id;
    std::string title;
    std::string html = {};
    std::string latex = {};
    std::vector<Figure> figures = {};
    SectionPlace place = SectionPlace::page;
};

/// Appends a figure to the section and its HTML.
void add_figure(Section& section, Figure figure);

/// Appends a table to the HTML and, if it has a label and rows, to the LaTeX.
void add_table(Section& section, const CaptionedTable& table, const HtmlTableOptions& options = {});

/// Returns the text with a capital first letter.
std::string capitalized(std::string text);

/// Returns a subheading of plain text.
std::string heading(std::string_view text);
/// Returns a paragraph of plain text.
std::string paragraph(std::string_view text, std::string_view css_class = "");
/// Returns a list of plain texts; an empty text for an empty list.
std::string list_html(const std::vector<std::string>& lines, std::string_view css_class = "");

}  // namespace flightwatt::report

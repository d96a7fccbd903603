#include "report/html.h"

#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

TEST(Escaped, LeavesNoMarkup) {
    EXPECT_EQ(html_escaped("<script>\"a\" & 'b'\x01</script>"),
              "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39; &lt;/script&gt;");
}

TEST(TableHtml, PutsTextsToTheLeftAndLinksTheFirstCell) {
    const TextTable table{{"flight", "energy [Wh]", "closure [%]", "state"},
                          {{"<a>", "5.0", "+0.1", "all"}, {"b", "-", "-0.2", "in part"}}};
    const auto html = table_html(table, "Flights", {true, {"flight-1", ""}});
    EXPECT_NE(html.find("<table class=\"sortable\""), std::string::npos);
    EXPECT_NE(html.find("<td class=\"text short\" data-label=\"flight\"><a href=\"#flight-1\">&lt;a&gt;</a></td>"),
              std::string::npos);
    EXPECT_NE(html.find("<td class=\"text short\" data-label=\"flight\">b</td>"), std::string::npos);
    EXPECT_NE(html.find("<td data-label=\"closure [%]\">+0.1</td>"), std::string::npos);
    EXPECT_NE(html.find("<td data-label=\"energy [Wh]\">-</td>"), std::string::npos);
    EXPECT_NE(html.find("<td class=\"text short\" data-label=\"state\">in part</td>"), std::string::npos);
}

TEST(FigureHtml, TellsWhatTheFigureSays) {
    Figure figure;
    figure.id = "power";
    figure.caption = "A & B";
    figure.description = "27 W \"on average\"";
    figure.spec = {{"description", "</script>"}};
    Section section{"s", "S"};
    add_figure(section, figure);
    const auto& html = section.html;
    EXPECT_NE(html.find("aria-label=\"27 W &quot;on average&quot;\""), std::string::npos);
    EXPECT_NE(html.find("<figcaption>A &amp; B</figcaption>"), std::string::npos);
    EXPECT_NE(html.find("\\u003c/script>"), std::string::npos);
}

TEST(AddTable, PutsTablesWithALabelIntoLatex) {
    Section section{"s", "S"};
    add_table(section, {{{"a"}, {{"1"}}}, "One", "tab:one"});
    add_table(section, {{{"a"}, {{"2"}}}, "Page only", ""});
    add_table(section, {{{"a"}, {}}, "No rows", "tab:none"});
    add_table(section, {{{"a"}, {{"3"}}}, "Three", "tab:three"});
    EXPECT_EQ(section.latex,
              to_latex({{{{"a"}, {{"1"}}}, "One", "tab:one"}, {{{"a"}, {{"3"}}}, "Three", "tab:three"}}));
    EXPECT_NE(section.html.find("aria-label=\"Page only\""), std::string::npos);
}

}  // namespace
}  // namespace flightwatt::report

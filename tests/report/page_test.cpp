// The page as one HTML file that needs nothing else.

#include "report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

WebFiles small_files() {
    return {"", "p {}\n", R"({"light": {}, "dark": {}})", "var a = \"</script>\";\n", "draw();\n"};
}

TEST(PageHtml, HoldsTitleFactsNotesAndSections) {
    const PageHead head{"A <title>", {{"computed", "today & now"}}, {"Nothing was measured."}};
    const std::vector<Section> sections{{"flights", "Flights", "<p>one</p>\n", {}},
                                        {"plan", "Plan", "<p>two</p>\n", {}}};
    const auto html = page_html(head, sections, small_files());
    EXPECT_THAT(html, HasSubstr("<title>A &lt;title&gt;</title>"));
    EXPECT_THAT(html, HasSubstr("<dt>computed</dt><dd>today &amp; now</dd>"));
    EXPECT_THAT(html, HasSubstr("<p class=\"warning\">Nothing was measured.</p>"));
    EXPECT_THAT(html, HasSubstr("<li><a href=\"#plan\">Plan</a></li>"));
    EXPECT_LT(html.find("<p>one</p>"), html.find("<p>two</p>"));
}

TEST(PageHtml, KeepsScriptsInTheirElementsAndOffTheNetwork) {
    const auto html = page_html({"t", {}, {}}, {}, small_files());
    EXPECT_THAT(html, HasSubstr("var a = \"<\\/script>\";"));
    EXPECT_THAT(html, HasSubstr("default-src 'none'"));
    EXPECT_THAT(html, Not(HasSubstr("http://")));
    EXPECT_THAT(html, Not(HasSubstr("https://")));
}

}  // namespace
}  // namespace flightwatt::report

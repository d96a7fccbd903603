// The page as one HTML file that needs nothing else, and the files that it is made of: found, read, or missed with the
// way out.

#include "report/page.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

WebFiles small_files() {
    return {"", "p {}\n", R"({"light": {}, "dark": {}})", "var a = \"</script>\";\n", "draw();\n"};
}

TEST(PageHtml, HoldsTitleSectionsAndThenFacts) {
    const PageHead head{"A <title>", "A name", {{"computed", "today & now"}}};
    const std::vector<Section> sections{{"flights", "Flights", "<p>one</p>\n", {}},
                                        {"plan", "Plan", "<p>two</p>\n", {}}};
    const auto html = page_html(head, sections, small_files());
    EXPECT_THAT(html, HasSubstr("<title>A &lt;title&gt;</title>"));
    EXPECT_THAT(html, HasSubstr("<dt>computed</dt><dd>today &amp; now</dd>"));
    EXPECT_THAT(html, HasSubstr("<li><a href=\"#plan\">Plan</a></li>"));
    EXPECT_LT(html.find("<p>one</p>"), html.find("<p>two</p>"));
    EXPECT_LT(html.find("<p>two</p>"), html.find("<dt>computed</dt>"));
}

TEST(PageHtml, FoldsStatistics) {
    Section model{"model", "Model", "<p>two</p>\n"};
    model.place = SectionPlace::folded;
    Section front{"missions", "Missions", "<h1 id=\"missions-title\">One runs empty</h1>\n"};
    front.place = SectionPlace::front;
    const auto html = page_html({"t", "n", {}}, {front, model, {"flights", "Flights", "<p>one</p>\n"}}, small_files());
    EXPECT_LT(html.find("<p>one</p>"), html.find("How certain is this?"));
    EXPECT_THAT(html, HasSubstr("<details class=\"more\" id=\"model\"><summary><h3>Model</h3></summary>\n<p>two</p>"));
    EXPECT_THAT(html, Not(HasSubstr("<h2 id=\"missions-title\">")));
}

TEST(PageHtml, KeepsScriptsInTheirElementsAndOffTheNetwork) {
    const auto html = page_html({"t", "n", {}}, {}, small_files());
    EXPECT_THAT(html, HasSubstr("var a = \"<\\/script>\";"));
    EXPECT_THAT(html, HasSubstr("default-src 'none'"));
    EXPECT_THAT(html, Not(HasSubstr("http://")));
    EXPECT_THAT(html, Not(HasSubstr("https://")));
}

TEST(LivePage, ListensToItsServerAlone) {
    const auto html = live_page_html(small_files());
    EXPECT_THAT(html, HasSubstr("default-src 'none'"));
    EXPECT_THAT(html, HasSubstr("connect-src 'self'"));
    EXPECT_THAT(html, HasSubstr("id=\"charge\""));
    for (const auto* command : {"<form", "<button", "<input", "<a "}) EXPECT_THAT(html, Not(HasSubstr(command)));
    EXPECT_THAT(html, Not(HasSubstr("http://")));
    EXPECT_THAT(html, Not(HasSubstr("https://")));
    EXPECT_THAT(page_html({"t", "n", {}}, {}, small_files()), Not(HasSubstr("connect-src")));
}

TEST(LivePage, SaysThatItHasNoChartsWhereTheLibrariesAreMissing) {
    const auto folder = test::scratch_dir();
    for (const auto* file : {"watch.css", "theme.json", "watch.js"}) write_file_atomically(folder / file, "{}\n");
    const auto web = read_live_web_files(folder);
    EXPECT_EQ(web.libraries, "");
    EXPECT_EQ(web.script, "{}\n");
    const auto html = live_page_html(web);
    EXPECT_THAT(html, HasSubstr("No charts"));
    EXPECT_THAT(html, Not(HasSubstr("id=\"charge\"")));
    EXPECT_THAT(html, HasSubstr("id=\"alarms\""));
}

TEST(WebFolder, IsThatOfTheProject) {
    EXPECT_TRUE(std::filesystem::equivalent(web_folder(), test::source_dir() / "web"));
}

TEST(ReadWebFiles, JoinsLibrariesAndScripts) {
    const auto folder = test::scratch_dir();
    for (const auto* file : {"page.css", "theme.json", "fit_width.js", "blocks.js", "drawings.js", "page.js"}) {
        write_file_atomically(folder / file, std::string(file) + "\n");
    }
    EXPECT_THAT(
        test::rejected([&] { read_web_files(folder); }),
        testing::AllOf(testing::HasSubstr("vega.min.js"), testing::HasSubstr("run scripts/install_dependencies")));
    for (const std::string library : {"vega", "vega-lite", "vega-embed"}) {
        const auto build = folder / "node_modules" / library / "build";
        make_directories(build);
        write_file_atomically(build / (library + ".min.js"), library);
    }
    const auto files = read_web_files(folder);
    EXPECT_EQ(files.style, "page.css\n");
    EXPECT_EQ(files.theme, "theme.json\n");
    EXPECT_EQ(files.libraries, "vega\nvega-lite\nvega-embed\n");
    EXPECT_EQ(files.script, "fit_width.js\nblocks.js\ndrawings.js\npage.js\n");
}

Section section_with(const std::string& id) {
    Figure figure;
    figure.id = id;
    figure.spec = {{"mark", "line"}};
    return {"s", "S", "", "", {figure}};
}

/// Neither node nor rsvg-convert is found while it lives.
class NoPrograms {
  public:
    NoPrograms() : before_(std::getenv("PATH")) { ::setenv("PATH", test::scratch_dir().c_str(), 1); }
    ~NoPrograms() { ::setenv("PATH", before_.c_str(), 1); }
    NoPrograms(const NoPrograms&) = delete;
    NoPrograms& operator=(const NoPrograms&) = delete;

  private:
    std::string before_;
};

TEST(WriteFigures, WritesSpecificationsWithTheLightThemeWithoutNode) {
    const NoPrograms none;
    WebFiles web;
    web.theme = R"({"light": {"background": "white"}, "dark": {}})";
    const auto folder = test::scratch_dir() / "figures";
    const auto files = write_figures({section_with("one"), section_with("two")}, web, folder);
    EXPECT_EQ(files.figures, 2U);
    EXPECT_FALSE(files.has_svg);
    EXPECT_FALSE(files.has_pdf);
    const auto spec = VegaJson::parse(read_file(folder / "two.vl.json"));
    EXPECT_EQ(spec["mark"], "line");
    EXPECT_EQ(spec["config"]["background"], "white");
}

TEST(WriteFigures, SetTypeAtEightPointsForAColumn) {
    const NoPrograms none;
    WebFiles web;
    web.theme =
        R"({"light": {"title": {"fontSize": 13}, "axis": {"labelFontSize": 11, "labelLimit": 90}}, "dark": {}})";
    const auto folder = test::scratch_dir() / "figures";
    write_figures({section_with("one")}, web, folder, {parse_figure_length_pt("figure-width", "3.5in"), {}, true});
    const auto config = VegaJson::parse(read_file(folder / "one.vl.json"))["config"];
    EXPECT_NEAR(config["title"]["fontSize"].get<double>(), 32.0 / 3.0, 1e-9);
    EXPECT_NEAR(config["axis"]["labelFontSize"].get<double>(), 32.0 / 3.0, 1e-9);
    EXPECT_EQ(config["axis"]["labelLimit"], 90);
}

TEST(FigureWidth, IsReadWithItsUnit) {
    EXPECT_DOUBLE_EQ(parse_figure_length_pt("figure-width", "3.5in"), 252.0);
    EXPECT_DOUBLE_EQ(parse_figure_length_pt("figure-width", "252pt"), 252.0);
    EXPECT_NEAR(parse_figure_length_pt("figure-width", "88.9mm"), 252.0, 1e-9);
    EXPECT_NEAR(parse_figure_length_pt("figure-width", "8.89cm"), 252.0, 1e-9);
    for (const auto* wrong : {"", "3.5", "in", "3.5 in", "-3in", "1in", "30in", "3.5inch", "3..5in"})
        EXPECT_THROW(parse_figure_length_pt("figure-width", wrong), UsageError) << wrong;
}

TEST(WriteFigures, FailsWhereTheFolderIsAFile) {
    WebFiles web;
    web.theme = R"({"light": {}, "dark": {}})";
    const auto file = test::scratch_dir() / "file";
    write_file_atomically(file, "");
    EXPECT_THROW(write_figures({section_with("one")}, web, file), OutputError);
}

}  // namespace
}  // namespace flightwatt::report

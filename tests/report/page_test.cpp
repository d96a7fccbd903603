// The page as one HTML file that needs nothing else, and the files that it is made of: found, read, or missed with the
// way out.

#include "report/page.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

using testing::HasSubstr;
using testing::Not;

Json small_document() {
    return Json::parse(
        R"({"title": "A <title>", "headline": "One mission", "answer": null, "aircraft": [], "missions": [],
                           "flights": [], "warnings": [], "notes": ["</script><!--"], "facts": []})");
}

std::string small_page() { return page_html(small_document(), {"p {}\n", "var a = \"</script>\";\n"}); }

TEST(PageHtml, HoldsTheDocumentAndItsAnswersAsHtml) {
    const auto html = small_page();
    EXPECT_THAT(html, HasSubstr("<title>A &lt;title&gt;</title>"));
    EXPECT_LT(html.find("<h1>One mission</h1>"), html.find("id=\"document\""));
    const std::string begin = "<script type=\"application/json\" id=\"document\">";
    const auto at = html.find(begin) + begin.size();
    EXPECT_EQ(Json::parse(html.substr(at, html.find("</script>", at) - at)), small_document());
}

TEST(PageHtml, KeepsScriptsInTheirElementsAndOffTheNetwork) {
    const auto html = small_page();
    EXPECT_THAT(html, HasSubstr("var a = \"<\\/script>\";"));
    EXPECT_THAT(html, HasSubstr("default-src 'none'"));
    EXPECT_THAT(html, Not(HasSubstr("unsafe-eval")));
    EXPECT_THAT(html, Not(HasSubstr("http://")));
    EXPECT_THAT(html, Not(HasSubstr("https://")));
}

TEST(PageHtml, MayRunTheProgramThatItHasInside) {
    const auto html = page_html(small_document(), {"", "", "module"});
    EXPECT_THAT(html, HasSubstr("script-src 'unsafe-inline' 'wasm-unsafe-eval'; "));
    EXPECT_THAT(html, HasSubstr("; worker-src blob:\""));
    EXPECT_THAT(html, HasSubstr("<script type=\"text/plain\" id=\"flightwatt-wasm\">bW9kdWxl</script>"));
    for (const auto* word : {"wasm", "worker-src"}) EXPECT_THAT(small_page(), Not(HasSubstr(word)));
}

TEST(ReadEngine, NeedsTheModuleAndNamesTheScriptThatMakesIt) {
    const auto folder = test::scratch_dir();
    EXPECT_THAT(test::rejected([&] { read_engine(folder); }),
                testing::AllOf(HasSubstr("flightwatt.wasm.gz"), HasSubstr("scripts/build_wasm")));
    write_file_atomically(folder / "flightwatt.wasm.gz", "module");
    EXPECT_EQ(read_engine(folder), "module");
}

TEST(ScriptJson, CannotEndItsElement) {
    const Json json{{"name", "</script><!--<script>"}};
    const auto text = script_json(json);
    EXPECT_EQ(text.find('<'), std::string::npos);
    EXPECT_EQ(Json::parse(text), json);
}

TEST(LivePage, ListensToItsServerAlone) {
    const auto html = live_page_html({"p {}\n", "var a = \"</script>\";\n"});
    EXPECT_THAT(html, HasSubstr("var a = \"<\\/script>\";"));
    EXPECT_THAT(html, HasSubstr("default-src 'none'"));
    EXPECT_THAT(html, HasSubstr("connect-src 'self'"));
    for (const auto* other : {"<form", "<button", "<input", "<a ", "http://", "https://", "unsafe-eval"})
        EXPECT_THAT(html, Not(HasSubstr(other)));
    EXPECT_THAT(small_page(), Not(HasSubstr("connect-src")));
}

TEST(WebFolder, HasTheFilesOfTheProject) {
    EXPECT_TRUE(std::filesystem::equivalent(web_folder() / "theme.json", test::source_dir() / "web/theme.json"));
}

TEST(ReadFrontEnd, NeedsBothOfItsFiles) {
    const auto folder = test::scratch_dir();
    write_file_atomically(folder / "app.css", "p {}\n");
    EXPECT_THAT(test::rejected([&] { read_front_end(folder); }),
                testing::AllOf(HasSubstr("app.js"), HasSubstr("scripts/build release programs")));
    write_file_atomically(folder / "app.js", "draw();\n");
    EXPECT_EQ(read_front_end(folder).script, "draw();\n");
    EXPECT_EQ(read_front_end(folder).style, "p {}\n");
    EXPECT_THAT(test::rejected([&] { read_front_end(folder, "live"); }), HasSubstr("live.css"));
}

}  // namespace
}  // namespace flightwatt::report

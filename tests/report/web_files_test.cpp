// The files that the page is made of: found, read, or missed with the way out.

#include "report/web_files.h"

#include "base/atomic_file.h"
#include "helpers/rejected.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

TEST(WebFolder, IsThatOfTheProject) {
    EXPECT_TRUE(std::filesystem::equivalent(web_folder(), test::source_dir() / "web"));
}

TEST(ReadWebFiles, JoinsLibrariesAndScripts) {
    const auto folder = test::scratch_dir();
    for (const auto* file : {"page.css", "theme.json", "fit_width.js", "page.js"}) {
        write_file_atomically(folder / file, std::string(file) + "\n");
    }
    EXPECT_THAT(test::rejected([&] { read_web_files(folder); }),
                testing::AllOf(testing::HasSubstr("vega.min.js"),
                               testing::HasSubstr("run scripts/install_dependencies")));
    for (const std::string library : {"vega", "vega-lite", "vega-embed"}) {
        const auto build = folder / "node_modules" / library / "build";
        make_directories(build);
        write_file_atomically(build / (library + ".min.js"), library);
    }
    const auto files = read_web_files(folder);
    EXPECT_EQ(files.style, "page.css\n");
    EXPECT_EQ(files.theme, "theme.json\n");
    EXPECT_EQ(files.libraries, "vega\nvega-lite\nvega-embed\n");
    EXPECT_EQ(files.script, "fit_width.js\npage.js\n");
}

}  // namespace
}  // namespace flightwatt::report

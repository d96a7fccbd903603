#include "batch/manifest.h"

#include "base/error.h"
#include "batch/batch_files.h"
#include "helpers/rejected.h"
#include "helpers/sample_logs.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace flightwatt::batch {
namespace {

using test::write_text;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string refusal(const BatchPlan& plan, const std::filesystem::path& out) {
    try {
        refuse_foreign_files(plan, out);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

std::vector<std::string> words(const std::vector<DroppedFlight>& dropped) {
    std::vector<std::string> lines;
    for (const auto& flight : dropped) lines.push_back(flight.flight + ", " + flight.reason);
    return lines;
}

LogFile listed(const std::string& flight, const std::string& path, const std::string& place,
               const std::string& why_not_fitted = "") {
    LogFile log{path, flight, why_not_fitted};
    log.place = place;
    return log;
}

TEST(Manifest, HoldsAnyName) {
    const auto out = test::scratch_dir();
    write_manifest({listed("caf\xE9", "in/caf\xE9.data", "/in/caf\xE9.data"), listed("\"a\"", "/a", "/a", "why")}, out);
    const auto read = read_manifest(out);
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0].flight, "caf\xE9");
    EXPECT_EQ(read[0].place, "/in/caf\xE9.data");
    EXPECT_EQ(read[1].why_not_fitted, "why");
    EXPECT_EQ(read[1].place, "/a");
    EXPECT_TRUE(nlohmann::json::parse(read_file(out / manifest_name)).at("flights").is_array());
}

TEST(Manifest, IsRefusedWhereItIsNone) {
    const auto out = test::scratch_dir();
    EXPECT_THAT(read_manifest(out), IsEmpty());
    for (const auto* text : {"", "{", "[]", "{\"format\": 1}", R"({"format": 1, "files": [], "flights": [{}]})",
                             R"({"format": 1, "files": [], "flights":
                                [{"flight": "../x", "log": "", "place": "", "why_not_fitted": ""}]})",
                             R"({"format": 1, "files": [], "flights": ["x"]})",
                             R"({"format": 1, "files": [], "flights": [[{"flight": "x", "log": "x", "place": "/x",
                                "why_not_fitted": ""}]]})",
                             R"({"format": 1, "files": [], "flights":
                                [{"flight": "x\u0000", "log": "x", "place": "/x", "why_not_fitted": ""}]})",
                             R"({"format": 1, "files": [], "flights":
                                [{"flight": "x", "log": "x", "place": "/x", "why_not_fitted": ""},
                                 {"flight": "x", "log": "y", "place": "/y", "why_not_fitted": ""}]})"}) {
        write_text(out / manifest_name, text);
        EXPECT_THAT(test::rejected([&] { read_manifest(out); }), HasSubstr("batch.json: not a manifest of a batch"))
            << text;
    }
    write_text(out / manifest_name, R"({"format": 1, "files": [], "flights": [], "x": )" + std::string(1000, '[') +
                                        std::string(1000, ']') + "}");
    EXPECT_THAT(test::rejected([&] { read_manifest(out); }), HasSubstr("batch.json: not a manifest of a batch"));
    write_text(out / manifest_name, R"({"format": 99})");
    EXPECT_THAT(test::rejected([&] { read_manifest(out); }), HasSubstr("newer"));
}

TEST(Manifest, PassesOverWhatALaterVersionAdds) {
    const auto out = test::scratch_dir();
    write_text(out / manifest_name, R"({"format": 1, "files": [], "more": {"a": {"flight": "ghost", "log": "g",
        "place": "/g", "why_not_fitted": ""}}, "flights":
        [{"flight": "x", "log": "x", "place": "/x", "why_not_fitted": "", "size": {"bytes": [1]}}],
        "rest": [{"flight": "ghost"}]})");
    const auto flights = read_manifest(out);
    ASSERT_EQ(flights.size(), 1U);
    EXPECT_EQ(flights[0].flight, "x");
}

TEST(BatchPlan, RefusesFilesOfOthersWhereABatchWrites) {
    const auto folder = test::scratch_dir();
    test::copy_sample(1, folder / "in");
    const auto out = folder / "out";
    make_directories(out / "flights");
    const auto plan = plan_batch(find_logs({(folder / "in").string()}), out, false);
    EXPECT_EQ(refusal(plan, out), "");
    for (const auto* name : {"flights.csv", "model.toml", "model_errors.toml", "fit.json", "table1.md",
                             "flights/opterra_synthetic_01.series.csv", "flights/opterra_synthetic_01.record.json"}) {
        write_text(out / name, "mine");
        EXPECT_THAT(
            refusal(plan, out),
            HasSubstr((out / name).string() + " is not of a batch, as there is no batch.json, and would be replaced"))
            << name;
        std::filesystem::remove(out / name);
    }
    // The names in a batch's own folder are the batch's.
    test::batch(folder / "in", out);
    write_text(out / "model.toml", "mine");
    EXPECT_EQ(refusal(plan_batch(find_logs({(folder / "in").string()}), out, false), out), "");
}

TEST(BatchPlan, SaysWhatIsDropped) {
    const auto folder = test::scratch_dir();
    const auto out = folder / "out";
    for (int number = 1; number <= 3; ++number) test::copy_sample(number, folder / "in");
    write_text(folder / "in" / "bad.data", "rubbish");
    test::batch(folder / "in", out);
    const auto in = (folder / "in").string();
    std::filesystem::remove(folder / "in" / "opterra_synthetic_01.data");
    std::filesystem::remove(folder / "in" / "bad.data");
    const auto logs = find_logs({in + "/opterra_synthetic_03.data"});
    EXPECT_THAT(plan_batch(logs, out, false).dropped, IsEmpty());
    EXPECT_THAT(words(plan_batch(logs, out, true).dropped),
                ElementsAre("bad, its log " + in + "/bad.data is missing",
                            "opterra_synthetic_01, its log " + in + "/opterra_synthetic_01.data is missing",
                            "opterra_synthetic_02, its log " + in + "/opterra_synthetic_02.data is not in this batch"));
}

TEST(BatchPlan, NamesFlightsAfterPruningAsANewBatchDoes) {
    const auto folder = test::scratch_dir();
    const auto path = [&](const char* name) { return (folder / name / "x.data").string(); };
    for (const auto* name : {"b", "c"}) {
        std::filesystem::create_directories(folder / name);
        write_text(path(name), "");
    }
    write_manifest(
        {listed("x", path("a"), path("a")), listed("x_2", path("b"), path("b")), listed("x_3", path("c"), path("c"))},
        folder);
    const std::vector<LogFile> logs{{path("b"), "x"}, {path("c"), "x"}};
    const auto kept = plan_batch(logs, folder, false);
    EXPECT_EQ(kept.flights.size(), 3U);
    const auto plan = plan_batch(logs, folder, true);
    ASSERT_EQ(plan.flights.size(), 2U);
    EXPECT_EQ(plan.flights[0].flight + " " + plan.flights[0].path, "x " + path("b"));
    EXPECT_EQ(plan.flights[1].flight + " " + plan.flights[1].path, "x_2 " + path("c"));
    EXPECT_THAT(words(plan.dropped),
                ElementsAre("x, its log " + path("a") + " is missing", "x_2, its log " + path("b") + " is flight x now",
                            "x_3, its log " + path("c") + " is flight x_2 now"));
}

TEST(BatchPlan, KnowsLogsAgainInAFolderThatMoved) {
    const auto folder = test::scratch_dir();
    for (const auto* name : {"here", "there"}) std::filesystem::create_directories(folder / name);
    write_manifest({listed("x_2", "in/x.data", folder / "here" / "in" / "x.data")}, folder);
    const auto plan = plan_batch({{"in/x.data", "x"}}, folder, false);
    ASSERT_EQ(plan.logs.size(), 1U);
    EXPECT_EQ(plan.logs[0].flight, "x_2");
    EXPECT_TRUE(plan.logs[0].is_of_this_run);
}

}  // namespace
}  // namespace flightwatt::batch

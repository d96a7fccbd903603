#include "batch/merge.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "batch/batch_files.h"
#include "helpers/rejected.h"
#include "helpers/sample_logs.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using Paths = std::vector<std::filesystem::path>;

/// What `flightwatt batch --no-fit` does.
void batch_of(const Paths& logs, const std::filesystem::path& out, double rest_s = 10.0) {
    BatchOptions options;
    options.out = out;
    options.load.segmentation.rest_s = rest_s;
    const auto plan = plan_batch(find_logs({logs.begin(), logs.end()}), out, false);
    prepare_folder(plan, out);
    auto flights = run_batch(plan.logs, options, [](std::size_t, std::size_t, const BatchFlight&) {});
    exclude_duplicates(flights, find_duplicates(flights));
    write_file_atomically(out / catalogue_name, catalogue_csv(flights));
}

/// What `flightwatt merge` does.
MergePlan merge(const Paths& batches, const std::filesystem::path& out, bool prune = false) {
    auto plan = plan_merge(batches, out, prune);
    refuse_foreign_files(plan.folder, out);
    prepare_folder(plan.folder, out);
    auto flights = merge_flights(plan, out, [](std::size_t, std::size_t, const BatchFlight&) {});
    exclude_duplicates(flights, find_duplicates(flights));
    write_file_atomically(out / catalogue_name, catalogue_csv(flights));
    return plan;
}

/// The files that are not equal. EXPECT_EQ of their texts would take all memory to show how.
std::vector<std::string> differing(const std::map<std::string, std::string>& one,
                                   const std::map<std::string, std::string>& other) {
    std::vector<std::string> names;
    for (const auto& [name, text] : one)
        if (!other.contains(name) || other.at(name) != text) names.push_back(name);
    for (const auto& [name, text] : other)
        if (!one.contains(name)) names.push_back(name);
    return names;
}

/// Logs of equal names, one that is a copy of another, one that is no log, and two with two recordings.
Paths make_logs(const std::filesystem::path& folder) {
    Paths logs;
    for (int i = 1; i <= 4; ++i) logs.push_back(test::copy_sample(i, folder / "a"));
    logs.push_back(test::copy_sample(5, folder / "b", "opterra_synthetic_02"));
    logs.push_back(test::copy_sample(6, folder / "c", "opterra_synthetic_02"));
    logs.push_back(test::copy_sample(1, folder / "c", "again"));
    logs.push_back(folder / "c" / "opterra_synthetic_03.data");
    test::write_text(logs.back(), "rubbish\n");
    for (const auto* sub : {"a", "b"}) {
        logs.push_back(test::copy_sample(5, folder / sub, "two"));
        test::write_text(logs.back(), read_file(test::sample(5)) + read_file(test::sample(6)));
    }
    return logs;
}

TEST(Merge, GivesTheBytesOfOneBatchHoweverTheLogsWereCut) {
    const auto scratch = test::scratch_dir();
    auto logs = make_logs(scratch / "logs");
    batch_of(logs, scratch / "whole");
    const auto whole = test::contents(scratch / "whole");
    std::mt19937 random(1);  // NOLINT: the same cuts in every run
    for (int cut = 0; cut < 4; ++cut) {
        const auto folder = scratch / std::to_string(cut);
        std::ranges::shuffle(logs, random);
        // Chunks of one to three logs, each with one of the chunk before, joined two by two.
        Paths parts;
        for (std::size_t first = 0; first < logs.size();) {
            const auto last = std::min(logs.size(), first + 1 + random() % 3);
            Paths chunk(logs.begin() + static_cast<std::ptrdiff_t>(first),
                        logs.begin() + static_cast<std::ptrdiff_t>(last));
            if (first > 0) chunk.push_back(logs[first - 1]);
            parts.push_back(folder / ("part" + std::to_string(parts.size())));
            batch_of(chunk, parts.back());
            first = last;
        }
        for (int level = 0; parts.size() > 1; ++level) {
            Paths joined;
            for (std::size_t i = 0; i < parts.size(); i += 2) {
                if (i + 1 == parts.size()) {
                    joined.push_back(parts[i]);
                    continue;
                }
                joined.push_back(folder / ("level" + std::to_string(level) + "_" + std::to_string(i)));
                merge({parts[i + 1], parts[i]}, joined.back());
            }
            parts = joined;
        }
        EXPECT_THAT(differing(test::contents(parts.front()), whole), IsEmpty()) << cut;
    }
}

TEST(Merge, AgainDoesNothingAndABatchGoesOnFromIt) {
    const auto scratch = test::scratch_dir();
    const auto logs = make_logs(scratch / "logs");
    batch_of({logs[0], logs[1]}, scratch / "one");
    batch_of({logs[2], logs[4]}, scratch / "other");
    const auto out = scratch / "out";
    EXPECT_EQ(merge({scratch / "one", scratch / "other"}, out).duplicate_logs, 0U);
    const auto series = out / "flights" / "opterra_synthetic_01.series.csv";
    EXPECT_EQ(std::filesystem::hard_link_count(series), 2U);
    const auto first = test::contents(out);
    const auto flights = merge_flights(plan_merge({scratch / "one", scratch / "other"}, out, false), out,
                                       [](std::size_t, std::size_t, const BatchFlight&) {});
    EXPECT_TRUE(flights[0].was_up_to_date);
    EXPECT_THAT(differing(test::contents(out), first), IsEmpty());
    // A batch over all into the folder has nothing to do; one with other options leaves the merged batch alone.
    const auto plan =
        plan_batch(find_logs({logs[0].string(), logs[1].string(), logs[2].string(), logs[4].string()}), out, false);
    BatchOptions options;
    options.out = out;
    const auto done = run_batch(plan.logs, options, [](std::size_t, std::size_t, const BatchFlight&) {});
    EXPECT_THAT(test::done_anew(done), IsEmpty());
    const auto before = test::contents(scratch / "one");
    options.load.segmentation.cruise_fraction = 0.8;
    const auto again = run_batch(plan.logs, options, [](std::size_t, std::size_t, const BatchFlight&) {});
    EXPECT_EQ(test::done_anew(again).size(), 4U);
    EXPECT_THAT(differing(test::contents(scratch / "one"), before), IsEmpty());
}

TEST(Merge, RefusesWhatCannotBeJoined) {
    const auto scratch = test::scratch_dir();
    const auto logs = make_logs(scratch / "logs");
    const auto one = scratch / "one";
    const auto other = scratch / "other";
    batch_of({logs[0], logs[1]}, one);
    batch_of({logs[1], logs[2]}, other, 20.0);
    const auto refusal = [&](const Paths& batches, const std::filesystem::path& out) {
        return test::rejected([&] { merge(batches, out); });
    };
    EXPECT_THAT(refusal({one, other}, scratch / "out"), HasSubstr("read this log differently"));
    EXPECT_THAT(refusal({one, scratch}, scratch / "out"), HasSubstr("it has no batch.json"));
    EXPECT_THROW(merge({one, other}, one), UsageError);
    batch_of({logs[3]}, scratch / "third");
    EXPECT_THROW(merge({one}, scratch / "third"), UsageError);  // it would lose the flight that is there
    merge({one}, scratch / "third", true);
    EXPECT_EQ(test::contents(scratch / "third").count("flights/opterra_synthetic_04.record.json"), 0U);
    const auto series = one / "flights" / "opterra_synthetic_01.series.csv";
    const auto whole = read_file(series);
    write_file_atomically(series, whole + "1,2\n");
    EXPECT_THAT(refusal({one}, scratch / "changed"), HasSubstr("have changed since the batch"));
    write_file_atomically(series, whole);
    std::filesystem::remove(one / "flights" / "opterra_synthetic_02.record.json");
    EXPECT_THAT(refusal({one}, scratch / "unfinished"), HasSubstr("was not finished: opterra_synthetic_02"));
}

TEST(Merge, RefusesARecordThatWasRenamed) {
    const auto scratch = test::scratch_dir();
    batch_of({make_logs(scratch / "logs")[0]}, scratch / "one");
    for (const auto* ending : result_suffixes) {
        const auto flights = scratch / "one" / "flights";
        std::filesystem::copy_file(flights / (std::string("opterra_synthetic_01") + ending),
                                   flights / (std::string("x") + ending));
    }
    EXPECT_THAT(test::rejected([&] { read_verified_record(scratch / "one", "x"); }),
                HasSubstr("the record of opterra_synthetic_01"));
}

}  // namespace
}  // namespace flightwatt::batch

#include "batch/batch_files.h"

#include "base/atomic_file.h"
#include "flight/phases_file.h"
#include "flight/select.h"
#include "flight/series_file.h"
#include "helpers/rejected.h"
#include "helpers/sample_logs.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::batch {
namespace {

using testing::HasSubstr;

TEST(StoredFlights, AreWhatTheBatchLeft) {
    const auto scratch = test::scratch_dir();
    test::copy_sample(1, scratch / "in");
    test::copy_sample(2, scratch / "in", "<b> \"x\"");
    write_file_atomically(scratch / "in" / "rubbish.data", "rubbish\n");
    const auto done = test::batch(scratch / "in", scratch / "out");
    const auto stored = read_stored_flights(scratch / "out");
    ASSERT_EQ(stored.size(), 3U);
    EXPECT_EQ(stored[0].record.flight, "<b> \"x\"");
    EXPECT_EQ(stored[1].record.flight, "opterra_synthetic_01");
    EXPECT_FALSE(stored[2].record.accepted);
    EXPECT_THAT(stored[2].record.error, HasSubstr("rubbish.data"));
    EXPECT_EQ(stored[1].series.current_origin, flight::CurrentOrigin::sensor);
    const auto files = test::contents(scratch / "out");
    EXPECT_EQ(to_csv(stored[1].series), files.at("flights/opterra_synthetic_01.series.csv"));
    EXPECT_EQ(phases_csv(select_tracks(stored[1].series), stored[1].phases),
              files.at("flights/opterra_synthetic_01.phases.csv"));
}

TEST(StoredFlights, RefuseWhatIsNoBatchFolder) {
    const auto scratch = test::scratch_dir();
    EXPECT_THAT(test::rejected([&] { read_stored_flights(scratch); }), HasSubstr("it has no batch.json"));
    write_manifest({}, scratch);
    make_directories(scratch / "flights");
    EXPECT_THAT(test::rejected([&] { read_stored_flights(scratch); }), HasSubstr("flight record"));
    test::write_text(scratch / "flights" / "a.record.json", "{}");
    EXPECT_THAT(test::rejected([&] { read_stored_flights(scratch); }), HasSubstr("flight record"));
}

TEST(StoredFlights, AreNotBelievedOnceTheyWereChanged) {
    const auto scratch = test::scratch_dir();
    const auto log = test::copy_sample(1, scratch / "in");
    const auto out = scratch / "out";
    test::batch(scratch / "in", out);
    for (const auto* ending : result_suffixes) {
        const auto file = out / "flights" / (std::string("opterra_synthetic_01") + ending);
        auto text = read_file(file);
        const auto whole = text;
        text[text.size() / 2] = text[text.size() / 2] == '1' ? '2' : '1';
        write_file_atomically(file, text);
        std::filesystem::rename(log, scratch / "away");
        const auto stored = read_stored_flights(out);
        ASSERT_EQ(stored.size(), 1U) << ending;
        EXPECT_FALSE(stored[0].record.accepted);
        EXPECT_THAT(stored[0].damage_reason, HasSubstr("its log is missing"));
        std::filesystem::rename(scratch / "away", log);
        EXPECT_THAT(test::rejected([&] { read_stored_flights(out); }), HasSubstr("run flightwatt batch again"));
        write_file_atomically(file, whole);
        EXPECT_EQ(read_stored_flights(out)[0].damage_reason, "");
    }
}

}  // namespace
}  // namespace flightwatt::batch

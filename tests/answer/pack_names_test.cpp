#include "answer/pack_names.h"

#include "helpers/rejected.h"
#include "helpers/test_paths.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::answer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

PackUse use_of(const std::string& flight, const std::string& serial = {}, const std::string& folder = {}) {
    PackUse use;
    use.flight = flight;
    use.aircraft = "7 Wing";
    use.serial = serial;
    use.folder = folder;
    use.start_s = 1'772'323'200.0;  // 2026-03-01
    return use;
}

std::vector<ListedPack> listed(const std::string& text) {
    const auto file = test::scratch_dir() / "packs.toml";
    return read_packs_file(test::write_text(file, text));
}

std::vector<std::string> packs_of(const std::vector<PackUse>& uses) {
    std::vector<std::string> names;
    for (const auto& use : uses) names.push_back(use.pack + " by " + to_string(use.named_by));
    return names;
}

TEST(PackNames, AreOfTheListThenOfTheSerialNumber) {
    std::vector<PackUse> uses{use_of("y6_1", "77"), use_of("y6_2", "77"), use_of("hex_1"), use_of("quad")};
    uses[2].start_s = *uses[2].start_s + 86400.0;
    const auto notes =
        name_packs(uses, listed("[[pack]]\nname = \"A1\"\nflights = [\"y6_1\", \"z*\"]\n"
                                "[[pack]]\nname = \"77\"\ncapacity_ah = 5\n"
                                "[[pack]]\nname = \"B\"\nsince = \"2026-03-02\"\nuntil = \"2026-03-02\"\n"
                                "[[pack]]\nname = \"C\"\n"));
    EXPECT_THAT(packs_of(uses), ElementsAre("A1 by packs.toml", "77 by serial number", "B by packs.toml", " by none"));
    EXPECT_EQ(uses[1].label_ah, 5.0);
    EXPECT_THAT(notes,
                ElementsAre("packs.toml:2:1: pack 'A1' has no flight 'z*'", HasSubstr("pack 'C' has no flight")));
}

TEST(PackNames, AreOfFoldersWithoutDatesWhereLogsStandInSeveral) {
    std::vector<PackUse> uses{use_of("a", "", "red"), use_of("b", "", "blue")};
    EXPECT_THAT(name_packs(uses, {}),
                ElementsAre(HasSubstr("the folders of its logs are taken for its packs: blue, red")));
    EXPECT_THAT(packs_of(uses), ElementsAre("red by folder", "blue by folder"));
    for (const auto* other : {"2026-03-01", "26_03_01", "red"}) {
        std::vector<PackUse> of_days{use_of("a", "", "red"), use_of("b", "", other)};
        EXPECT_THAT(name_packs(of_days, {}), IsEmpty()) << other;
        EXPECT_EQ(of_days[0].pack, "") << other;
    }
}

TEST(PackNames, WarnOfSerialNumbersThatContradictTheList) {
    std::vector<PackUse> uses{use_of("a", "12"), use_of("b", "34")};
    const auto notes = name_packs(uses, listed("[[pack]]\nname = \"A1\"\nflights = [\"*\"]\n"));
    EXPECT_THAT(notes, ElementsAre(HasSubstr("several serial numbers: 12, 34")));
}

TEST(PackNames, RefuseListsThatCannotBeMeant) {
    const auto error = [](const std::string& text) {
        return test::rejected([&] {
            std::vector<PackUse> uses{use_of("a")};
            name_packs(uses, listed(text));
        });
    };
    EXPECT_THAT(error(""), HasSubstr("has no [[pack]]"));
    EXPECT_THAT(error("[[pack]]\nname = \"A\"\nflight = [\"a\"]\n"), HasSubstr("flight"));
    EXPECT_THAT(error("[[pack]]\nname = \"A\"\n[[pack]]\nname = \"A\"\n"), HasSubstr("is there twice"));
    EXPECT_THAT(error("[[pack]]\nname = \"A\"\nsince = \"march\"\n"), HasSubstr("expected a day"));
    EXPECT_THAT(error("[[pack]]\nname = \"A\"\ncapacity_ah = 5000\n"), HasSubstr("mAh"));
    EXPECT_THAT(error("[[pack]]\nname = \"A\"\nflights = [\"a\"]\n[[pack]]\nname = \"B\"\nflights = [\"*\"]\n"),
                HasSubstr("pack 'A' and pack 'B' both have the flight a"));
}

TEST(PackNames, ChooseOnePack) {
    std::vector<PackUse> uses{use_of("a", "12"), use_of("b", "34")};
    name_packs(uses, {});
    EXPECT_THROW(choose_pack(uses, "56"), UsageError);
    choose_pack(uses, "34");
    ASSERT_EQ(uses.size(), 1U);
    EXPECT_EQ(uses[0].flight, "b");
}

TEST(PackUses, OfAnotherPackInALogHaveNoSerialNumber) {
    flight::FlightData data;
    data.flight = "26_03_05__10_00_00";
    data.pack_serial = "12";
    data.pack_cycles = 30.0;
    std::vector<battery::DischargeRecord> records(2);
    for (auto& record : records) record.time_s = {10.0, 20.0};
    records[0].flight = data.flight;
    records[1].flight = data.flight + "#2";
    records[1].is_other_pack = true;
    const auto uses = pack_uses(data, records, "red");
    EXPECT_EQ(uses[0].serial, "12");
    EXPECT_EQ(uses[0].cycles, 30.0);
    EXPECT_EQ(uses[1].serial, "");
    EXPECT_FALSE(uses[1].cycles);
    EXPECT_DOUBLE_EQ(uses[0].start_s.value(), 1'772'704'810.0) << "by the name";
}

}  // namespace
}  // namespace flightwatt::answer

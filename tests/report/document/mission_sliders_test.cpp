// What a reader may change in the missions of a page, and the files that the program in the page then reads.

#include "report/document/mission_sliders.h"

#include "base/atomic_file.h"
#include "helpers/test_paths.h"
#include "mission/mission_file.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::report {
namespace {

namespace fs = std::filesystem;

using testing::ElementsAre;

mission::MissionSetup setup_of_file(const fs::path& file) {
    return setup_of(mission::read_mission(file, {.allow_unplanned = true}));
}

/// The document of missions, which are not simulated: sliders need their setups alone.
Json document_of(const std::vector<fs::path>& files) {
    std::vector<SimulatedMission> missions(files.size());
    Json document{{"missions", Json::array()}, {"files", Json::array()}};
    for (std::size_t i = 0; i < files.size(); ++i) {
        missions[i].mission.setup = setup_of_file(files[i]);
        document["missions"].push_back({{"again", nullptr}});
    }
    add_sliders(missions, document);
    return document;
}

/// The keys of a mission's sliders, with the number of their places.
std::vector<std::string> keys_of(const Json& document) {
    std::vector<std::string> keys;
    for (const auto& slider : document["missions"][0]["again"]["sliders"])
        keys.push_back(slider["key"].get<std::string>() + " " + std::to_string(slider["places"].size()));
    return keys;
}

fs::path of_project(const std::string& name) { return test::source_dir() / name; }

TEST(MissionSliders, FilesOfAllMissionsFitTogether) {
    std::vector<fs::path> files;
    for (const auto* folder : {"missions/paper", "missions/synthetic"})
        for (const auto& entry : fs::directory_iterator(of_project(folder)))
            if (entry.path().extension() == ".toml") files.push_back(entry.path());
    const auto document = document_of(files);
    const auto tree = test::scratch_dir();
    for (const auto& file : document["files"]) {
        const auto place = tree / file["path"].get<std::string>();
        fs::create_directories(place.parent_path());
        write_file_atomically(place, file["text"].get<std::string>());
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto& again = document["missions"][i]["again"];
        if (files[i].stem() == "several-packs") {
            EXPECT_TRUE(again.is_null());
            continue;
        }
        EXPECT_EQ(again["file"], files[i].lexically_relative(test::source_dir()).string()) << "without other folders";
        EXPECT_EQ(setup_of_file(tree / again["file"].get<std::string>()).duration_s.values,
                  setup_of_file(files[i]).duration_s.values);
    }
}

TEST(MissionSliders, AreOfWhatTheMissionOrItsModelKnows) {
    EXPECT_THAT(keys_of(document_of({of_project("missions/synthetic/survey-path.toml")})),
                ElementsAre("reserve_soc_percent 1", "wind.speed_m_per_s 1", "wind.from_deg 1",
                            "path.airspeed_m_per_s 1", "capacity_ah 0"));
    EXPECT_THAT(keys_of(document_of({of_project("missions/paper/adaptive.toml")})),
                ElementsAre("reserve_soc_percent 0", "capacity_ah 0", "detection.fps 1", "detection.fps 1",
                            "encryption.key_bits 1", "encryption.key_bits 1"));
    EXPECT_THAT(keys_of(document_of({of_project("missions/synthetic/thevenin-plan.toml")})),
                ElementsAre("reserve_soc_percent 1", "capacity_ah 0"))
        << "its rates are planned";
}

TEST(MissionSliders, ChangeARateWhereverTheScheduleHasItWithinItsProfile) {
    const auto file = test::scratch_dir() / "mission.toml";
    const auto fits = of_project("fits").string();
    write_file_atomically(file,
                          "mechanical = '" + fits + "/mechanical/opterra-table1.toml'\nbattery = '" + fits +
                              "/battery/paper.toml'\n[components.\"ü\"]\nprofile = '" + fits +
                              "/compute/tx2-detection.csv'\n[[schedule]]\nphase = \"cruise\"\n" +
                              "run = { \"ü\" = { fps = 10} }\n[[schedule]]\notherwise = true\nrun.\"ü\".fps=10.0");
    const auto document = document_of({file});
    const auto slider = document["missions"][0]["again"]["sliders"].back();
    EXPECT_EQ(slider, Json::parse(R"({"key": "ü.fps", "value": 10.0, "low": 5.8, "high": 32.0,
                                      "places": [{"line": 7, "column": 17}, {"line": 10, "column": 9}]})"));
    EXPECT_EQ(document["missions"][0]["again"]["file"], "mission.toml");
    std::vector<std::string> paths;
    for (const auto& one : document["files"]) paths.push_back(one["path"].get<std::string>());
    EXPECT_THAT(paths, ElementsAre("mission.toml", fits + "/battery/paper.toml", fits + "/compute/tx2-detection.csv",
                                   fits + "/mechanical/opterra-table1.toml"))
        << "as the mission names them";
}

}  // namespace
}  // namespace flightwatt::report

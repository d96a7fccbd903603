// A new mission holds every key of docs/missions.md, and each that it has as a comment is read once it is a key.

#include "base/atomic_file.h"
#include "base/error.h"
#include "battery/battery.h"
#include "battery/battery_toml.h"
#include "compute/profile_reader.h"
#include "helpers/document.h"
#include "helpers/test_paths.h"
#include "mission/mission_file.h"
#include "mission/mission_read_options.h"
#include "mission/new_mission_toml.h"

#include <algorithm>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace flightwatt::test {
namespace {

/// A folder with the files that missions of it name.
class NewMissions : public testing::Test {
  protected:
    std::filesystem::path folder = scratch_dir();
    static constexpr auto model = "synthetic-wing.toml";

    void SetUp() override {
        copy("fits/mechanical/synthetic-wing.toml");
        copy("fits/battery/paper.toml");
        copy("fits/compute/tx2-detection.csv");
        write_file_atomically(folder / "no-header.csv", "5.8,20\n10,22\n16,23\n25,25\n32,27\n");
        write_file_atomically(folder / "with-flags.csv", "200,100\n5.8,20\n10,22\n16,23\n25,25\n32,27\n");
        write_file_atomically(folder / "survey.csv", "east_m,north_m\n500,0\n900,400\n");
        write_file_atomically(folder / "flight_plan.xml",
                              "<flight_plan lat0=\"43.46223\" lon0=\"1.27289\" alt=\"260\"><waypoints>"
                              "<waypoint name=\"1\" x=\"300\" y=\"10\"/><waypoint name=\"2\" x=\"500\" y=\"90\"/>"
                              "<waypoint name=\"STDBY\" x=\"40\" y=\"70\"/></waypoints><blocks><block name=\"Survey\">"
                              "<oval p1=\"1\" p2=\"2\" radius=\"nav_radius\"/></block></blocks></flight_plan>\n");
        copy("missions/synthetic/field.geojson");
    }

    /// The mission, with the schedule planned or given.
    std::string text_for(bool is_planned, bool shows_all_keys = true) const {
        mission::NewMission fresh;
        fresh.name = "survey";
        fresh.mechanical = model;
        fresh.model = mechanical::read_mechanical_model(folder / model);
        fresh.battery = "paper.toml";
        fresh.pack = battery::read_battery(folder / "paper.toml");
        fresh.components.push_back(
            {"detection", "tx2-detection.csv", compute::read_power_profile(folder / "tx2-detection.csv")});
        fresh.is_planned = is_planned;
        fresh.shows_all_keys = shows_all_keys;
        return new_mission_toml(fresh);
    }

    std::string why_refused(const std::string& text, bool may_lack_schedule) const {
        try {
            mission::MissionReadOptions reading;
            reading.allow_unplanned = may_lack_schedule;
            mission::parse_mission(text, folder / "mission.toml", reading);
            return "";
        } catch (const InputError& error) {
            return std::string(error.what()) + " " + error.hint();
        }
    }

  private:
    void copy(const std::string& file) const {
        const auto from = source_dir() / file;
        write_file_atomically(folder / from.filename(), read_file(from));
    }
};

bool is_commented_key(const std::string& line) { return line.size() > 1 && line[0] == '#' && line[1] != ' '; }

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = text.find('\n', at);
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

/// The numbers of the lines of each block of commented keys: [begin, end).
std::vector<std::pair<std::size_t, std::size_t>> blocks_of(const std::vector<std::string>& lines) {
    std::vector<std::pair<std::size_t, std::size_t>> blocks;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!is_commented_key(lines[i])) continue;
        if (blocks.empty() || blocks.back().second != i) blocks.emplace_back(i, i);
        blocks.back().second = i + 1;
    }
    return blocks;
}

/// The text with one block taken out of its comment. What the comments state goes instead of it is left out: of a plan
/// and a policy the schedule, of a utility the one that is there, of a path the airspeed.
std::string with_block(const std::vector<std::string>& lines, const std::pair<std::size_t, std::size_t>& block) {
    const auto& first = lines[block.first];
    const bool decides = first.starts_with("#[plan]") || first.starts_with("#[policy]");
    const bool is_utility = first.starts_with("#utility");
    const bool states_cruise = first.starts_with("#[path]");
    std::string text;
    bool in_schedule = false;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const bool is_taken = i >= block.first && i < block.second;
        if (lines[i].starts_with("[")) in_schedule = lines[i] == "[[schedule]]";
        if (!is_taken && decides && in_schedule && !lines[i].starts_with("#")) continue;
        if (!is_taken && is_utility && lines[i].starts_with("utility")) continue;
        if (!is_taken && states_cruise && lines[i].starts_with("airspeed_m_per_s")) continue;
        if (!is_taken && states_cruise && lines[i].starts_with("duration_s")) continue;
        text += (is_taken ? lines[i].substr(1) : lines[i]) + "\n";
    }
    return text;
}

TEST_F(NewMissions, AreReadAsTheyAre) {
    EXPECT_EQ(why_refused(text_for(false), false), "");
    EXPECT_EQ(why_refused(text_for(true), true), "");
}

TEST_F(NewMissions, AreShortWithoutAllKeys) {
    for (const bool is_planned : {false, true}) {
        const auto text = text_for(is_planned, false);
        EXPECT_EQ(why_refused(text, is_planned), "");
        EXPECT_LT(text.find("--all-keys"), text.find('\n')) << "the first line names the option";
        EXPECT_LE(lines_of(text).size(), 17U) << text;
    }
}

TEST_F(NewMissions, HoldEveryKeyOfTheDocumentation) {
    const auto page = read_document(source_dir() / "docs" / "missions.md");
    const auto text = text_for(false) + text_for(true);
    std::size_t keys = 0;
    for (const auto& documented : page.keys) {
        const bool is_free = std::ranges::all_of(documented.key, [](char c) { return c >= 'A' && c <= 'Z'; });
        if (documented.section != "Mission file" || is_free) continue;
        ++keys;
        EXPECT_TRUE(std::regex_search(text, std::regex("(^|[^a-z_])" + documented.key + "([^a-z_]|$)")))
            << "line " << documented.line << ": config/new_mission.toml.in lacks " << documented.key;
    }
    EXPECT_GT(keys, 80U) << "the page was not read";
}

TEST_F(NewMissions, HaveNoCommentedKeyThatIsRefused) {
    std::set<std::string> tried;
    for (const bool is_planned : {false, true}) {
        const auto usual = lines_of(text_for(is_planned));
        for (const auto& block : blocks_of(usual)) {
            std::string why;
            bool is_read = false;
            const auto text = with_block(usual, block);
            for (const auto* profile : {"tx2-detection.csv", "no-header.csv", "with-flags.csv"}) {
                const auto refused =
                    why_refused(std::regex_replace(text, std::regex("tx2-detection\\.csv"), profile), true);
                is_read = is_read || refused.empty();
                if (!refused.empty()) why += std::string("\n") + profile + ": " + refused;
            }
            tried.insert(usual[block.first]);
            EXPECT_TRUE(is_read) << usual[block.first] << why;
        }
    }
    EXPECT_GE(tried.size(), 18U);
}

}  // namespace
}  // namespace flightwatt::test

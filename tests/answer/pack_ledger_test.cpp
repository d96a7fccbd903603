// Packs whose flights, ageing and mixtures are known.

#include "answer/pack_ledger.h"

#include "base/error.h"
#include "helpers/synthetic_discharge.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flightwatt::answer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double march_s = 1'772'323'200.0;  // 2026-03-01
constexpr double first_ohm = 0.08;
constexpr double full_ah = 2.4;

/// A flight of 1.1 to 1.5 Ah, unless it is given, of a pack on a day after 1 March.
PackUse flown(const std::string& pack, double day, double ohm, std::uint64_t seed, double missing_ah = 0.0,
              double drawn_ah = 0.0, double capacity_ah = full_ah) {
    auto battery = test::known_pack();
    battery.resistance_ohm = ohm;
    battery.capacity_ah = capacity_ah;
    test::SyntheticDischarge settings;
    settings.interval_s = 2.2;
    settings.initial_charge_ah = missing_ah;
    const double ah = drawn_ah > 0.0 ? drawn_ah : 1.1 + 0.1 * static_cast<double>(seed % 5);
    settings.duration_s = 265.0 + ah * 3600.0 / settings.cruise_a;
    PackUse use;
    use.flight = "f" + std::to_string(seed);
    use.aircraft = "7 Wing";
    use.start_s = march_s + day * seconds_per_day;
    use.record = test::discharge_record(test::synthetic_discharge(battery, settings, seed));
    use.record.flight = use.flight;
    use.pack = pack;
    use.named_by = pack.empty() ? PackNaming::none : PackNaming::serial;
    return use;
}

/// A flies in the morning and keeps its resistance, B in the afternoon and doubles its own twice over.
std::vector<PackUse> two_packs(bool are_named, double b_ohm = first_ohm) {
    std::vector<PackUse> uses;
    for (int f = 0; f < 7; ++f) {
        const double day = 12.0 * f;
        const auto seed = 10 * static_cast<std::uint64_t>(f);
        uses.push_back(flown(are_named ? "A" : "", day + 0.3, first_ohm, seed + 1));
        uses.push_back(flown(are_named ? "B" : "", day + 0.6, b_ohm * (1.0 + (are_named ? 0.4 * f : 0.0)), seed + 2));
    }
    return uses;
}

std::vector<std::string> names(const PackLedger& ledger) {
    std::vector<std::string> found;
    for (const auto& pack : ledger.packs) found.push_back(pack.name + ": " + to_string(pack.condition.health));
    return found;
}

TEST(PackLedger, FindsWhichOfTwoPacksAges) {
    const auto ledger = make_pack_ledger(two_packs(true), {.capacity_ah = full_ah});
    EXPECT_THAT(names(ledger), ElementsAre("A: healthy", "B: retire"));
    const auto& [a, b] = std::pair(ledger.packs.at(0), ledger.packs.at(1));
    EXPECT_EQ(a.uses.size(), 7U);
    EXPECT_NEAR(*a.resistance_ohm, first_ohm, 0.1 * first_ohm);
    EXPECT_LT(a.resistance.change_interval_percent->low, 5.0);
    const double rc_ohm = test::known_pack().thevenin->rc_resistance_ohm;
    EXPECT_NEAR(*b.resistance.change_percent, 240.0 * first_ohm / (first_ohm + rc_ohm), 40.0) << "with the RC pair";
    EXPECT_NEAR(a.energy_wh, a.charge_ah * 11.4, 0.05 * a.energy_wh);
    EXPECT_NEAR(*a.equivalent_cycles, a.charge_ah / full_ah, 0.01);
    EXPECT_FALSE(a.temperature_c);
    EXPECT_THAT(describe(b), HasSubstr("pack B: retire: "));
}

TEST(PackLedger, DividesUnnamedPacksOnlyWhereTheyWereFlownInTurnWithUnlikeResistances) {
    const auto unlike = make_pack_ledger(two_packs(false, 2.0 * first_ohm), {.capacity_ah = full_ah});
    ASSERT_EQ(unlike.packs.size(), 2U);
    EXPECT_EQ(unlike.packs[0].uses.size(), 7U);
    EXPECT_THAT(unlike.packs[0].name, HasSubstr("unnamed, "));
    const auto like = make_pack_ledger(two_packs(false), {.capacity_ah = full_ah});
    ASSERT_EQ(like.packs.size(), 1U);
    EXPECT_TRUE(like.packs[0].may_be_several);
    EXPECT_THAT(like.packs[0].condition.reason, HasSubstr("nothing names their packs"));
}

TEST(PackLedger, DoesNotDivideAPackThatAgesOrRetireOneThatMayBeSeveral) {
    auto uses = two_packs(true);
    std::erase_if(uses, [](const auto& use) { return use.pack == "A"; });
    for (auto& use : uses) {
        use.pack = "";
        use.named_by = PackNaming::none;
    }
    const auto ledger = make_pack_ledger(uses, {.capacity_ah = full_ah});
    EXPECT_THAT(names(ledger), ElementsAre("unnamed: watch"));
}

TEST(PackLedger, FollowsAPartlyUsedPack) {
    std::vector<PackUse> uses;
    double missing_ah = 0.0;
    for (std::uint64_t f = 0; f < 3; ++f) {
        uses.push_back(flown("", 0.3 + 0.1 * static_cast<double>(f), first_ohm, 40 + f, missing_ah, 0.6));
        missing_ah += uses.back().record.charge_ah.back();
    }
    const auto ledger = make_pack_ledger(uses, {.capacity_ah = full_ah});
    EXPECT_EQ(ledger.uses[1].continues, "f40");
    EXPECT_EQ(ledger.uses[2].continues, "f41");
    ASSERT_EQ(ledger.packs.size(), 1U);
    EXPECT_EQ(ledger.packs[0].partly_used, 2U);
    EXPECT_FALSE(ledger.packs[0].may_be_several) << "each flight begins where another one ended";
    EXPECT_EQ(ledger.packs[0].condition.health, PackHealth::unknown);
    EXPECT_THAT(ledger.packs[0].condition.reason, HasSubstr("3 flights, expected 5 or more"));
    uses[2].start_s = *uses[2].start_s + 3.0 * seconds_per_day;
    EXPECT_EQ(make_pack_ledger(uses, {.capacity_ah = full_ah}).uses[2].continues, "") << "days later";
}

TEST(PackLedger, ComparesTheCapacityWithTheLabel) {
    std::vector<PackUse> worn;
    for (std::uint64_t f = 0; f < 6; ++f) {
        worn.push_back(flown("old", 10.0 * static_cast<double>(f), first_ohm, 60 + f, 0.0, 1.45, 1.6));
        worn.back().label_ah = full_ah;
    }
    const auto ledger = make_pack_ledger(worn);
    const auto& pack = ledger.packs.at(0);
    EXPECT_NEAR(*pack.capacity_ah, 1.6, 0.2);
    EXPECT_GE(pack.condition.health, PackHealth::watch) << pack.condition.reason;
    EXPECT_THAT(pack.condition.reason, HasSubstr("of 2.4 Ah"));
    for (auto& use : worn) use.label_ah = 1.0;  // they drew more
    const auto refused = make_pack_ledger(worn);
    EXPECT_THAT(refused.notes, testing::Contains(HasSubstr("drew more than the 1 Ah of its label")));
    EXPECT_THROW(make_pack_ledger(two_packs(true), {.capacity_ah = 0.5}), UsageError);
}

/// Flights of a pack that is cold, with 2.2 times its resistance, in the later half; the last is warm.
PackLedger of_winter(std::optional<double> battery::DischargeRecord::*temperature_c) {
    std::vector<PackUse> uses;
    for (std::uint64_t f = 0; f < 12; ++f) {
        const bool is_winter = f >= 6;
        uses.push_back(flown("A", 15.0 * static_cast<double>(f), is_winter ? 2.2 * first_ohm : first_ohm, 80 + f));
        if (f == 11) uses.back().record = flown("A", 0.0, first_ohm, 99).record;
        uses.back().record.air_temperature_c = 20.0;
        uses.back().record.*temperature_c = is_winter && f < 11 ? 2.0 : 20.0;
    }
    for (auto& use : uses) use.record.flight = use.flight;
    return make_pack_ledger(uses, {.capacity_ah = full_ah});
}

TEST(PackLedger, ComparesFlightsOfLikeTemperatureAlone) {
    for (const auto& [temperature_c, of] : {std::pair{&battery::DischargeRecord::air_temperature_c, "air"},
                                            std::pair{&battery::DischargeRecord::battery_start_c, "battery"}}) {
        const auto ledger = of_winter(temperature_c);
        EXPECT_THAT(names(ledger), ElementsAre("A: healthy"));
        EXPECT_EQ(ledger.packs[0].temperature_of, of);
        EXPECT_NEAR(*ledger.packs[0].temperature_c, 20.0, 1e-9);
        EXPECT_NEAR(*ledger.packs[0].resistance_ohm, first_ohm, 0.1 * first_ohm);
    }
}

TEST(PackLedger, DoesNotTakeTheColdOfAutumnForWear) {
    std::vector<PackUse> uses;
    for (std::uint64_t f = 0; f < 12; ++f) {
        const auto weeks = static_cast<double>(f);
        const double temperature_c = 24.0 - 1.5 * weeks;
        uses.push_back(flown("A", 7.0 * weeks, first_ohm * std::exp(0.025 * (24.0 - temperature_c)), 120 + f));
        uses.back().record.battery_start_c = temperature_c;
    }
    const auto ledger = make_pack_ledger(uses, {.capacity_ah = full_ah});
    EXPECT_THAT(names(ledger), ElementsAre("A: healthy"));
    EXPECT_NEAR(*ledger.packs[0].temperature_c, 19.5, 1e-9) << "the last five of 24 to 16.5 degrees";
}

TEST(CapacityDoubt, NamesPacksThatMayBeSeveral) {
    EXPECT_EQ(capacity_doubt({}), "");
    std::vector<Pack> packs(1);
    packs[0].uses = {0, 1};
    EXPECT_EQ(capacity_doubt(packs), "") << "named, or each flight begins where another one ended";
    packs[0].may_be_several = true;
    EXPECT_EQ(capacity_doubt(packs), ", if of one pack");
    packs[0].uses = {0};
    EXPECT_EQ(capacity_doubt(packs), "");
    packs.resize(2);
    EXPECT_THAT(capacity_doubt(packs), HasSubstr("--pack NAME"));
}

TEST(PackLedger, DividesPacksOfOtherNumbersOfCells) {
    std::vector<PackUse> uses{flown("", 0.0, first_ohm, 1), flown("", 1.0, first_ohm, 2)};
    for (auto& voltage_v : uses[1].record.voltage_v) voltage_v *= 2.0;
    uses[1].record.resting_voltage_v *= 2.0;
    const auto ledger = make_pack_ledger(uses);
    ASSERT_EQ(ledger.packs.size(), 2U);
    EXPECT_EQ(*ledger.packs[0].cells, 3);
    EXPECT_EQ(*ledger.packs[1].cells, 6);
}

TEST(PackLedger, IsOfSomeFlightsWhereThereAreMany) {
    const auto ledger = make_pack_ledger(two_packs(true), {.capacity_ah = full_ah, .max_uses = 5});
    EXPECT_THAT(ledger.notes,
                testing::Contains("pack A: resistance and capacity are of 5 of its 7 flights: some evenly "
                                  "chosen, the fullest and the deepest"));
    EXPECT_THAT(names(ledger), ElementsAre("A: healthy", testing::_));
}

TEST(PackLedger, TakesAnIdentificationOfTheSameUsesAndCapacityAlone) {
    std::vector<PackUse> uses;
    std::vector<battery::DischargeRecord> records;
    for (std::uint64_t f = 1; f < 7; ++f) {
        uses.push_back(flown("A", static_cast<double>(f), first_ohm, f));
        records.push_back(uses.back().record);
    }
    auto known = identify_battery(records, {full_ah, {}, "", true});
    const auto own = make_pack_ledger(uses, {.capacity_ah = full_ah});
    const auto same = make_pack_ledger(uses, {.capacity_ah = full_ah, .known = &known});
    EXPECT_EQ(describe(same.packs.at(0)), describe(own.packs.at(0)));
    known.cells = 77;
    EXPECT_EQ(make_pack_ledger(uses, {.capacity_ah = full_ah, .known = &known}).packs.at(0).cells, 77);
    EXPECT_EQ(make_pack_ledger(uses, {.capacity_ah = 1.1 * full_ah, .known = &known}).packs.at(0).cells, 3);
    uses.pop_back();
    EXPECT_EQ(make_pack_ledger(uses, {.capacity_ah = full_ah, .known = &known}).packs.at(0).cells, 3);
}

}  // namespace
}  // namespace flightwatt::answer

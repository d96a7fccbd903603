#include "telemetry/message_definition.h"

#include <set>

#include <gtest/gtest.h>

namespace flightwatt::telemetry {
namespace {

using units::Quantity;

void expect_conversion(const std::string& message, const FieldDefinition& field, Quantity quantity, double factor) {
    const auto conversion = find_conversion(message, field);
    EXPECT_EQ(conversion.quantity, quantity) << message << "." << field.name;
    EXPECT_DOUBLE_EQ(conversion.factor, factor) << message << "." << field.name;
}

TEST(ConversionOf, FollowsTheDeclaredUnit) {
    expect_conversion("ENERGY", {"power", "float", "W", "", {}}, Quantity::watt, 1.0);
    expect_conversion("ENERGY", {"energy", "uint16", "mAh", "", {}}, Quantity::ampere_hour, 1e-3);
    expect_conversion("BAT", {"voltage", "uint8", "1e-1V", "", {}}, Quantity::volt, 0.1);
    expect_conversion("GPS", {"speed", "uint16", "cm/s", "", {}}, Quantity::metre_per_second, 0.01);
}

TEST(ConversionOf, TakesTheAlternativeUnitWhereTheDeclaredOneIsNone) {
    expect_conversion("ROTORCRAFT_FP", {"up", "int32", "", "m", 0.00390625}, Quantity::metre, 0.00390625);
    expect_conversion("X", {"up", "int32", "cm", "m", 0.5}, Quantity::metre, 0.01);
    EXPECT_FALSE(find_conversion("X", {"up", "int32", "", "m", {}}).quantity) << "no coefficient";
    EXPECT_FALSE(find_conversion("X", {"mode", "uint8", "", "", {}}).quantity);
    EXPECT_EQ(find_conversion("X", {"mode", "uint8", "", "", {}}).factor, 1.0);
}

TEST(ConversionOf, TakesTheCurrentOfBatInHundredths) {
    expect_conversion("BAT", {"amps", "int16", "A", "", {}}, Quantity::ampere, 0.01);
    expect_conversion("BAT", {"amps", "int16", "1e-2A", "", {}}, Quantity::ampere, 0.01);
    expect_conversion("ESC", {"amps", "float", "A", "", {}}, Quantity::ampere, 1.0);
}

TEST(UndeclaredUnit, IsThatOfPaparazzisOwnDefinition) {
    const auto definition_of = [](const std::string& message, const std::vector<std::string>& names) {
        MessageDefinition definition{message, {}, ".log"};
        for (const auto& name : names) definition.fields.push_back({name, "float", "", "", {}});
        return definition;
    };
    const auto device = definition_of("POWER_DEVICE", {"node_id", "circuit", "current", "voltage", "more"});
    EXPECT_EQ(undeclared_unit(device, 2), "A");
    EXPECT_EQ(undeclared_unit(device, 3), "V");
    EXPECT_EQ(undeclared_unit(device, 0), "");
    EXPECT_EQ(undeclared_unit(definition_of("PONG", {"current"}), 0), "");
    // Energy was mAh and is Wh: the fields next to it show.
    EXPECT_EQ(undeclared_unit(definition_of("ENERGY", {"bat", "amp", "energy", "power"}), 2), "mAh");
    EXPECT_EQ(undeclared_unit(definition_of("ENERGY", {"energy", "power"}), 0), "");
    EXPECT_EQ(undeclared_unit({"ENERGY", {{"power", "float", "mW", "", {}}}, ".log"}, 0), "");
}

TEST(FieldIndex, IsOfTheNameAlone) {
    const MessageDefinition definition{"X", {{"a", "", "", "", {}}, {"b", "", "", "", {}}}, ".log"};
    EXPECT_EQ(field_index(definition, "b"), 1U);
    EXPECT_FALSE(field_index(definition, "B"));
}

/// Layouts are distinguished by their numbers of fields, so no two of one message may have the same.
TEST(BuiltinDefinitions, OfAMessageDifferInTheirNumbersOfFields) {
    for (const auto* message : {"ENERGY", "BAT", "ESC", "POWER_DEVICE", "ESTIMATOR", "GPS", "GPS_INT", "AIR_DATA",
                                "WIND_INFO", "ROTORCRAFT_FP", "TAKEOFF", "PPRZ_MODE", "NAVIGATION", "NAVIGATION_REF"}) {
        const auto& layouts = builtin_definitions(message);
        ASSERT_FALSE(layouts.empty()) << message;
        std::set<std::size_t> sizes;
        for (const auto& layout : layouts) {
            EXPECT_EQ(layout.name, message);
            EXPECT_TRUE(sizes.insert(layout.fields.size()).second) << message << ", " << layout.origin;
            std::set<std::string> names;
            for (const auto& field : layout.fields) EXPECT_TRUE(names.insert(field.name).second) << field.name;
        }
    }
    EXPECT_TRUE(builtin_definitions("PONG").empty());
}

TEST(BuiltinDefinitions, HaveUnitsThatAreKnown) {
    for (const auto& layout : builtin_definitions("ENERGY")) {
        const auto power = field_index(layout, "power");
        ASSERT_TRUE(power);
        EXPECT_EQ(find_conversion("ENERGY", layout.fields[*power]).quantity, Quantity::watt);
    }
    const auto& old_gps = builtin_definitions("GPS").front();
    expect_conversion("GPS", old_gps.fields[*field_index(old_gps, "alt")], Quantity::metre, 0.01);
    const auto& rotorcraft = builtin_definitions("ROTORCRAFT_FP").front();
    expect_conversion("ROTORCRAFT_FP", rotorcraft.fields[2], Quantity::metre, 1.0 / 256.0);
}

}  // namespace
}  // namespace flightwatt::telemetry

#include "base/units.h"

#include <array>
#include <charconv>

namespace flightwatt::units {
namespace {

struct NamedUnit {
    std::string_view name;
    Unit unit;
};

constexpr std::array named_units{
    NamedUnit{"V", {Quantity::volt, 1.0}},
    NamedUnit{"v", {Quantity::volt, 1.0}},  // as AirData spells it
    NamedUnit{"volt", {Quantity::volt, 1.0}},
    NamedUnit{"mV", {Quantity::volt, 1e-3}},
    NamedUnit{"dV", {Quantity::volt, 0.1}},
    NamedUnit{"decivolt", {Quantity::volt, 0.1}},
    NamedUnit{"cV", {Quantity::volt, 0.01}},
    NamedUnit{"A", {Quantity::ampere, 1.0}},
    NamedUnit{"amp", {Quantity::ampere, 1.0}},
    NamedUnit{"mA", {Quantity::ampere, 1e-3}},
    NamedUnit{"cA", {Quantity::ampere, 0.01}},
    NamedUnit{"W", {Quantity::watt, 1.0}},
    NamedUnit{"mW", {Quantity::watt, 1e-3}},
    NamedUnit{"kW", {Quantity::watt, 1e3}},
    NamedUnit{"Ah", {Quantity::ampere_hour, 1.0}},
    NamedUnit{"mAh", {Quantity::ampere_hour, 1e-3}},
    NamedUnit{"Wh", {Quantity::watt_hour, 1.0}},
    NamedUnit{"mWh", {Quantity::watt_hour, 1e-3}},
    NamedUnit{"J", {Quantity::watt_hour, 1.0 / seconds_per_hour}},
    NamedUnit{"Watt", {Quantity::watt, 1.0}},  // ArduPilot's names, as the next three
    NamedUnit{"A.s", {Quantity::ampere_hour, 1.0 / seconds_per_hour}},
    NamedUnit{"W.h", {Quantity::watt_hour, 1.0}},
    NamedUnit{"W.s", {Quantity::watt_hour, 1.0 / seconds_per_hour}},
    NamedUnit{"m", {Quantity::metre, 1.0}},
    NamedUnit{"meter", {Quantity::metre, 1.0}},
    NamedUnit{"meters", {Quantity::metre, 1.0}},
    NamedUnit{"dm", {Quantity::metre, 0.1}},
    NamedUnit{"cm", {Quantity::metre, 0.01}},
    NamedUnit{"mm", {Quantity::metre, 1e-3}},
    NamedUnit{"ft", {Quantity::metre, metre_per_foot}},
    NamedUnit{"feet", {Quantity::metre, metre_per_foot}},
    NamedUnit{"m/s", {Quantity::metre_per_second, 1.0}},
    NamedUnit{"cm/s", {Quantity::metre_per_second, 0.01}},
    NamedUnit{"mm/s", {Quantity::metre_per_second, 1e-3}},
    NamedUnit{"km/h", {Quantity::metre_per_second, metre_per_kilometre / seconds_per_hour}},
    NamedUnit{"kmh", {Quantity::metre_per_second, metre_per_kilometre / seconds_per_hour}},
    NamedUnit{"mph", {Quantity::metre_per_second, metre_per_mile / seconds_per_hour}},
    NamedUnit{"MPH", {Quantity::metre_per_second, metre_per_mile / seconds_per_hour}},
    NamedUnit{"mi/h", {Quantity::metre_per_second, metre_per_mile / seconds_per_hour}},
    NamedUnit{"kt", {Quantity::metre_per_second, metre_per_nautical_mile / seconds_per_hour}},
    NamedUnit{"kts", {Quantity::metre_per_second, metre_per_nautical_mile / seconds_per_hour}},
    NamedUnit{"ft/s", {Quantity::metre_per_second, metre_per_foot}},
    NamedUnit{"f/s", {Quantity::metre_per_second, metre_per_foot}},  // as EdgeTX spells it
    NamedUnit{"min", {Quantity::second, seconds_per_minute}},
    NamedUnit{"s", {Quantity::second, 1.0}},
    NamedUnit{"sec", {Quantity::second, 1.0}},
    NamedUnit{"ms", {Quantity::second, 1e-3}},
    NamedUnit{"millisecond", {Quantity::second, 1e-3}},
    NamedUnit{"us", {Quantity::second, 1e-6}},
    NamedUnit{"ns", {Quantity::second, 1e-9}},
    NamedUnit{"%", {Quantity::percent, 1.0}},
    NamedUnit{"percent", {Quantity::percent, 1.0}},
    NamedUnit{"pprz", {Quantity::percent, percent_per_whole / pprz_full_scale}},
    NamedUnit{"deg", {Quantity::degree, 1.0}},
    NamedUnit{"degrees", {Quantity::degree, 1.0}},
    NamedUnit{"Degrees", {Quantity::degree, 1.0}},
    NamedUnit{"°", {Quantity::degree, 1.0}},
    NamedUnit{"deglatitude", {Quantity::degree, 1.0}},
    NamedUnit{"deglongitude", {Quantity::degree, 1.0}},
    NamedUnit{"degheading", {Quantity::degree, 1.0}},
    NamedUnit{"decideg", {Quantity::degree, 0.1}},
    NamedUnit{"rad", {Quantity::degree, degree_per_rad}},
    NamedUnit{"celsius", {Quantity::celsius, 1.0}},
    NamedUnit{"degC", {Quantity::celsius, 1.0}},
    NamedUnit{"deg_celsius", {Quantity::celsius, 1.0}},
    NamedUnit{"deg celsius", {Quantity::celsius, 1.0}},
    NamedUnit{"kg", {Quantity::kilogram, 1.0}},
    NamedUnit{"g", {Quantity::kilogram, 1e-3}},
    NamedUnit{"deg celcius", {Quantity::celsius, 1.0}},  // as Paparazzi spells it
};

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
    if (text == "1e7deg") return Unit{Quantity::degree, 1e-7};  // means its inverse
    // A number in front scales the unit behind it: "1e-1V", "0.01A".
    double scale = 1.0;
    const auto number = std::from_chars(text.data(), text.data() + text.size(), scale);
    if (number.ec == std::errc{}) text.remove_prefix(static_cast<std::size_t>(number.ptr - text.data()));
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    for (const auto& [name, unit] : named_units) {
        if (name == text) return Unit{unit.quantity, unit.factor * scale};
    }
    return std::nullopt;
}

}  // namespace flightwatt::units

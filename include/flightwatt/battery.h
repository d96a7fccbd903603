#pragma once

#include "flightwatt/log.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

/// Batteries: an open-circuit voltage over the state of charge, a series resistance and one RC pair.
///
/// identify_pack() finds them from the voltage and current of flights, with 95 % intervals; write_pack() and read_pack()
/// use the file of `flightwatt battery`.
///
///     const auto pack = flightwatt::identify_pack(logs, {.capacity_ah = 5.0});
///     std::printf("%.3f ohm, %.2f V at half charge\n", flightwatt::resistance_ohm(pack),
///                 flightwatt::open_circuit_voltage_v(pack, 50.0));
namespace flightwatt {

namespace battery {
struct Battery;
}

/// A battery. Copies are cheap and share the data, which does not change.
class Pack {
  public:
    explicit Pack(std::shared_ptr<const battery::Battery> battery);

    const battery::Battery& battery() const { return *battery_; }  ///< Returns what the other functions read.

  private:
    std::shared_ptr<const battery::Battery> battery_;
};

/// What is known of a pack before it is identified.
struct PackLabel {
    std::optional<double> capacity_ah = {};  ///< none: estimated from the flights
    std::optional<int> cells = {};           ///< in series; none: by the voltage at rest
};

/// Identifies the pack of logs, whose power must not be excluded. Throws where voltage and current of the flights
/// determine no such circuit.
Pack identify_pack(const std::vector<Log>& logs, const PackLabel& label = {});

Pack read_pack(const std::filesystem::path& file);                     ///< Reads a battery's file.
void write_pack(const Pack& pack, const std::filesystem::path& file);  ///< Writes a battery's file as a whole.

double capacity_ah(const Pack& pack);     ///< Returns the capacity [Ah].
double resistance_ohm(const Pack& pack);  ///< Returns the series resistance [ohm].
/// Returns the 95 % interval [ohm] of the series resistance; none of a pack that was not identified.
std::optional<std::pair<double, double>> resistance_interval_ohm(const Pack& pack);
/// Returns the open-circuit voltage [V] at a state of charge of 0 to 100 %.
double open_circuit_voltage_v(const Pack& pack, double soc_percent);

}  // namespace flightwatt

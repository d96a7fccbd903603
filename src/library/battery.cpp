#include "base/atomic_file.h"
#include "base/error.h"
#include "battery/battery_toml.h"
#include "battery/discharge_record.h"
#include "battery/identification.h"
#include "flight/load_flight.h"

#include <algorithm>
#include <iterator>

#include <flightwatt/battery.h>

namespace flightwatt {

Pack::Pack(std::shared_ptr<const battery::Battery> battery) : battery_(std::move(battery)) {}

Pack identify_pack(const std::vector<Log>& logs, const PackLabel& label) {
    std::vector<battery::DischargeRecord> records;
    for (const auto& log : logs) {
        const auto& loaded = log.loaded();
        if (!loaded.exclusion.empty()) throw InputError({log.name()}, loaded.exclusion);
        const bool has_circuits = loaded.data.circuits.size() > 1;
        auto found = battery::discharge_records(has_circuits ? select_circuit(loaded.data, 1) : loaded.data);
        std::ranges::move(found.records, std::back_inserter(records));
    }
    const auto identified =
        battery::identify_battery(records, {.capacity_ah = label.capacity_ah, .cells = label.cells});
    return Pack(std::make_shared<const battery::Battery>(identified.battery));
}

Pack read_pack(const std::filesystem::path& file) {
    return Pack(std::make_shared<const battery::Battery>(battery::read_battery(file)));
}

void write_pack(const Pack& pack, const std::filesystem::path& file) {
    write_file_atomically(file, to_toml(pack.battery()));
}

double capacity_ah(const Pack& pack) { return pack.battery().capacity_ah; }

double resistance_ohm(const Pack& pack) { return pack.battery().resistance_ohm; }

std::optional<std::pair<double, double>> resistance_interval_ohm(const Pack& pack) {
    const auto& interval = pack.battery().intervals.resistance_ohm;
    if (!interval) return std::nullopt;
    return std::pair(interval->low, interval->high);
}

double open_circuit_voltage_v(const Pack& pack, double soc_percent) {
    return battery::open_circuit_voltage_v(pack.battery(), soc_percent);
}

}  // namespace flightwatt

#include "cli/output/discharge_input.h"

#include "base/error.h"

#include <utility>

#include <fmt/format.h>

namespace flightwatt::cli {

std::vector<battery::DischargeRecord> discharge_records(const StageCall& call, FlightArguments flights,
                                                        std::optional<std::size_t> circuit) {
    flights.load.flight_required =
        false;  // without altitude, power faults are not detected; the battery can be identified
    std::vector<std::pair<std::string, Diagnostic>> refusals;  // by file
    std::optional<InputError> refused;
    const auto read = [&](const std::string& file, const flight::LoadedFlight& loaded) {
        try {
            if (!loaded.exclusion.empty()) throw InputError({file}, loaded.exclusion);
            auto found = battery::discharge_records(loaded.data.circuits.size() > 1 || circuit
                                                        ? select_circuit(loaded.data, circuit.value_or(1))
                                                        : loaded.data);
            for (const auto& text : found.notes)
                add_diagnostic(call, {Severity::warning, "changes of the pack", text, loaded.data.flight});
            return std::move(found.records);
        } catch (const InputError& error) {
            refusals.emplace_back(file,
                                  Diagnostic{Severity::warning, "not used: " + kind_of_reason(error.what()),
                                             fmt::format("it is excluded: {}", error.what()), loaded.series.flight});
            refused.emplace(error);
            return std::vector<battery::DischargeRecord>{};
        }
    };
    auto records = from_flights<battery::DischargeRecord>(call, flights, read);
    if (records.empty() && refusals.size() == 1) throw InputError(*refused);
    for (const auto& [file, refusal] : refusals) leave_out(call, flights, file, refusal);
    if (records.empty() && !refusals.empty()) throw InputError({}, "no flight can be used");
    return records;
}

}  // namespace flightwatt::cli

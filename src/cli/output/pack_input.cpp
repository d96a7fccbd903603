#include "cli/output/pack_input.h"

#include "base/error.h"

#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::cli {

std::vector<answer::PackUse> read_pack_uses(const StageCall& call, FlightArguments flights, const PackArguments& packs,
                                            std::optional<std::size_t> circuit) {
    LogPlaces places;
    std::vector<std::string> files;
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
            files.push_back(file);
            for (const auto& text : found.notes)
                add_diagnostic(call, {Severity::warning, "changes of the pack", text, loaded.data.flight});
            return answer::pack_uses(loaded.data, std::move(found.records), places.folder(file).filename().string());
        } catch (const InputError& error) {
            std::string reason = error.what();
            if (const auto named = loaded.series.flight + ": "; reason.starts_with(named))
                reason.erase(0, named.size());
            refusals.emplace_back(file, Diagnostic{Severity::warning, "not used: " + kind_of_reason(reason),
                                                   fmt::format("it is not used: {}", reason), loaded.series.flight});
            refused.emplace(error);
            return std::vector<answer::PackUse>{};
        }
    };
    auto uses = from_flights<answer::PackUse>(call, flights, read);
    if (uses.empty() && refusals.size() == 1) throw InputError(*refused);
    for (const auto& [file, refusal] : refusals) leave_out(call, flights, file, refusal);
    if (uses.empty() && !refusals.empty()) throw InputError({}, "no flight can be used");
    name_packs(call, packs, files, uses);
    return uses;
}

std::vector<battery::DischargeRecord> records_of(const StageCall& call, const std::vector<answer::PackUse>& uses) {
    std::set<std::string> packs;
    std::vector<battery::DischargeRecord> records;
    for (const auto& use : uses) {
        packs.insert(use.pack.empty() ? "unnamed" : use.pack);
        records.push_back(use.record);
    }
    if (packs.size() > 1)
        warn(call, fmt::format("one battery is identified from flights of {} packs: {}; --pack chooses one",
                               packs.size(), fmt::join(packs, ", ")));
    return records;
}

}  // namespace flightwatt::cli

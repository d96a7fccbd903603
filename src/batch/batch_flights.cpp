#include "batch/batch_flights.h"

#include "base/error.h"
#include "batch/spool_file.h"

#include <limits>
#include <sstream>

#include <cereal/archives/binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>

// What cereal looks for, to write a struct and to read it: its fields.
namespace flightwatt {
namespace mechanical {

template <typename Archive>
void serialize(Archive& archive, Exclusion& exclusion) {
    archive(exclusion.flight, exclusion.phase, exclusion.reason);
}

}  // namespace mechanical

namespace batch {

template <typename Archive>
void serialize(Archive& archive, RecordedPhase& phase) {
    auto& statistics = phase.statistics;
    archive(phase.sortie, phase.phase, phase.start_s, phase.end_s, phase.start_gap_s, phase.end_gap_s, phase.complete,
            statistics.samples, statistics.mean_power_w, statistics.energy_wh, statistics.counter_energy_wh,
            statistics.gaps, statistics.max_gap_s);
}

template <typename Archive>
void serialize(Archive& archive, FlightRecord& record) {
    archive(record.flight, record.log, record.fingerprint, record.results, record.accepted, record.error,
            record.is_of_other_aircraft, record.aircraft_id, record.aircraft_name, record.power_source,
            record.current_origin, record.phases, record.warnings, record.power_faults, record.no_power_reason,
            record.not_fitted_reason, record.content.has_definitions, record.content.samples);
}

template <typename Archive>
void serialize(Archive& archive, SelectedSortie& sortie) {
    archive(sortie.flight, sortie.phases.values);
}

template <typename Archive>
void serialize(Archive& archive, BatchFlight& flight) {
    archive(flight.record, flight.was_up_to_date, flight.is_of_this_run, flight.log_is_missing,
            flight.selection.flights, flight.selection.exclusions, flight.selection.same_as);
}

namespace {

constexpr auto nowhere = std::numeric_limits<std::uint64_t>::max();

}  // namespace

BatchFlights::BatchFlights(std::size_t count, const std::filesystem::path& folder)
    : file_(std::make_unique<SpoolFile>(folder)), offsets_(count, nowhere) {}

BatchFlights::BatchFlights(std::span<const BatchFlight> flights, const std::filesystem::path& folder)
    : BatchFlights(flights.size(), folder) {
    for (std::size_t i = 0; i < flights.size(); ++i) put(i, flights[i]);
}

BatchFlights::~BatchFlights() = default;
BatchFlights::BatchFlights(BatchFlights&&) noexcept = default;
BatchFlights& BatchFlights::operator=(BatchFlights&&) noexcept = default;

void BatchFlights::put(std::size_t number, const BatchFlight& flight) {
    std::ostringstream text;
    cereal::BinaryOutputArchive archive(text);
    archive(flight);
    offsets_.at(number) = file_->add(std::move(text).str());
}

BatchFlight BatchFlights::operator[](std::size_t number) const {
    if (offsets_.at(number) == nowhere) throw OutputError("a log of the batch was not done");
    std::istringstream text(file_->read(offsets_[number]));
    cereal::BinaryInputArchive archive(text);
    BatchFlight flight;
    archive(flight);
    return flight;
}

}  // namespace batch
}  // namespace flightwatt

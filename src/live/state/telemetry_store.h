#pragma once

#include "flight/flight_series.h"
#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flightwatt::live {

/// Received messages as columns in bounded memory, the same as of a log with these messages.
class TelemetryStore {
  public:
    static constexpr std::size_t max_senders = 8;   ///< with stored rows
    static constexpr std::size_t max_devices = 64;  ///< of one message

    /// Without `motion`: no bank angles, which are most frequent, and no positions, which take most time to convert.
    TelemetryStore(std::string flight, std::optional<telemetry::LogConfiguration> configuration, bool motion = true);

    /// A message without its time: "20 ENERGY 57 11.62 1.64", or "20 ENERGY" with `values` of its fields.
    void add(double time_s, std::string_view message, std::span<const double> values = {});
    void clear();
    void drop_before(double time_s);
    void drop(const std::string& sender);
    /// Drops all other senders, also in future.
    void keep_only(const std::string& sender);
    /// Retains every second row of the largest table, of each device; and from now on every second one received.
    void thin();

    /// Number of rows of all senders.
    std::size_t rows() const;
    /// The sender of most rows; empty without rows.
    std::string busiest_sender() const;
    flight::FlightSeries series(const std::string& sender) const;
    /// Unusable messages and values, by reason.
    std::map<std::string, std::size_t> skipped() const;
    /// Received rows for each retained one, of the thinned messages.
    std::map<std::string, std::size_t> thinned() const;

  private:
    struct Thinning {
        std::size_t stride = 1;
        std::map<std::vector<double>, std::size_t> rows_of;  ///< by device
    };
    using TableName = std::pair<std::string, std::string>;  ///< sender, message

    void append(const std::string& sender, const telemetry::MessageTable& row);

    telemetry::TelemetryLog log_;
    std::optional<std::string> only_;
    telemetry::MessageDecoder decoder_;
    std::map<TableName, Thinning> thinning_;
    std::map<std::string, std::size_t> beyond_limits_;  ///< by reason
};

}  // namespace flightwatt::live

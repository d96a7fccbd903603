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

/// What is not always wanted of telemetry.
struct TelemetryFilter {
    bool bank = true;    ///< the bank angle, which comes most often
    bool places = true;  ///< positions, which cost most to make
};

/// The messages on energy that were received, as columns, in bounded memory: what it keeps is dropped from its
/// beginning, or thinned evenly. Its columns are those of a log with the same messages.
class TelemetryStore {
  public:
    static constexpr std::size_t max_senders = 8;   ///< aircraft of which rows are kept
    static constexpr std::size_t max_devices = 64;  ///< of one message

    TelemetryStore(std::string flight, std::optional<telemetry::LogConfiguration> configuration,
                   TelemetryFilter wanted = {});

    /// A message without its time: "20 ENERGY 57 11.62 1.64", or "20 ENERGY" with `values` of its fields.
    void add(double time_s, std::string_view message, std::span<const double> values = {});
    void clear();
    void drop_before(double time_s);
    /// What was received of one sender.
    void drop(const std::string& sender);
    void keep_only(const std::string& sender);
    /// Keeps every second row of the message that has most, and of what comes of it: of each device.
    void thin();

    /// The rows that are kept, of all senders.
    std::size_t rows() const;
    std::vector<std::string> senders() const;
    flight::FlightSeries series(const std::string& sender) const;
    /// Messages and values that could not be used, by reason.
    std::map<std::string, std::size_t> skipped() const;
    /// Of every how many rows one is kept, of the messages that were thinned.
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
    std::map<std::string, std::size_t> not_kept_;  ///< by reason
};

}  // namespace flightwatt::live

#pragma once

#include "flight/flight_series.h"
#include "live/sources.h"
#include "telemetry/message_decoder.h"
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

/// Stores received messages as columns in bounded memory, the same columns as of a log with these messages.
class TelemetryStore {
  public:
    static constexpr std::size_t max_senders = 8;   ///< senders with stored rows
    static constexpr std::size_t max_devices = 64;  ///< devices of one message

    /// Stores a flight by the definitions of its .log, else by the built-in ones; or by messages of MAVLink, whose values
    /// are those of flight::mavlink_flight_messages(). Without `motion` there are no bank angles, which are most
    /// frequent, and no positions, which take most time to convert.
    TelemetryStore(std::string flight, std::optional<telemetry::LogConfiguration> configuration, bool motion = true,
                   bool is_mavlink = false);

    /// Adds a message without its time: "20 ENERGY 57 11.62 1.64", or "20 ENERGY" with `values` of its fields. The
    /// `packet` of MAVLink's PARAM_VALUE has its parameter.
    void add(double time_s, std::string_view message, std::span<const double> values = {},
             std::string_view packet = {});
    void clear();
    void drop_before(double time_s);
    void drop(const std::string& sender);
    /// Drops the rows of all other senders, also of later messages.
    void keep_only(const std::string& sender);
    /// Keeps every second row of each device in the largest table, and from now on every second one received.
    void thin();

    /// Returns the number of rows of all senders.
    std::size_t rows() const;
    /// Returns the senders with rows, that of most rows first.
    std::vector<std::string> senders() const;
    /// Returns the series of a sender.
    flight::FlightSeries series(const std::string& sender) const;
    /// Returns the numbers of unusable messages and values, by reason.
    std::map<std::string, std::size_t> skipped() const;
    /// Returns the number of received rows for each kept one, by name of the thinned messages.
    std::map<std::string, std::size_t> thinned() const;

  private:
    struct Thinning {
        std::size_t stride = 1;
        std::map<std::vector<double>, std::size_t> rows_of;  ///< by device
    };
    using TableName = std::pair<std::string, std::string>;  ///< sender, message

    void append(const std::string& sender, const telemetry::MessageTable& row);
    void add_mavlink(double time_s, const std::string& sender, std::string_view message,
                     std::span<const double> values);
    void add_parameter(const std::string& sender, std::string_view packet);

    telemetry::TelemetryLog log_;
    std::vector<telemetry::MessageRequest> mavlink_;                   ///< the messages, if they are MAVLink's
    std::map<std::string, std::map<std::string, double>> parameters_;  ///< of ArduPilot's battery monitors, by sender
    bool motion_;
    std::optional<std::string> only_;
    telemetry::MessageDecoder decoder_;
    std::map<TableName, Thinning> thinning_;
    std::map<std::string, std::size_t> beyond_limits_;  ///< by reason
};

/// Accepts, corrects or holds the times of the messages of one sender, so that an error in one does not affect the
/// others:
/// - within 10 s of the latest: accepted;
/// - otherwise held until five lines agree; then
///   - forwards: a gap, of any duration, as a link may be lost for as long;
///   - backwards by a minute or more: a restart;
///   - backwards by less: a clock that was set back, which is corrected, so that time continues.
class ClockFilter {
  public:
    static constexpr double max_step_s = 60.0;
    static constexpr double max_off_s = 10.0;
    static constexpr std::size_t min_confirmations = 5;
    static constexpr double late_s = 2.0;

    /// Takes a message with a time and appends the accepted ones. Returns whether they are the first after a restart.
    bool push(IncomingMessage message, std::vector<IncomingMessage>& accepted);
    bool is_late(double time_s) const { return started_ && time_s + offset_s_ < latest_s_ - late_s; }
    /// Ends the telemetry: accepts held messages that are later than the latest.
    void flush(std::vector<IncomingMessage>& accepted);

    std::size_t unconfirmed() const { return unconfirmed_; }
    std::size_t steps_back() const { return steps_back_; }
    double latest_s() const { return latest_s_; }

  private:
    bool hold(IncomingMessage message, std::vector<IncomingMessage>& accepted);

    bool started_ = false;
    double latest_s_ = 0.0;
    double offset_s_ = 0.0;
    std::vector<IncomingMessage> held_;
    std::size_t unconfirmed_ = 0;
    std::size_t steps_back_ = 0;
};

}  // namespace flightwatt::live

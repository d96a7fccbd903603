#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

/// Reading flight logs.
///
/// read_log() reads a telemetry log of Paparazzi (.data with its .log), ArduPilot (.bin, .log) or PX4 (.ulg), compressed
/// or not, or a CSV, and chooses for each quantity the track that is used: the same choice, with the same notes, as the
/// programs make (docs/methods.md).
///
///     for (const auto& log : flightwatt::read_log("flight.ulg")) {
///         const auto power = log.track("power_w");
///         std::printf("%s: %zu samples of power from %s\n", log.name().c_str(), power.value.size(), power.source.c_str());
///     }
///
/// Errors: every function of these headers that can fail throws a std::runtime_error, whose what() is what the programs
/// print: file, position, what was found and what to do.
namespace flightwatt {

namespace flight {
struct LoadedFlight;
}

/// A quantity over the time of a log. `time_s` and `value` have one length; times are the log's own seconds and rise.
struct Track {
    std::string name;    ///< the quantity with its unit: "power_w", "altitude_m", "voltage_v"
    std::string source;  ///< messages and fields that it is made of: "ENERGY.voltage * ENERGY.current"; empty: none
    std::vector<double> time_s;
    std::vector<double> value;
};

/// One recording of one aircraft. Copies are cheap and share the data, which does not change.
class Log {
  public:
    explicit Log(std::shared_ptr<const flight::LoadedFlight> loaded);

    /// Returns the name of the file without its ending, with "#2" ... for further recordings of one file.
    std::string name() const;
    /// Returns the name that the aircraft has in the log, or its kind: "Opterra", "ArduCopter".
    std::string aircraft() const;
    /// Returns the names of the tracks that the log has.
    std::vector<std::string> track_names() const;
    /// Returns a track by its name, without samples if the log has none. Throws for a name that is no quantity.
    Track track(std::string_view name) const;
    /// Returns what was found about the log and the choice of its tracks, a sentence each, without what can be ignored.
    std::vector<std::string> warnings() const;
    /// Returns why its power is not to be used, as by the programs; empty if it is.
    std::string exclusion() const;

    const flight::LoadedFlight& loaded() const {
        return *loaded_;
    }  ///< Returns what the other headers' functions read.

  private:
    std::shared_ptr<const flight::LoadedFlight> loaded_;
};

/// Reads the recordings of a log with an aircraft that flew. Throws if the file cannot be read, is no log, or has
/// neither measured power nor altitude.
std::vector<Log> read_log(const std::filesystem::path& file);

/// Reads several logs, as read_log() does.
std::vector<Log> read_logs(const std::vector<std::filesystem::path>& files);

}  // namespace flightwatt

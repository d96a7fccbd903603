#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// Results of profiling.
namespace flightwatt::compute {

/// Samples of power with time stamps of their own, rising.
struct PowerTrace {
    std::vector<double> time_s;
    std::vector<double> power_w;

    void add(double at_s, double sample_w) {
        time_s.push_back(at_s);
        power_w.push_back(sample_w);
    }
};

/// The intervals between the samples of a run.
struct SamplingJitter {
    double mean_s = 0.0;
    double sd_s = 0.0;
    double max_s = 0.0;
};

/// Power over a run, or over the repeats of a configuration.
struct PowerEstimate {
    double power_w = 0.0;
    double standard_error_w = 0.0;  ///< NaN where it is not known
    double duration_s = 0.0;
    double energy_j = 0.0;  ///< power_w * duration_s
    std::size_t samples = 0;
    std::size_t repeats = 0;
};

/// Result of a run. Only `ok` has power.
enum class RunStatus { failed, ended_early, timed_out, not_started, no_samples, ok };

std::string_view to_string(RunStatus status);

/// A signal ended the program; the processes of the run have ended.
struct Interrupted : std::runtime_error {
    explicit Interrupted(int by) : std::runtime_error("interrupted by a signal"), signal(by) {}
    int signal;
};

inline constexpr const char* runs_name = "runs.csv";
inline constexpr const char* idle_component = "idle";

/// One run of one configuration, planned or done.
struct ProfileRun {
    std::string component;             ///< or idle_component
    std::size_t index = 0;             ///< of the component in its specification
    std::size_t node = 0;              ///< of its configurations
    std::string configuration;         ///< "fps=4 key_bits=32"
    std::size_t repeat = 1;            ///< from 1
    std::string fingerprint;           ///< of all settings that its result depends on
    std::string layer1;                ///< its file, relative to the results
    bool is_done = false;              ///< running sets the members from here on
    bool is_from_earlier_run = false;  ///< an earlier call ran it
    RunStatus status = RunStatus::failed;
    std::string note;
    PowerTrace trace;
    PowerEstimate estimate;  ///< of status ok
};

/// A configuration and its power.
struct NodeEstimate {
    std::vector<double> qos;
    PowerEstimate total;
};

/// The power of a component over its configurations: layer 2.
struct ComponentEstimate {
    std::string name;
    std::vector<std::string> parameters;
    std::vector<NodeEstimate> nodes;   ///< without those that failed
    std::vector<ProfileRun> failures;  ///< runs without power
};

struct ProfileOutcome {
    std::string sampler;  ///< kind and source
    std::optional<PowerEstimate> idle;
    std::vector<ComponentEstimate> components;
    std::vector<ProfileRun> runs;
    SamplingJitter jitter;
};

}  // namespace flightwatt::compute

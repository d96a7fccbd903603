#pragma once

#include <memory>
#include <optional>
#include <string>

/// The live predictor as the ROS node uses it. C++17: the headers of ROS 1 are no C++20.
namespace flightwatt::ros {

/// The node's parameters; an empty name: none.
struct Settings {
    std::string mission_file;
    std::string model_file;
    std::string battery_file;
    std::optional<double> remaining_s;
    std::optional<double> initial_soc_percent;
    bool decides = false;
};

/// What sensor_msgs/BatteryState says; NaN: not known. Of several batteries currents and charges add up.
struct BatteryReading {
    double voltage_v = 0.0;
    double current_a = 0.0;     ///< negative: out of the battery
    double charge_ah = 0.0;     ///< left in it
    std::string location = {};  ///< which one it is: MAVROS states "id0", "id1"
};

/// What geometry_msgs/PoseStamped says: height, and the attitude of x forward, y left, z up (REP 103).
struct PoseReading {
    double altitude_m = 0.0;
    double x = 0.0, y = 0.0, z = 0.0, w = 0.0;  ///< quaternion; all zero: not known
};

/// What is published: a JSON object each (docs/formats.md, "ROS node").
struct NodeTexts {
    std::string prediction;
    std::string decision;  ///< empty: none
};

/// Times are those of ROS [s]. One thread at a time.
class NodePredictor {
  public:
    virtual ~NodePredictor() = default;
    /// False where there was no room, which is counted.
    virtual bool push(double time_s, const BatteryReading& battery) = 0;
    virtual bool push(double time_s, const PoseReading& pose) = 0;
    /// None before the first message.
    virtual std::optional<NodeTexts> look(double now_s) = 0;
};

struct MadeNodePredictor {
    std::unique_ptr<NodePredictor> predictor;
    std::string error;  ///< where there is none
};

MadeNodePredictor make_node_predictor(const Settings& settings);

}  // namespace flightwatt::ros

// The live predictor as a ROS node (docs/live.md, "As a ROS node"): battery and pose in, prediction and decision out.

#include "node_predictor.h"

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/BatteryState.h>
#include <std_msgs/String.h>

namespace {

using flightwatt::ros::NodePredictor;

flightwatt::ros::Settings settings_of(const ros::NodeHandle& own) {
    flightwatt::ros::Settings settings;
    own.getParam("mission", settings.mission_file);
    own.getParam("model", settings.model_file);
    own.getParam("battery", settings.battery_file);
    own.getParam("decide", settings.decides);
    const auto number = [&own](const char* name) {
        double value = 0.0;
        return own.getParam(name, value) ? std::optional<double>(value) : std::nullopt;
    };
    settings.remaining_s = number("remaining_s");
    settings.initial_soc_percent = number("initial_soc_percent");
    return settings;
}

class Node {
  public:
    explicit Node(NodePredictor& predictor) : predictor_(predictor) {
        constexpr std::uint32_t max_waiting = 1000;
        ros::NodeHandle shared;
        ros::NodeHandle own("~");
        prediction_ = own.advertise<std_msgs::String>("prediction", max_waiting);
        decision_ = own.advertise<std_msgs::String>("decision", max_waiting);
        battery_ = shared.subscribe("battery", max_waiting, &Node::on_battery, this);
        pose_ = shared.subscribe("pose", max_waiting, &Node::on_pose, this);
        timer_ = shared.createTimer(ros::Duration(1.0), &Node::look, this);
    }

  private:
    void on_battery(const sensor_msgs::BatteryState& battery) {
        push(battery.header,
             flightwatt::ros::BatteryReading{battery.voltage, battery.current, battery.charge, battery.location});
    }

    void on_pose(const geometry_msgs::PoseStamped& pose) {
        const auto& turned = pose.pose.orientation;
        push(pose.header, flightwatt::ros::PoseReading{pose.pose.position.z, turned.x, turned.y, turned.z, turned.w});
    }

    /// Messages without a stamp count from when they came.
    template <typename Reading>
    void push(const std_msgs::Header& header, const Reading& reading) {
        const auto time = header.stamp.isZero() ? ros::Time::now() : header.stamp;
        if (!predictor_.push(time.toSec(), reading)) ROS_WARN("too much between two looks: a message is dropped");
    }

    void look(const ros::TimerEvent& /*event*/) {
        const auto texts = predictor_.look(ros::Time::now().toSec());
        if (!texts) return;
        std_msgs::String text;
        text.data = texts->prediction;
        prediction_.publish(text);
        if (texts->decision.empty()) return;
        text.data = texts->decision;
        decision_.publish(text);
    }

    NodePredictor& predictor_;
    ros::Publisher prediction_;
    ros::Publisher decision_;
    ros::Subscriber battery_;
    ros::Subscriber pose_;
    ros::Timer timer_;
};

}  // namespace

int main(int argc, char** argv) {
    ros::init(argc, argv, "flightwatt");
    const auto made = flightwatt::ros::make_node_predictor(settings_of(ros::NodeHandle("~")));
    if (!made.predictor) {
        constexpr int rejected = 3;
        std::fprintf(stderr,
                     "flightwatt_ros: error: %s (parameters: mission, or model and remaining_s; docs/live.md)\n",
                     made.error.c_str());
        return rejected;
    }
    const Node node(*made.predictor);
    ros::spin();
    return 0;
}

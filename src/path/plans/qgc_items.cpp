#include "path/plans/qgc_items.h"

#include "base/toml_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::path {
namespace {

/// Reads the objects of a .plan. Its own checks throw InputError; a key that is missing, or of another type, is the
/// exception of the library.
class QgcReader {
  public:
    QgcReader(const std::string& file, bool is_rotorcraft) : is_rotorcraft_(is_rotorcraft) { mission_.where = {file}; }

    MissionItems read(const Json& plan) {
        if (plan.is_object() && !plan.contains("fileType") && plan.contains("type"))
            refuse("is GeoJSON, not a plan", "flightwatt new-mission --plan FILE makes a mission of it");
        if (!plan.is_object() || plan.value("fileType", Json()) != "Plan")
            refuse("has no \"fileType\": \"Plan\"", "expected a plan of QGroundControl");
        require_version(plan, 1, 1, "the plan");
        if (!plan.contains("mission")) refuse("has no mission", "add items in QGroundControl");
        const auto& mission = plan["mission"];
        name_ = "the mission";
        try {
            require_version(mission, 2, 2, name_);
            copy_numbers(mission, "plannedHomePosition", mission_.home);
            read_speed(mission);
            constexpr int px4 = 12, ardupilot = 3;  // MAV_AUTOPILOT
            mission_.is_of_px4 = mission.value("firmwareType", Json()) == px4;
            mission_.is_of_ardupilot = mission.value("firmwareType", Json()) == ardupilot;
            const auto rally = plan.value("rallyPoints", Json::object());
            mission_.has_rally_points = rally.is_object() && !rally.value("points", Json::array()).empty();
            read_items(mission.at("items"), "item", false);
            number_items();
        } catch (const Json::exception& error) {  // "[json.exception.type_error.302] type must be array"
            const std::string text = error.what();
            refuse(fmt::format("{}: {}", name_, text.substr(text.find(']') + 2)));
        }
        return std::move(mission_);
    }

  private:
    [[noreturn]] void refuse(const std::string& message, const std::string& hint = "save the plan again") const {
        throw InputError(mission_.where, message, hint);
    }

    void require_version(const Json& object, int min, int max, const std::string& name) const {
        const auto version = object.value("version", Json());
        if (version.is_number_integer() && version >= min && version <= max) return;
        refuse(fmt::format("{} has version {}", name, version.dump()),
               min == max ? fmt::format("expected version {}", max) : fmt::format("expected at most {}", max));
    }

    /// null is NaN.
    template <std::size_t N>
    void copy_numbers(const Json& object, const char* key, std::array<double, N>& to) const {
        const auto& values = object.at(key);
        if (!values.is_array() || values.size() != N)
            refuse(fmt::format("{} has {} {}", name_, values.size(), key), fmt::format("expected {}", N));
        std::ranges::transform(values, to.begin(),
                               [](const Json& value) { return value.is_null() ? std::nan("") : value.get<double>(); });
    }

    /// Reads hoverSpeed for multirotors, by vehicleType, and otherwise cruiseSpeed; 0 states none.
    void read_speed(const Json& mission) {
        constexpr std::array multirotors{2, 3, 4, 13, 14, 15, 29, 35, 43};  // MAV_TYPE, with helicopters
        constexpr double default_hover_m_per_s = 5.0, default_cruise_m_per_s = 15.0;
        const auto type = mission.value("vehicleType", Json());
        const bool is_known = type.is_number_integer() && type != 0;
        const bool hovers = is_known ? std::ranges::count(multirotors, type.get<int>()) > 0 : is_rotorcraft_;
        constexpr int fixed_wing = 1, first_vtol = 19, last_vtol = 25;  // MAV_TYPE
        mission_.is_of_vtol = is_known && type >= first_vtol && type <= last_vtol;
        if (is_known && (hovers || type == fixed_wing)) mission_.is_of_multirotor = hovers;
        mission_.is_of_another_vehicle = is_known && !mission_.is_of_multirotor && !mission_.is_of_vtol;
        const auto* key = hovers ? "hoverSpeed" : "cruiseSpeed";
        const auto speed = mission.value(key, Json());
        if (!speed.is_number() || speed == 0.0) return;
        PlannedSpeed planned{speed.get<double>(), fmt::format("the plan's {}", key)};
        require_in(more_than_up_to(0.0, max_m_per_s), planned.m_per_s, key, mission_.where);
        planned.is_default = planned.m_per_s == (hovers ? default_hover_m_per_s : default_cruise_m_per_s);
        if (!is_known) planned.source += hovers ? " (no vehicleType: as a rotorcraft)" : " (no vehicleType: as a wing)";
        if (planned.is_default) planned.source += ", QGroundControl's default";
        mission_.speed = std::move(planned);
    }

    void read_items(const Json& items, const std::string& name, bool is_inner) {
        if (!items.is_array()) refuse(fmt::format("{} has no items", name_));
        std::size_t number = 0;
        for (const auto& json : items) {
            name_ = fmt::format("{} {}", name, ++number);
            const auto type = json.at("type").get<std::string>();
            if (type == "ComplexItem" && !is_inner)
                read_complex(json);
            else if (type == "SimpleItem")
                read_simple(json);
            else
                refuse(fmt::format("{} has type {}", name_, type), "expected SimpleItem");
        }
    }

    void read_simple(const Json& json) {
        MissionItem item{0, 0, {}, name_, mission_.where};
        const auto integer = [&](const char* key) {
            constexpr double max_command = 65535.0;
            const auto& value = json.at(key);
            if (!value.is_number_integer() || std::abs(value.get<double>()) > max_command)
                refuse(fmt::format("{} has no {} that is a whole number", name_, key));
            return value.get<int>();
        };
        item.command = integer("command");
        item.frame = integer("frame");
        copy_numbers(json, "params", item.parameters);
        constexpr int above_terrain = 3;  // QGroundControl's mode: null above the sea until it has the terrain's height
        const auto altitude = json.value("Altitude", Json());
        if (std::isnan(item.parameters[6]) && json.value("AltitudeMode", Json()) == above_terrain &&
            altitude.is_number())
            std::tie(item.frame, item.parameters[6]) = std::pair(10, altitude.get<double>());
        if (const auto id = json.value("doJumpId", Json()); id.is_number()) item.number = id.get<double>();
        mission_.items.push_back(std::move(item));
    }

    /// By their doJumpId, or from 1 on where none has one or two have the same.
    void number_items() {
        auto& items = mission_.items;
        std::set<double> numbers;
        bool are_different = true;
        for (const auto& item : items)
            if (item.number >= 0.0) are_different = numbers.insert(item.number).second && are_different;
        if (are_different && !numbers.empty()) return;
        for (std::size_t i = 0; i < items.size(); ++i) items[i].number = static_cast<double>(i + 1);
    }

    /// Surveys and corridors carry the items that they consist of, landing patterns two places.
    void read_complex(const Json& json) {
        name_ += fmt::format(" ({})", json.at("complexItemType").get<std::string>());
        require_version(json, 1, 5, name_);  // of QGroundControl 4
        if (json.contains("TransectStyleComplexItem"))
            read_items(json["TransectStyleComplexItem"].at("Items"), name_ + ", item", true);
        else if (json.contains("landCoordinate") && json.contains("landingApproachCoordinate"))
            read_landing(json);
        else
            mission_.items.push_back({0, 0, {}, name_, mission_.where});
    }

    /// The circles in which it descends, then the place where it lands.
    void read_landing(const Json& json) {
        const int frame = json.value("altitudesAreRelative", true) ? 3 : 0;
        const int approach = json.value("useLoiterToAlt", true) ? nav_loiter_to_altitude : nav_waypoint;
        for (const auto& [key, command] :
             {std::pair{"landingApproachCoordinate", approach}, std::pair{"landCoordinate", int{nav_land}}}) {
            std::array<double, 3> place{};
            copy_numbers(json, key, place);
            mission_.items.push_back(
                {command, frame, {0.0, 0.0, 0.0, 0.0, place[0], place[1], place[2]}, name_, mission_.where});
        }
    }

    bool is_rotorcraft_;
    MissionItems mission_;
    std::string name_;  ///< of the object that is read
};

}  // namespace

MissionItems read_qgc_items(const Json& plan, const std::string& file, bool is_rotorcraft) {
    return QgcReader(file, is_rotorcraft).read(plan);
}

}  // namespace flightwatt::path

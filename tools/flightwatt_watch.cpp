// flightwatt watch: the energy of a flight that is in the air, once a second.

#include "base/atomic_file.h"
#include "base/number.h"
#include "base/signal_watch.h"
#include "base/temporary_folder.h"
#include "battery/battery_toml.h"
#include "cli/output/live_options.h"
#include "cli/output/watch_output.h"
#include "cli/stage.h"
#include "live/announcer.h"
#include "live/link_mission.h"
#include "live/live_schedule.h"
#include "live/live_state.h"
#include "live/page_server.h"
#include "live/playback.h"
#include "live/recorder.h"
#include "report/page.h"
#include "stages.h"
#include "telemetry/log_configuration.h"

#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

namespace {

using namespace flightwatt;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct WatchArguments {
    cli::SourceArguments source;
    cli::BasisArguments basis;
    live::LiveOptions live;
    bool replans = false;
    std::optional<std::string> record;
    std::optional<std::string> serve;
    bool announces = false;
    bool requests_mission = false;
    std::string announce_as = "245:191";
    std::optional<std::string> announce_to;
    bool until_landed = false;
};

/// Parses "SYSTEM:COMPONENT", each 1 to 255.
std::pair<std::uint8_t, std::uint8_t> parse_identity(std::string_view text) {
    constexpr std::uint64_t max_id = 255;
    const auto colon = text.find(':');
    const auto system = parse_unsigned(text.substr(0, colon));
    const auto component = colon == std::string_view::npos ? std::nullopt : parse_unsigned(text.substr(colon + 1));
    const auto is_id = [](const auto& id) { return id && *id >= 1 && *id <= max_id; };
    if (!is_id(system) || !is_id(component))
        throw UsageError(fmt::format("--announce-as {}: expected SYSTEM:COMPONENT, each 1 to 255", text));
    return {static_cast<std::uint8_t>(*system), static_cast<std::uint8_t>(*component)};
}

/// Sends the prediction to ground stations, over the link or to an address of its own.
class Announcement {
  public:
    Announcement(const WatchArguments& arguments, live::MessageSource& source) : source_(source) {
        if (!arguments.announces) return;
        const auto [system, component] = parse_identity(arguments.announce_as);
        announcer_.emplace(system, component);
        if (arguments.announce_to) target_ = live::open_mavlink_target(*arguments.announce_to);
    }

    void print_state(const live::LiveState& state) {
        if (!announcer_) return;
        for (const auto& packet : announcer_->packets(state, seconds_since(start_))) {
            if (!target_) {
                source_.send(packet);
                continue;
            }
            live::IncomingMessage message;
            message.packet = packet;
            target_(message);
        }
    }

  private:
    live::MessageSource& source_;
    std::optional<live::Announcer> announcer_;
    live::PlaybackTarget target_;  ///< none: back over the link
    Clock::time_point start_ = Clock::now();
};

/// The missions of the vehicles as their link has them: the prediction's is that of the followed aircraft, once it is
/// whole and where no option states it.
class MissionFromLink {
  public:
    /// `waiting`: the input of predictions until the mission is known.
    MissionFromLink(const cli::StageCall& call, const WatchArguments& arguments, live::MessageSource& source,
                    const std::optional<live::PredictionInput>& waiting)
        : call_(call), arguments_(arguments), source_(source) {
        const auto& basis = arguments.basis;
        const bool is_stated = basis.mission || basis.plan || basis.remaining_s;
        if (arguments.requests_mission && (is_stated || !basis.model || !basis.battery))
            throw UsageError(
                "--request-mission asks the aircraft for what is flown: expected --model and --battery, "
                "and none of --mission, --plan and --remaining");
        if (!arguments.source.mavlink || is_stated || !basis.model || !basis.battery) return;
        identity_ = parse_identity(arguments.announce_as);
        waiting_ = waiting;
    }

    void receive(const live::IncomingMessage& message) {
        if (!waiting_) return;
        const auto sender = message.text.substr(0, message.text.find(' '));
        auto& mission = missions_.try_emplace(sender, identity_.first, identity_.second).first->second;
        if (mission.receive(message)) unread_.insert(sender);
    }

    /// Returns the warning that the prediction is of a former mission; empty: it is not.
    std::string outdated_warning() const {
        const auto mission = missions_.find(aircraft_);
        if (mission == missions_.end() || !mission->second.is_outdated()) return {};
        return fmt::format(
            "another mission was uploaded to aircraft {}, or it was cleared: the prediction is of the former "
            "one until a new one is read{}",
            aircraft_, arguments_.requests_mission ? "" : ", by a ground station; --request-mission asks for it");
    }

    /// Returns the input of predictions of this aircraft, where it changes: by its mission, if that is new.
    std::optional<live::PredictionInput> take(const std::string& aircraft) {
        std::optional<live::PredictionInput> input;
        if (aircraft != aircraft_ && is_read_) {
            unread_.insert(aircraft_);
            is_read_ = false;
            input = waiting_;
        }
        aircraft_ = aircraft;
        return unread_.erase(aircraft) == 0 ? input : read_mission();
    }

    void request() {
        const auto mission = missions_.find(aircraft_);
        if (mission == missions_.end() || !arguments_.requests_mission) return;
        for (const auto& packet : mission->second.requests(seconds_since(start_))) source_.send(packet);
    }

  private:
    /// In a file of its own, as the one before is an input. No mission may end the watch.
    live::PredictionInput read_mission() {
        is_read_ = true;
        try {
            const auto file = folder_.path() / fmt::format("mission-{}.waypoints", ++count_);
            write_file_atomically(file, missions_.at(aircraft_).waypoints());
            auto basis = arguments_.basis;
            basis.plan = file;
            auto input = cli::read_basis(call_, basis, nullptr);
            cli::note(call_, fmt::format("the mission of aircraft {} is known: its way is predicted", aircraft_));
            if (!missions_.at(aircraft_).has_home())
                cli::warn(call_, fmt::format("the home of aircraft {} is unknown: the ways from and to it are not "
                                             "predicted; --plan states it",
                                             aircraft_));
            return input;
        } catch (const std::exception& error) {
            cli::warn(call_, fmt::format("the mission of aircraft {} is not used: {}", aircraft_, error.what()));
            auto input = *waiting_;
            input.no_prediction_reason = fmt::format("a mission of the aircraft that can be flown: {}", error.what());
            return input;
        }
    }

    const cli::StageCall& call_;
    const WatchArguments& arguments_;
    live::MessageSource& source_;
    std::optional<live::PredictionInput> waiting_;  ///< none: missions are not used
    std::pair<std::uint8_t, std::uint8_t> identity_;
    std::map<std::string, live::LinkMission, std::less<>> missions_;  ///< of the vehicles
    std::set<std::string> unread_;                                    ///< vehicles with a new mission
    std::string aircraft_;                                            ///< the followed one; empty: none yet
    bool is_read_ = false;                                            ///< its mission
    int count_ = 0;                                                   ///< of missions read
    TemporaryFolder folder_;
    Clock::time_point start_ = Clock::now();
};

/// Publishes the state on a page.
class LivePage {
  public:
    LivePage(const cli::StageCall& call, const std::optional<std::string>& address,
             const compute::ComputeModel& compute, const std::optional<live::PredictionInput>& basis)
        : compute_(compute), basis_(basis) {
        if (!address) return;
        server_.emplace(*address, report::live_page_html(report::read_front_end(report::web_folder(), "live")));
        cli::note(call, "the page is at " + server_->address());
        if (!server_->is_local())
            cli::warn(call,
                      fmt::format("--serve {0}: every device that reaches this address can read the page, without "
                                  "a password; --serve PORT serves it to this machine only",
                                  *address));
    }

    void print_state(const live::LiveState& state) {
        if (!server_) return;
        live::TimeCurve ahead;
        if (state.prediction && state.battery && state.battery->state)
            ahead = predict_soc_curve(*basis_, *state.prediction, *state.battery->state, state.time_s);
        const auto event = cli::page_event(state, compute_, ahead);
        server_->publish(event.state, event.point);
    }

  private:
    const compute::ComputeModel& compute_;
    const std::optional<live::PredictionInput>& basis_;
    std::optional<live::PageServer> server_;
};

struct Watched {
    std::optional<mission::MissionVariant> mission;
    std::optional<live::PredictionInput> basis;
    compute::ComputeModel compute;
};

/// What is known before the aircraft's mission is: charge and power, but no landing.
live::PredictionInput waiting_basis(const cli::BasisArguments& arguments) {
    live::PredictionInput basis;
    basis.model = mechanical::read_predicting_model(*arguments.model);
    basis.battery = battery::read_battery(*arguments.battery);
    basis.battery_file = *arguments.battery;
    basis.initial_soc_percent = arguments.initial_soc_percent;
    basis.no_prediction_reason =
        "the aircraft's mission: it passes by while a ground station reads it; "
        "--request-mission asks for it, --plan, --mission or --remaining state it";
    return basis;
}

Watched read_watched(const cli::StageCall& call, const cli::BasisArguments& arguments, bool is_mavlink) {
    Watched watched;
    const bool is_of_link = is_mavlink && arguments.model && arguments.battery && !arguments.remaining_s;
    if (arguments.mission || arguments.plan || (arguments.model && !is_of_link))
        watched.basis = cli::read_basis(call, arguments, &watched.mission);
    else if (is_of_link)
        watched.basis = waiting_basis(arguments);
    else if (arguments.battery || arguments.remaining_s)
        throw UsageError("no model given: expected --mission MISSION.toml, or --model MODEL.toml");
    if (watched.mission) watched.compute = setup_of(*watched.mission).compute;
    return watched;
}

/// The mission's schedule during the flight; none for a mission that runs nothing.
std::unique_ptr<live::LiveSchedule> make_schedule(const Watched& watched, bool replans) {
    if (!watched.mission || (watched.compute.components.empty() && !replans)) return nullptr;
    return std::make_unique<live::LiveSchedule>(*watched.mission, replans);
}

/// Updates the flight after every second of it, or of silence; returns the reason to end, if any.
using Update = std::function<std::string(double silent_s)>;

/// Takes the messages that are still queued, so that they are recorded and in the last prediction.
void receive_queued(live::MessageSource& source, live::LiveFlight& flight, double now_s) {
    constexpr double max_s = 10.0;
    const auto start = Clock::now();
    std::vector<live::IncomingMessage> messages;
    do {
        messages.clear();
        source.receive(std::chrono::milliseconds(0), messages);
        for (auto& message : messages) flight.receive(std::move(message), now_s);
    } while (!messages.empty() && seconds_since(start) < max_s);
}

/// Runs until the source ends, a signal arrives, or `update_flight` returns a reason; returns the reason.
std::string watch_source(live::MessageSource& source, live::LiveFlight& flight, const Update& update_flight,
                         const std::function<void(const live::IncomingMessage&)>& on_message) {
    constexpr std::chrono::milliseconds wait{100};
    constexpr double silence_shown_s = 1.0;
    const SignalWatch signals;
    const auto start = Clock::now();
    auto heard = start;
    auto updated = start;
    std::optional<double> updated_at_s;
    std::vector<live::IncomingMessage> messages;
    while (true) {
        messages.clear();
        source.receive(wait, messages);
        for (auto& message : messages) {
            on_message(message);
            flight.receive(std::move(message), seconds_since(start));
            const auto clock_s = flight.clock_s();
            const bool is_due = clock_s && (!updated_at_s || std::abs(*clock_s - *updated_at_s) >= 1.0);
            if (!is_due) continue;
            updated_at_s = clock_s;
            if (auto why = update_flight(0.0); !why.empty()) return why;
            updated = Clock::now();
        }
        if (!messages.empty()) heard = Clock::now();
        if (const auto signal = signals.received()) {
            receive_queued(source, flight, seconds_since(start));
            return "ended by " + signal_name(*signal);
        }
        if (source.at_end()) return "the telemetry ends";
        if (seconds_since(updated) < silence_shown_s) continue;
        if (auto why = update_flight(seconds_since(heard)); !why.empty()) return why;
        updated = Clock::now();
    }
}

int watch(const cli::StageCall& call, const WatchArguments& arguments) {
    auto watched = read_watched(call, arguments.basis, arguments.source.mavlink.has_value());
    auto options = arguments.live;
    std::optional<std::string> log_text;
    if (const auto file = cli::definitions_of_source(arguments.source)) {
        log_text = read_file(*file, telemetry::max_log_configuration_bytes);
        options.configuration = telemetry::parse_log_configuration(*log_text, *file);
    }
    const auto source = cli::open_source(call, arguments.source);
    options.is_mavlink = cli::is_mavlink_source(arguments.source);
    std::optional<live::Recorder> recorder;
    if (const auto& folder = arguments.record) {
        const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
        const auto start = static_cast<std::int64_t>(live::recording_start_unix_s(static_cast<double>(now)));
        if (start > now)
            cli::warn(call,
                      "--record: the clock of this computer is not set: the recording has no true date; set it "
                      "before the flight");
        recorder.emplace(*folder, live::log_name(start), log_text, options.is_mavlink ? ".tlog" : ".data");
        options.on_lines = [&](std::string_view lines, bool restarts) { recorder->write(lines, restarts); };
    }
    live::LiveFlight flight(std::move(options), watched.basis, make_schedule(watched, arguments.replans));
    cli::WatchOutput speaker(call, watched.compute);
    LivePage page(call, arguments.serve, watched.compute, watched.basis);
    Announcement announcement(arguments, *source);
    MissionFromLink link_mission(call, arguments, *source, watched.basis);
    const auto update_flight = [&](double silent_s) -> std::string {
        auto state = flight.update(silent_s);
        for (const auto& [reason, count] : source->report().unusable) state.unusable[reason] += count;
        if (auto warning = link_mission.outdated_warning(); !warning.empty())
            state.warnings.push_back(std::move(warning));
        speaker.print_state(state);
        page.print_state(state);
        announcement.print_state(state);
        if (auto basis = link_mission.take(state.aircraft_id)) {
            flight.set_input(*basis);
            watched.basis = std::move(basis);
        }
        link_mission.request();
        if (!speaker.is_read()) return "the reader of the output has ended";
        return arguments.until_landed && state.landed ? "the aircraft has landed" : "";
    };
    const auto on_message = [&](const live::IncomingMessage& message) { link_mission.receive(message); };
    const auto why = watch_source(*source, flight, update_flight, on_message);
    flight.end();
    update_flight(0.0);
    for (const auto& [reason, count] : source->report().unusable) cli::warn(call, fmt::format("{}: {}", reason, count));
    if (recorder && !recorder->failure().empty()) cli::warn(call, "the recording ended early: " + recorder->failure());
    speaker.end(flight, why);
    return flight.last_predicted() || !watched.basis || !watched.basis->no_prediction_reason.empty() ? cli::ok
                                                                                                     : cli::no_answer;
}

}  // namespace

int flightwatt::stages::watch_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "watch", "SOURCE [--mission MISSION.toml | --model MODEL.toml --remaining S]",
        R"(Prints once a second the phase, energy and state of charge of a flight in the air, and predicts its
landing, as flightwatt predict does from the same telemetry; with a mission also the schedule from here,
and with --replan one that is planned again in flight. On a terminal it is one screen; else a line a
second, with --json an object a line, with --serve also a page for a browser (docs/live.md). It ends
with its source, or by a signal, and then prints its last prediction. The source is one of --follow,
--mavlink, --udp, --serial, --ivy and - (the standard input).)"};
    stage.min_inputs = 0;
    stage.is_live = true;
    stage.json_schema = cli::document_schema<cli::WatchState, cli::WatchEnd>;
    stage.max_inputs = 1;
    stage.output_help = "write the last prediction to FILE, when it ends, instead of the standard output";
    stage.examples = {"flightwatt watch --mavlink udp:14550 --mission mission.toml --serve 8080",
                      "flightwatt watch --udp 4242 --log flight.log --mission mission.toml --serve 8080",
                      "flightwatt watch --follow flight.data --model model.toml --remaining 600 --json"};
    WatchArguments arguments;
    arguments.live.silence_threshold_s = 30.0;
    arguments.basis.uses_missions_battery = true;
    auto& options = stage.options;
    cli::add_source_options(options, arguments.source);
    options.add("aircraft", arguments.live.aircraft_id, {.value = "ID"},
                "the aircraft to watch; default: the first that flies, until then the one that sends most");
    cli::add_basis_options(options, arguments.basis);
    options.add("replan", arguments.replans,
                "plan the remaining mission again at every slot of its [plan], or as its [policy] states",
                {.needs = {"mission"}, .old_name = "decide"});
    options.add("record", arguments.record, cli::output_file("DIR"),
                "write the received messages as a log into this folder");
    options.add("serve", arguments.serve, {.value = "PORT"},
                "serve a page on this machine; at ADDRESS:PORT also to others");
    options.add("request-mission", arguments.requests_mission,
                "ask the aircraft for its mission, with --model and --battery; else one that passes by is used",
                {.needs = {"mavlink"}});
    options.add(
        "announce", arguments.announces,
        "send to the ground station by MAVLink: fw_land, fw_home, fw_resv once a second, a text when an alarm changes",
        {.needs = {"mavlink"}});
    options.add("announce-to", arguments.announce_to, {.value = "ADDRESS:PORT", .needs = {"announce"}},
                "send that to this UDP address instead of back over the link");
    options.add(
        "announce-as", arguments.announce_as, {.value = "SYSTEM:COMPONENT", .needs = {"announce", "request-mission"}},
        "MAVLink identity of what is sent; a ground station may show only what comes from the aircraft's own system");
    options.add("silence-s", arguments.live.silence_threshold_s,
                {.value = "S", .min = 0.0, .above_min = true, .unit = "s"},
                "silence after which the link counts as lost");
    options.add("until-landed", arguments.until_landed, "end when the aircraft has landed");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return watch(call, arguments); });
}

// flightwatt play: a log once more as it came in, over the links that flightwatt watch listens to.

#include "base/signal_watch.h"
#include "cli/stage.h"
#include "live/playback.h"
#include "stages.h"
#include "telemetry/binary_log.h"
#include "telemetry/data_file.h"
#include "telemetry/log_configuration.h"

#include <fmt/format.h>

namespace {

using namespace flightwatt;

constexpr std::string_view mavlink_target = "mavlink:";

struct PlayArguments {
    std::optional<std::string> to;
    live::PlaybackOptions how;
    std::optional<std::string> messages;
    std::optional<std::string> aircraft;
};

/// The definitions that frames are made with and a binary log is read with: those of --messages, or of the log's own
/// .log.
telemetry::MessageDictionary read_definitions(const cli::StageCall& call, const PlayArguments& arguments) {
    if (arguments.messages) return telemetry::read_message_dictionary(*arguments.messages);
    const auto& log = call.inputs.front();
    if (const auto file = telemetry::find_log_file(log)) return telemetry::read_message_dictionary(*file);
    throw InputError({log}, "has no .log, and frames need the definitions of their messages",
                     "give --messages messages.xml; a log of another autopilot is played as MAVLink: --to "
                     "mavlink:127.0.0.1:14550");
}

/// The definitions that the log is played with: those of frames, and of a binary log; none for a text as lines.
std::optional<telemetry::MessageDictionary> definitions_of(const cli::StageCall& call, const PlayArguments& arguments) {
    const bool is_binary = telemetry::detect_binary_framing(telemetry::read_data_file(call.inputs.front())).has_value();
    if (is_binary || *arguments.to != "-") return read_definitions(call, arguments);
    if (arguments.messages)
        throw UsageError("--messages is of frames and of binary logs: this is a text, to a target that takes text");
    return std::nullopt;
}

}  // namespace

namespace flightwatt::live {

Fields<PlaybackReport> record_fields(const PlaybackReport*) {
    using R = PlaybackReport;
    const auto skipped = [](const R& r) { return Keyed<std::size_t>(r.left_out.begin(), r.left_out.end()); };
    return {field("messages", &R::messages, "messages sent"),
            field("lost", &R::lost, "messages that were drawn to be lost"),
            field("skipped", skipped, "lines that were not sent, by reason"),
            field("shortened_gaps", &R::shortened_gaps, "gaps of more than ten minutes, played as ten minutes"),
            field("log_s", &R::log_s, "played time of the log"),
            field("played_s", &R::played_s, "time that it took"),
            field("max_delay_s", &R::max_delay_s, "largest delay of a message"),
            field("stopped", &R::stopped, "ended by a signal")};
}

}  // namespace flightwatt::live

namespace {

void print_report(const cli::StageCall& call, const PlayArguments& arguments, const live::PlaybackReport& report) {
    const bool has_lines = !arguments.to->starts_with(mavlink_target);  // packets may also lack in the log
    for (const auto& [reason, count] : report.left_out)
        cli::warn(call, has_lines ? fmt::format("{} line{} left out: {}", count, count == 1 ? "" : "s", reason)
                                  : fmt::format("{}: {}", reason, count));
    if (report.messages == 0 && report.lost == 0 && !report.stopped && arguments.how.from_s > 0.0)
        cli::warn(call, fmt::format("nothing was sent: the log has nothing after --from {:g}", arguments.how.from_s));
    if (report.shortened_gaps > 0) {
        cli::note(call, fmt::format("{} gap{} of more than {:.0f} s played as so long", report.shortened_gaps,
                                    report.shortened_gaps == 1 ? "" : "s", live::max_played_gap_s));
    }
    if (call.json) cli::print_json(call, report);
    const auto text = fmt::format("{} messages, {:.1f} s of the log, played in {:.1f} s{}\n", report.messages,
                                  report.log_s, report.played_s, report.stopped ? ": stopped" : "");
    if (call.output || arguments.to != "-") return cli::write_result(call, text);
    cli::note(call, text);
}

int play(const cli::StageCall& call, const PlayArguments& arguments) {
    constexpr std::string_view udp = "udp:";
    constexpr auto targets = "udp:ADDRESS:PORT, mavlink:ADDRESS:PORT or -";
    if (!arguments.to) throw UsageError(fmt::format("nowhere to play to: expected --to {}", targets));
    const auto& to = *arguments.to;
    if (to == "-" && call.json) throw UsageError("--json would stand among the lines of --to -");
    if (to != "-" && !to.starts_with(udp) && !to.starts_with(mavlink_target))
        throw UsageError(fmt::format("unknown target '{}': expected {}", to, targets));
    const SignalWatch signals;
    bool has_reader = true;
    const auto stop = [&] { return signals.received().has_value() || !has_reader; };
    if (to.starts_with(mavlink_target)) {
        if (arguments.messages) throw UsageError("--messages defines Paparazzi's messages: MAVLink's are known");
        const auto target = live::open_mavlink_target(to.substr(mavlink_target.size()));
        print_report(call, arguments,
                     live::play_as_mavlink(call.inputs.front(), arguments.how, target, stop, arguments.aircraft));
        return cli::ok;
    }
    if (arguments.aircraft) throw UsageError("--aircraft belongs to mavlink: the messages of all are sent else");
    const auto definitions = definitions_of(call, arguments);
    live::PlaybackTarget target = [&](const live::IncomingMessage& message) -> std::string_view {
        has_reader = cli::print_flushed(live::data_line(message));
        return {};
    };
    if (to != "-") target = live::open_udp_target(to.substr(udp.size()), definitions.value());
    print_report(call, arguments, live::play(call.inputs.front(), arguments.how, target, stop, definitions));
    return cli::ok;
}

}  // namespace

int flightwatt::stages::play_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "play", "LOG --to TARGET",
        R"(Sends a log as live telemetry, in its own time or faster, over a link that flightwatt watch listens to: a test
bench for software and ground stations. Targets: mavlink:ADDRESS:PORT (a log of any kind as MAVLink, a datagram
for each message); of a Paparazzi log, text or binary, also udp:ADDRESS:PORT (its link frames) and - (lines to
the standard output; > FILE.data is a file that grows).)"};
    stage.json_schema = cli::document_schema<live::PlaybackReport>;
    stage.max_inputs = 1;
    stage.output_help = "write how it was played to FILE instead of the standard output";
    stage.examples = {"flightwatt play flight.bin --to mavlink:127.0.0.1:14550 --speed 10",
                      "flightwatt play flight.data --to udp:127.0.0.1:4242 --speed 10",
                      "flightwatt play flight.data --to - | flightwatt watch - --model model.toml --remaining 600"};
    stage.reads_logs = true;
    PlayArguments arguments;
    constexpr double max_speed = 100'000.0;
    auto& options = stage.options;
    options.add("to", arguments.to, {.value = "TARGET"}, "the target");
    options.add("speed", arguments.how.speed,
                {.value = "X", .min = 0.0, .max = max_speed, .above_min = true, .unit = "times as fast"},
                "speed relative to the log's own time");
    options.add("from", arguments.how.from_s, {.value = "S", .min = 0.0, .unit = "s"},
                "begin so long after the log's first message");
    options.add("loss", arguments.how.loss_percent, {.value = "PERCENT", .min = 0.0, .max = 100.0, .unit = "%"},
                "lose so many of the messages, drawn at random, in each run the same");
    options.add("delay", arguments.how.delay_s, {.value = "S", .min = 0.0, .max = 60.0, .unit = "s"},
                "send each message later by up to S, drawn at random: later ones may overtake it");
    options.add("messages", arguments.messages, cli::input_file("FILE"),
                "definitions of the messages, for udp and binary logs: a messages.xml, or a .log; default: the log's");
    options.add("aircraft", arguments.aircraft, {.value = "ID"}, "the aircraft of several in the log, for mavlink");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return play(call, arguments); });
}

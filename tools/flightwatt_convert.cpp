// flightwatt convert: a binary log as text: of Paparazzi as its own sd2log writes it, of other autopilots as a series.

#include "base/atomic_file.h"
#include "base/overwrite_guard.h"
#include "cli/stage.h"
#include "flight/load_flight.h"
#include "flight/series_file.h"
#include "stages.h"
#include "telemetry/log_configuration.h"

#include <cstdint>
#include <iterator>
#include <map>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace {

using namespace flightwatt;

/// A binary log as text, and its content in numbers.
struct ConvertedLog {
    std::string text = {};
    std::size_t lines = 0;
    std::optional<double> start_s = {};  ///< nothing for a capture of a link without times
    double end_s = 0.0;
    std::size_t untimed = 0;  ///< messages before the first time of a link; they are not in the text
    std::set<int> senders = {};
    telemetry::LinkCounts counts = {};
};

ConvertedLog convert_log(const flight::FlightFile& file) {
    return flight::with_binary_log(file, [&](const telemetry::BinaryLog& log) {
        telemetry::LinkDecoder decoder(*log.messages, log.framing, link_version(log));
        ConvertedLog converted;
        const auto sink = [&](const telemetry::LinkMessage& message) {
            if (message.time_s && !converted.start_s) {
                converted.start_s = *message.time_s;
                converted.untimed = std::exchange(converted.lines, 0);
                converted.text.clear();
                converted.senders.clear();
            }
            converted.end_s = message.time_s.value_or(0.0);
            converted.senders.insert(message.sender);
            fmt::format_to(std::back_inserter(converted.text), "{:.4f} {}\n", converted.end_s, message.text);
            ++converted.lines;
        };
        decoder.push(log.bytes, sink);
        decoder.flush(sink);
        require_matching_lengths(decoder.counts(), log);
        converted.counts = decoder.counts();
        return converted;
    });
}

/// "103 of class 1: 10 frames".
std::vector<std::string> describe_ids(const std::map<std::uint16_t, std::size_t>& ids) {
    std::vector<std::string> texts;
    texts.reserve(ids.size());
    for (const auto& [number, frames] : ids) {
        texts.push_back(
            fmt::format("{} of class {} ({} frame{})", number % 256, number / 256, frames, frames == 1 ? "" : "s"));
    }
    return texts;
}

std::vector<std::string> warnings_of(const ConvertedLog& log, const std::string& definitions) {
    std::vector<std::string> warnings;
    const auto& counts = log.counts;
    if (counts.unknown > 0) {
        warnings.push_back(fmt::format("{} frames are of messages that {} does not define: {}", counts.unknown,
                                       definitions, short_list(describe_ids(counts.unknown_ids))));
    }
    if (counts.length_mismatches > 0) {
        warnings.push_back(fmt::format("{} frames have other lengths than {} defines: {}", counts.length_mismatches,
                                       definitions, short_list(describe_ids(counts.other_length_ids))));
    }
    if (counts.skipped_bytes > 0) {
        warnings.push_back(fmt::format("damaged: {} bytes in {} runs without a valid frame", counts.skipped_bytes,
                                       counts.skipped_runs));
    }
    if (!log.start_s) warnings.emplace_back("a capture of a link, whose messages have no times: all are written as 0");
    if (log.untimed > 0) {
        warnings.push_back(
            fmt::format("{} messages before the first TIMESTAMP have no time, and are not written", log.untimed));
    }
    return warnings;
}

/// JSON of the stage.
struct ConvertOutput {
    const flight::FlightFile* file = nullptr;
    const ConvertedLog* log = nullptr;
    const std::vector<std::string>* warnings = nullptr;
};

Fields<ConvertOutput> record_fields(const ConvertOutput*) {
    using R = ConvertOutput;
    using L = ConvertedLog;
    using C = decltype(L::counts);
    const auto name = [](const auto& value) { return std::string(to_string(value)); };
    const auto senders = [](const auto& ids) { return std::vector<int>(ids.begin(), ids.end()); };
    const auto end_s = [](const L& log) { return log.start_s ? std::optional(log.end_s) : std::nullopt; };
    return {field("log", at(&R::file, &flight::FlightFile::path), "the binary log"),
            field("definitions", at(&R::file, &flight::FlightFile::log_file), "the `.log` with the messages"),
            field("framing", at(&R::log, &L::counts, &C::framing, name), "`SD card`, `link` or `XBee`"),
            field("link", at(&R::log, &L::counts, &C::version, name), "`pprzlink v1` or `pprzlink v2`"),
            field("bytes", at(&R::log, &L::counts, &C::bytes), "bytes of the log"),
            field("frames", at(&R::log, &L::counts, &C::frames), "frames with a valid checksum"),
            field("messages", at(&R::log, &L::lines), "messages written"),
            field("unknown_frames", at(&R::log, &L::counts, &C::unknown), "frames of undefined messages"),
            field("length_mismatch_frames", at(&R::log, &L::counts, &C::length_mismatches),
                  "frames with another length than defined"),
            field("non_message_frames", at(&R::log, &L::counts, &C::non_message_frames), "as an XBee's status"),
            field("skipped_bytes", at(&R::log, &L::counts, &C::skipped_bytes), "bytes outside of frames"),
            field("skipped_runs", at(&R::log, &L::counts, &C::skipped_runs), "runs of such bytes"),
            field("padding_bytes", at(&R::log, &L::counts, &C::padding_bytes), "zero bytes that pad the log"),
            field("untimed", at(&R::log, &L::untimed), "messages before the first `TIMESTAMP`, ignored"),
            field("senders", at(&R::log, &L::senders, senders), "ids of the senders"),
            field("start_s", at(&R::log, &L::start_s), "first message"),
            field("end_s", at(&R::log, end_s), "last message"),
            field("warnings", &R::warnings, "warnings")};
}

/// NAME.log for NAME.data, if the binary log has a valid one that is not this file already.
std::optional<std::filesystem::path> log_to_write(const cli::StageCall& call, const flight::FlightFile& file) {
    const auto own = telemetry::find_log_file(file.path());
    if (!call.output || !own || *own != file.log_file()) return std::nullopt;
    const std::filesystem::path output = *call.output;
    auto target = output.parent_path() / (telemetry::flight_name(output) + ".log");
    std::error_code error;
    if (std::filesystem::equivalent(target, *own, error)) return std::nullopt;
    return target;
}

void print_summary(const cli::StageCall& call, const flight::FlightFile& file, const ConvertedLog& log) {
    const auto& counts = log.counts;
    const auto times = log.start_s ? fmt::format(", {:.1f} to {:.1f} s", *log.start_s, log.end_s) : std::string();
    cli::note(call,
              fmt::format("{}: {}, {}: {} frames, {} messages of {}{}{}", file.path().string(),
                          to_string(counts.framing.value()), to_string(counts.version.value()), counts.frames,
                          log.lines, fmt::join(log.senders, ", "), times,
                          counts.padding_bytes > 0 ? fmt::format("; {} bytes set aside", counts.padding_bytes) : ""));
}

struct ConvertArguments {
    std::optional<std::string> messages;
    std::size_t max_log_bytes = telemetry::default_max_log_bytes;
};

/// Writes the series of a log that defines its own messages.
int convert_to_series(const cli::StageCall& call, const flight::FlightFile& file) {
    const auto path = file.path().string();
    if (call.output && !call.output->ends_with(".csv"))
        throw UsageError(fmt::format("{} becomes a series, which is a .csv, not {}", path, *call.output));
    auto recordings = flight::read_recordings(file, std::nullopt);
    const auto used = flight::choose_recording(recordings, file, std::nullopt);
    const auto series = std::move(recordings[used - 1].front());
    if (recordings.size() > 1)
        cli::note(call, fmt::format("{}: recording {} of {} is written; flightwatt parse --recording N writes another",
                                    path, used, recordings.size()));
    ConvertedLog converted{.text = to_csv(series)};
    converted.counts.bytes = file.text().size();
    append(*call.diagnostics, Severity::note, "reading of the log", path, series.notes);
    for (const auto& skipped : series.skipped)
        cli::add_diagnostic(call, {is_partial_record(skipped) ? Severity::note : Severity::warning, "damaged log",
                                   describe(skipped), path});
    const auto warnings = texts_of(*call.diagnostics);
    cli::write_result(call, converted.text);
    if (call.json)
        cli::print_json(call, ConvertOutput{&file, &converted, &warnings});
    else
        cli::note(call, fmt::format("{}: {}, {} tracks", path, to_string(*file.autopilot()), series.tracks.size()));
    return cli::ok;
}

int convert(const cli::StageCall& call, const ConvertArguments& arguments) {
    const std::filesystem::path path = call.inputs.front();
    const flight::FlightFile file(path, arguments.max_log_bytes, arguments.messages);
    if (file.autopilot()) return convert_to_series(call, file);
    if (!file.framing()) {
        throw InputError({path.string()}, "is no binary log: no frames with right checksums follow each other in it",
                         "expected the .LOG or .tlm of an SD card, or a capture of a link");
    }
    const auto log_file = log_to_write(call, file);
    if (log_file) {
        register_output(*log_file);
        if (std::filesystem::exists(*log_file) && !file_holds(*log_file, file.log_text().value())) {
            throw UsageError(
                fmt::format("{} is there already, with other definitions than {}: move it away, or name "
                            "another output",
                            log_file->string(), file.log_file().string()));
        }
    }
    const auto converted = convert_log(file);
    if (log_file) write_file_atomically(*log_file, file.log_text().value());  // first: no text without definitions
    cli::write_result(call, converted.text);
    auto warnings = warnings_of(converted, file.log_file().string());
    if (!file.log_error().empty()) warnings.push_back(file.log_error());
    for (const auto& warning : warnings) cli::warn(call, fmt::format("{}: {}", path.string(), warning));
    if (call.json) {
        cli::print_json(call, ConvertOutput{&file, &converted, &warnings});
    } else {
        print_summary(call, file, converted);
    }
    return cli::ok;
}

}  // namespace

int flightwatt::stages::convert_stage(int argc, char** argv) {
    cli::StageDefinition stage{
        "convert", "LOG",
        R"(Writes a binary log as text, as Paparazzi's sd2log does: the .LOG or .tlm of an SD card, or a capture
of a serial line, of UDP or of an XBee (also .gz, .bz2, .xz, .zst). With -o NAME.data, NAME.log is
written next to it if the log has one. A .bin of ArduPilot or a .ulg of PX4 becomes a series (-o NAME.csv).
All stages also read the binary log itself, with the same results.)"};
    stage.next = [](const auto&) { return "flightwatt segment {}"; };
    stage.json_schema = cli::document_schema<ConvertOutput>;
    stage.max_inputs = 1;
    stage.examples = {"flightwatt convert flight.LOG -o flight.data",
                      "flightwatt convert capture.bin --messages messages.xml",
                      "flightwatt convert flight.ulg -o flight.csv"};
    stage.reads_logs = true;
    ConvertArguments arguments;
    stage.options.add("messages", arguments.messages, cli::input_file("FILE"),
                      "definitions for a log without a .log: a messages.xml, or the .log of the same build");
    stage.options.add("max-log-mb", arguments.max_log_bytes, {.value = "MB", .min = 1.0, .max = 1e6, .scale = 1e6},
                      "refuse a compressed log that unpacks to more");
    return cli::run_stage(argc, argv, stage, [&](const auto& call) { return convert(call, arguments); });
}

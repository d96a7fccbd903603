#include "cli/stage.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"
#include "base/overwrite_guard.h"
#include "base/toml_reader.h"
#include "cli/help.h"
#include "cli/terminal.h"

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>
#include <new>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

namespace po = boost::program_options;

constexpr const char* inputs_option = "inputs";

/// Once the reader of the standard output has left (head): what is still printed goes nowhere, everything else is done
/// to its end, and then the program ends as SIGPIPE ends programs.
bool reader_has_left = false;

/// Diagnostics that nobody can read (closed, full disk) change nothing.
void tell(const std::string& line) { std::fwrite(line.data(), 1, line.size(), stderr); }

/// What a line begins with, in colour where the standard error has colours.
std::string alert(const char* word, int color) {
    return standard_error_has_colors() ? fmt::format("\x1b[1;38;5;{}m{}:\x1b[0m", color, word)
                                       : fmt::format("{}:", word);
}

constexpr int color_of_errors = 160;
constexpr int color_of_warnings = 172;

/// Says what went wrong, and where; returns the exit code that stands for it.
ExitCode failed(ExitCode code, const std::string& program, const std::string& message, const std::string& where = "") {
    const auto place = where.empty() ? "" : where + ": ";
    tell(fmt::format("{}: {}{} {}\n", program, one_line(place), alert("error", color_of_errors),
                     one_line(truncated(message))));
    return code;
}

/// A standard stream that was closed before the start would become the first file that is opened, a log or a result.
/// What is opened here instead cannot be written, so that a result for a closed standard output is an error.
void occupy_closed_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) ::open("/dev/null", O_RDONLY);
    }
}

[[noreturn]] void cannot_print() {
    throw OutputError(fmt::format("cannot write the standard output: {}", std::strerror(errno)));
}

[[noreturn]] void end_by_broken_pipe() {
    constexpr int killed_by_signal = 128;  // what shells add to the signal
    std::signal(SIGPIPE, SIG_DFL);
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGPIPE);
    ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    std::raise(SIGPIPE);
    ::_exit(killed_by_signal + SIGPIPE);
}

void close_standard_output() {
    if (!reader_has_left && std::fflush(stdout) != 0) {
        if (errno != EPIPE) cannot_print();
        reader_has_left = true;
    }
    if (reader_has_left) end_by_broken_pipe();
    if (std::fclose(stdout) != 0) cannot_print();
}

/// Options of earlier versions, with what there is instead.
const std::map<std::string, std::string>& removed_options() {
    static const std::map<std::string, std::string> removed{
        {"--above-idle", "state above_idle = true in the specification"},
        {"--covariate", "'physical' predicts by airspeed and climb, where they were measured"},
        {"--csv", "-o FILE.csv writes the table as CSV with all digits"},
        {"--cut", "--sortie N reads one sortie of a log, in every stage"},
        {"--curve", "the curve is that of least squares, and a note says where its frequency is open"},
        {"--know-durations", "schedules are made for the durations that are known before the flight"},
        {"--level", "the model's curve is expected; its mean where the flight is not known from its take-off on"},
        {"--level-covariate", "fit by airspeed and climb instead: --model physical"},
        {"--link-version", "frames are of version 2 of pprzlink"},
        {"--loss", "fits are of least squares; leave flights out with --exclude"},
        {"--markdown", "-o FILE.md writes the table as Markdown"},
        {"--max-battery-flights", "up to 12 flights are taken"},
        {"--max-periods", "a phase has 0.5 to 120 periods"},
        {"--max-validation-flights", "up to 30 flights are taken"},
        {"--min-periods", "a phase has 0.5 to 120 periods"},
        {"--powprofiler", "DIR/NAME.csv holds the same powers, with names in place of flags"},
        {"--sampler", "state its kind under [sampler] of the specification"},
        {"--sysfs", "state sysfs under [sampler] of the specification"},
        {"--trials", "every configuration is run"},
        {"--weight", "leave flights out with --exclude, or choose another --weights"}};
    return removed;
}

[[noreturn]] void refuse_option(const po::unknown_option& error, const po::options_description& known) {
    if (const auto removed = removed_options().find(error.get_option_name()); removed != removed_options().end())
        throw UsageError(fmt::format("{} was removed: {}", removed->first, removed->second));
    std::vector<std::string> names;
    for (const auto& option : known.options()) names.push_back("--" + option->long_name());
    const auto near = nearest_word(error.get_option_name(), names);
    throw UsageError(
        fmt::format("{}; {}", error.what(), near.empty() ? "see --help" : fmt::format("did you mean '{}'?", near)));
}

/// Those of the stage, and those of every stage.
po::options_description visible_options(const StageDefinition& definition) {
    auto visible = definition.options;
    if (definition.shows_table) visible.add_options()("wide", "on a terminal: all columns, also beyond its width");
    visible.add_options()("output,o", output_file("FILE"), definition.output_help.c_str())(
        "json", "print the summary as JSON")("help,h", "show this help")("version", "show the version");
    return visible;
}

/// What the option takes: nothing, the name of a file that is read or written, or another value.
std::string_view kind_of(const po::option_description& option) {
    const auto* semantic = option.semantic().get();
    if (semantic->max_tokens() == 0) return "flag";
    const auto* file = dynamic_cast<const FileOption*>(semantic);
    if (file == nullptr) return "value";
    return file->role == FileRole::input ? "input" : "output";
}

/// For completion and man pages: a line an option with name, short name, kind, value and description, between tabs.
std::string option_list(const po::options_description& options) {
    std::string text;
    for (const auto& option : options.options()) {
        const auto shortest = option->canonical_display_name(po::command_line_style::allow_dash_for_short);
        const auto kind = kind_of(*option);
        text += fmt::format("--{}\t{}\t{}\t{}\t{}\n", option->long_name(),
                            shortest.starts_with("-") && shortest.size() == 2 ? shortest : "", kind,
                            kind == "flag" ? "" : option->format_parameter(), one_line(option->description()));
    }
    return text;
}

StageCall parse(int argc, char** argv, const StageDefinition& definition, const po::options_description& visible) {
    StageCall call;
    call.program = "flightwatt-" + definition.name;
    po::options_description all = visible;
    all.add_options()(inputs_option, po::value<std::vector<std::string>>());
    po::positional_options_description positional;
    positional.add(inputs_option, -1);
    const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
    try {
        auto parser = po::command_line_parser(argc, argv).options(all).positional(positional).style(style);
        po::store(parser.run(), call.options);
    } catch (const po::unknown_option& error) {
        refuse_option(error, visible);
    }
    po::notify(call.options);
    call.json = call.has("json");
    call.output = call.get_optional<std::string>("output");
    if (call.output == "-") call.output.reset();  // as everywhere: the standard output
    if (call.has(inputs_option)) call.inputs = call.get<std::vector<std::string>>(inputs_option);
    return call;
}

std::string usage_line(const StageDefinition& definition) {
    return fmt::format("usage: flightwatt {} {} [options]", definition.name, definition.arguments);
}

std::vector<std::string> files_of(const po::variable_value& value) {
    if (const auto* files = boost::any_cast<std::vector<std::string>>(&value.value())) return *files;
    return {value.as<std::string>()};
}

/// Registers which files the user named are read and written: a result that replaces what it was made from would lose
/// a log for good.
void declare_files(const StageCall& call, const po::options_description& options) {
    enable_overwrite_guard();
    for (const auto& input : call.inputs) register_input(input);
    for (const auto role : {FileRole::input, FileRole::output}) {
        for (const auto& option : options.options()) {
            const auto* names_file = dynamic_cast<const FileOption*>(option->semantic().get());
            const auto& name = option->long_name();
            if (names_file == nullptr || names_file->role != role || !call.has(name)) continue;
            for (const auto& file : files_of(call.options[name])) {
                if (role == FileRole::input) register_input(file);
                if (role == FileRole::output && file != "-") register_output(file, "--" + name);
            }
        }
    }
}

int run(int argc, char** argv, const StageDefinition& definition, const StageBody& body) {
    const auto visible = visible_options(definition);
    if (argc == 2 && std::string_view(argv[1]) == "--list-options") {
        print(option_list(visible));
        return ok;
    }
    const auto call = parse(argc, argv, definition, visible);
    if (call.has("help")) {
        std::ostringstream options;
        options << visible;
        print(fmt::format("{}\n\n{}\n\n{}", usage_line(definition), definition.description, options.str()));
        return ok;
    }
    if (call.has("version")) {
        print(fmt::format("{} {}\n", call.program, version_text()));
        return ok;
    }
    if (call.inputs.size() < definition.min_inputs) {
        const auto given = call.inputs.size();
        const auto lack = given == 0 ? std::string("no input given")
                                     : fmt::format("{} given, expected {}", given, definition.min_inputs);
        throw UsageError(fmt::format("{}; {}", lack, usage_line(definition)));
    }
    if (call.inputs.size() > definition.max_inputs) {
        throw UsageError(
            fmt::format("unexpected argument '{}'; {}", call.inputs[definition.max_inputs], usage_line(definition)));
    }
    declare_files(call, visible);
    const int code = body(call);
    return code == ok && !call.skipped->empty() ? input_rejected : code;
}

/// What is wrong with an input, with the way out.
std::string reason_of(const InputError& error) {
    return error.hint().empty() ? std::string(error.what()) : fmt::format("{}; {}", error.what(), error.hint());
}

}  // namespace

int run_guarded(const std::string& program, const std::function<int()>& body) {
    // A closed pipe and a file beyond the limit (ulimit -f) are then failed writes: see print() and tell().
    for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
    occupy_closed_streams();
    try {
        const int code = body();
        close_standard_output();
        return code;
    } catch (const InputError& error) {
        return failed(input_rejected, program, reason_of(error), to_string(error.where()));
    } catch (const NoResultError& error) {
        return failed(no_answer, program, error.what());
    } catch (const UsageError& error) {
        return failed(usage_error, program, error.what());
    } catch (const po::error& error) {
        return failed(usage_error, program, fmt::format("{}; see --help", error.what()));
    } catch (const OutputError& error) {
        return failed(internal_error, program, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        return failed(input_rejected, program, "cannot be used: " + error.code().message(), error.path1().string());
    } catch (const std::bad_alloc&) {
        return failed(internal_error, program, "there is not enough memory");
    } catch (const std::exception& error) {
        return failed(internal_error, program, fmt::format("internal error: {}", error.what()));
    }
}

int run_stage(int argc, char** argv, const StageDefinition& definition, const StageBody& body) {
    return run_guarded("flightwatt-" + definition.name, [&] { return run(argc, argv, definition, body); });
}

void skip_input(const StageCall& call, const std::string& file, const InputError& error) {
    failed(input_rejected, call.program, reason_of(error) + " (skipped)", to_string(error.where()));
    call.skipped->push_back({file, reason_of(error)});
}

void print(std::string_view text) {
    if (reader_has_left || std::fwrite(text.data(), 1, text.size(), stdout) == text.size()) return;
    if (errno != EPIPE) cannot_print();
    reader_has_left = true;
}

bool print_flushed(std::string_view text) {
    print(text);
    if (!reader_has_left && std::fflush(stdout) != 0) {
        if (errno != EPIPE) cannot_print();
        reader_has_left = true;
    }
    return !reader_has_left;
}

void write_result(const StageCall& call, std::string_view content) {
    if (call.output) {
        write_file_atomically(*call.output, content);
    } else if (!call.json) {
        print(content);
    }
}

std::string one_line(std::string_view text) {
    constexpr unsigned char first_printed = 0x20;
    constexpr unsigned char delete_character = 0x7F;
    std::string line;
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '\n' || c == '\t') {
            line += ' ';
        } else if (code < first_printed || code == delete_character) {
            line += fmt::format("\\x{:02x}", code);
        } else {
            line += c;
        }
    }
    return line;
}

std::string shell_quoted(std::string_view file) {
    if (!file.empty() && file.find_first_of(" \t\n'\"\\$`&;|<>()*?[]#~!{}") == std::string_view::npos)
        return std::string(file);
    std::string quoted = "'";
    for (const char c : file) c == '\'' ? quoted += R"('\'')" : quoted += c;
    return quoted + "'";
}

void warn(const StageCall& call, std::string_view message) {
    tell(fmt::format("{}: {} {}\n", call.program, alert("warning", color_of_warnings), one_line(message)));
}

void note(const StageCall& call, std::string_view message) {
    tell(fmt::format("{}: {}\n", call.program, one_line(message)));
}

std::uint64_t count_option(const StageCall& call, const std::string& option, std::uint64_t least, std::uint64_t most) {
    const auto text = call.get<std::string>(option);
    const auto number = parse_unsigned(text);
    if (number && *number >= least && *number <= most) return *number;
    const auto range = most < std::numeric_limits<std::uint64_t>::max() ? fmt::format(" from {} to {}", least, most)
                       : least > 0                                      ? fmt::format(" from {}", least)
                                                                        : std::string();
    throw UsageError(fmt::format("--{} {}: expected a whole number{}", option, one_line(text), range));
}

double number_option(const StageCall& call, const std::string& option, double least, double most) {
    const auto value = call.get<double>(option);
    if (value >= least && value <= most) return value;
    throw UsageError(fmt::format("--{} {:g}: expected {:g} to {:g}", option, value, least, most));
}

std::optional<double> positive_option(const StageCall& call, const std::string& option, const std::string& unit,
                                      double most) {
    const auto value = call.get_optional<double>(option);
    if (!value || (*value > 0.0 && *value <= most && std::isfinite(*value))) return value;
    const auto limit = std::isfinite(most) ? fmt::format(" and at most {:g}", most) : std::string();
    throw UsageError(fmt::format("--{} {:g}: expected more than 0{} {}", option, *value, limit, unit));
}

}  // namespace flightwatt::cli
